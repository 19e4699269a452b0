/* Merging the parts of a picture (render/part.h). The result does not depend on the order in which they are named: sums
 * are of integers, and what floats there are, the layer of variances, is added in order of the shards. */
#ifndef TWINLIGHT_RENDER_MERGE_H
#define TWINLIGHT_RENDER_MERGE_H

#include "render/part.h"

typedef struct MergePart {
    const char *path; /* borrowed */
    size_t place; /* in the order in which they were named */
    unsigned number; /* Shard.number */
    uint64_t done, wanted; /* as in PartHead */
} MergePart;

typedef struct Merge {
    PartHead head; /* of the first shard that is there */
    MergePart *parts; /* in order of their numbers */
    size_t count;
    RenderTotals totals; /* of those merged so far */
} Merge;

/* Opens all parts in turn and checks that each is whole, that all are of one picture, and that none is there twice.
 * count >= 1. Call merge_destroy even on failure. */
bool merge_begin(Merge *merge, char *const *paths, size_t count, Error *error);
void merge_destroy(Merge *merge);

/* Warns of shards that are missing or not finished. */
void merge_warn(const Merge *merge);

/* The shards that are missing, as text, "3, 7 ... 9"; cut off to the size >= 64. Returns how many. */
unsigned merge_missing(const Merge *merge, char *text, size_t size);

/* Adds all parts, one after the other, to film and layers from part_film_init. Keeps one more film and its layers in
 * memory. Ends early, without failing, if *stop becomes 1. */
bool merge_run(Merge *merge, Film *film, RenderLayers *layers, const atomic_int *stop, Error *error);

#endif
