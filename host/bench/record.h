/* Records of renderings: text files beside the images, with a line "NAME VALUE" per member of BenchRecord. An image
 * without a complete record counts as unfinished. */
#ifndef TWINLIGHT_BENCH_RECORD_H
#define TWINLIGHT_BENCH_RECORD_H

#include "bench/bench.h"

/* Writes the record of "IMAGE.exr", which is "IMAGE.exr.record". */
bool bench_record_write(const char *image, const BenchRecord *record, Error *error);

/* Returns false if there is no complete record or no image. */
bool bench_record_read(const char *image, BenchRecord *record);

#endif
