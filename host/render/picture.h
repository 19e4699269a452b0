/* The channels of an image file, resolved from films in bands of a few rows. Writing needs memory for a few bands only,
 * whatever the picture's size and layers, and it is allocated before the first sample. */
#ifndef TWINLIGHT_RENDER_PICTURE_H
#define TWINLIGHT_RENDER_PICTURE_H

#include "image/exr.h"
#include "render/layers.h"

/* Most groups of three channels: the picture, its layers, and the despeckled picture. */
#define PICTURE_GROUPS_OF(NAME, name, text, groups) +(groups) // NOLINT(bugprone-macro-parentheses)
#define PICTURE_GROUPS_MAX (2 LAYER_LIST_LIGHT(PICTURE_GROUPS_OF) + AOV_COUNT)

/* What to make of a film. */
typedef struct PictureSettings {
    float scale; /* factor on radiance */
    double despeckle; /* threshold of the layer "despeckled"; 0: no such layer */
    const RenderLayers *layers; /* NULL: none */
} PictureSettings;

/* Most threads that make bands at the same time. */
#define PICTURE_LANES_MAX 4

/* Memory for pictures of one size. */
typedef struct PictureMemory {
    struct {
        float *values; /* a band of every group */
        float *plane; /* ExrLane.plane */
    } lanes[PICTURE_LANES_MAX]; /* of each thread */
    int lane_count;
    void *spare; /* reserve of spare_bytes for the libraries that write the file; freed meanwhile */
    size_t spare_bytes;
    size_t picture_values; /* of a whole picture, 3 per pixel of every group */
} PictureMemory;

/* Allocates the memory for pictures of this size, with layers by depth for paths of up to `depth` segments, which up to
 * `threads` threads make. Fails only when out of memory. */
bool picture_memory_init(PictureMemory *memory, const PictureSettings *settings, int width, int height, uint depth,
                         int threads, Error *error);
void picture_memory_destroy(PictureMemory *memory);

/* Free the reserve before a file is written, and allocate it again afterwards. */
void picture_memory_lend(PictureMemory *memory);
void picture_memory_take_back(PictureMemory *memory);

typedef enum PictureSource {
    PICTURE_FILM,
    PICTURE_DEPTH,
    PICTURE_VARIABLE,
    PICTURE_VARIANCE,
    PICTURE_DESPECKLED
} PictureSource;

typedef struct PictureGroup {
    PictureSource source;
    const char *channel; /* name of its first channel: "R", "direct.R", "Z" */
    int channels; /* 1 or 3; one channel is the first of three equal ones */
    const Film *film;
    const AovImage *variable; /* of PICTURE_VARIABLE */
    FilmPart part;
    uint depth; /* of PICTURE_DEPTH */
    FilmScale scale;
    float *values; /* of a band, 3 per pixel */
} PictureGroup;

typedef struct Picture {
    PictureSettings settings;
    int width, height; /* of the crop */
    float *free; /* next unused value of the lane */
    PictureGroup groups[PICTURE_GROUPS_MAX]; /* the first: the picture itself */
    size_t group_count;
    ExrChannel channels[3 * PICTURE_GROUPS_MAX]; /* data: of the latest band */
    size_t channel_count;
    char depth_names[SPLAT_DEPTH_MAX + 1][3][16]; /* "depth03.R" ... */
} Picture;

/* Prepares a picture of the film as it is now, for one thread, which has a lane of the memory. `film` must not change
 * while the picture is in use; `memory` must have been made with these settings and this size. */
void picture_init(Picture *picture, const PictureSettings *settings, const Film *film, const PictureMemory *memory,
                  int lane);

/* Resolves rows first ... first + count - 1 of all groups; count <= EXR_BAND_ROWS. */
void picture_band(Picture *picture, int first, int count);

/* Resolves the same rows of one group, which must not be PICTURE_DESPECKLED, into group->values. */
void picture_group_band(const Picture *picture, const PictureGroup *group, int first, int count);

/* Resolves row y of the picture itself, 3 values per pixel. Valid until the next call of either function. */
const float *picture_row(Picture *picture, int y);

#endif
