/* Records of renderings, text files beside their images: a line "NAME VALUE" for each member of BenchRecord. An image
 * without a record is not finished. */
#ifndef TWINLIGHT_BENCH_RECORD_H
#define TWINLIGHT_BENCH_RECORD_H

#include "bench/bench.h"

/* "IMAGE.exr" has the record "IMAGE.exr.record". */
bool bench_record_write(const char *image, const BenchRecord *record, Error *error);

/* False when there is no whole record, or no image. */
bool bench_record_read(const char *image, BenchRecord *record);

#endif
