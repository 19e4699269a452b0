/* Parts: what a shard has rendered, in a file, for twinlight-merge(1).
 *
 * A part holds integer sums, so that adding parts gives the same bits in any order, and all that an image needs
 * besides: no scene is loaded to merge. It is valid at any time, finished or not. */
#ifndef TWINLIGHT_RENDER_PART_H
#define TWINLIGHT_RENDER_PART_H

#include "base/archive_file.h"
#include "render/identity.h"
#include "render/layers.h"

/* The size and kind of the sums, and what an image file says of its rendering. */
typedef struct PartPicture {
    int width, height, crop[4];
    int quantum_exponent;
    uint reconstruction;
    uint light; /* whether there are sums of paths from the light */
    uint depth_last; /* sums by depth up to this one; 0: none */
    unsigned layers; /* LAYER_BIT */
    int max_depth;
    uint64_t seed;
    float scale; /* PictureSettings.scale */
    float world_to_camera[16], world_to_ndc[16];
    char scene[256], integrator[32]; /* the scene's file name without its folder */
} PartPicture;

typedef struct PartHead {
    Identity identity; /* of the picture */
    Shard shard;
    uint64_t wanted; /* RenderTotals.done of a finished part; 0: its rendering had no limit of samples */
    RenderTotals totals;
    PartPicture picture;
} PartHead;

/* Fills in what the film and layers tell: sizes and kinds of sums. layers: NULL if none. */
void part_head_film(PartHead *head, const Film *film, const RenderLayers *layers);

/* Writes a part whose head is complete, in place of the regular file `path`. threads: that may compress. */
bool part_write(const char *path, PartHead *head, Film *film, RenderLayers *layers, int threads, Error *error);

/* Opens a part, whole and of this version, and reads its head. On failure, with an error that names the file, there is
 * nothing to close. *reader must stay where it is; close it by archive_reader_close. */
bool part_open(ArchiveReader *reader, const char *path, PartHead *head, Error *error);

/* Makes an empty film and layers for the sums of parts like this one. Destroy both even on failure. */
bool part_film_init(const PartHead *head, int threads, Film *film, RenderLayers *layers, Error *error);

/* Reads the sums of an open part into such a film and layers, in place of what they hold. */
bool part_read(ArchiveReader *reader, const char *path, Film *film, RenderLayers *layers, Error *error);

#endif
