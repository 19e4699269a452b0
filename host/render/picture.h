/* What an image file holds, made of films a band of rows at a time: whatever the picture's size and its layers, writing
 * takes memory for a few bands, which is there before the first sample. */
#ifndef TWINLIGHT_RENDER_PICTURE_H
#define TWINLIGHT_RENDER_PICTURE_H

#include "image/exr.h"
#include "render/layers.h"

/* Channels come in groups of three: the picture, two of its parts, two halves, variance, three variables, the
 * despeckled picture, and one for each depth. */
#define PICTURE_GROUPS_FIXED 10
#define PICTURE_GROUPS_MAX (PICTURE_GROUPS_FIXED + (int)(SPLAT_DEPTH_MAX + 1u - SPLAT_DEPTH_MIN))

/* What is wanted of a film. */
typedef struct PictureSettings {
    float scale; /* factor on every value of light */
    double despeckle; /* threshold of the layer `despeckled`; 0: none */
    const RenderLayers *layers; /* NULL: none */
} PictureSettings;

/* Memory for pictures of one width. */
typedef struct PictureMemory {
    float *values; /* bands of all groups */
    float *plane; /* ExrPicture.plane */
    void *spare; /* as much as the libraries allocate to write a file; freed for that time */
    size_t spare_bytes;
} PictureMemory;

/* Fails when there is not enough memory for pictures of that many pixels, paths of at most `depth` segments in layers
 * of their own. */
bool picture_memory_init(PictureMemory *memory, const PictureSettings *settings, int width, int height, uint depth,
                         Error *error);
void picture_memory_destroy(PictureMemory *memory);

/* To be called around writing a file. */
void picture_memory_lend(PictureMemory *memory);
void picture_memory_take_back(PictureMemory *memory);

typedef enum PictureSource { PICTURE_FILM, PICTURE_DEPTH, PICTURE_VARIANCE, PICTURE_DESPECKLED } PictureSource;

typedef struct PictureGroup {
    PictureSource source;
    const Film *film;
    FilmPart part;
    uint depth; /* of PICTURE_DEPTH */
    FilmScale scale;
    float *values; /* of a band, 3 a pixel */
} PictureGroup;

typedef struct Picture {
    PictureSettings settings;
    int width, height; /* of the crop */
    float *free; /* values that no group has yet */
    PictureGroup groups[PICTURE_GROUPS_MAX]; /* the first: the picture itself */
    size_t group_count;
    ExrChannel channels[3 * PICTURE_GROUPS_MAX]; /* data: of the band that was made last */
    size_t channel_count;
    char depth_names[SPLAT_DEPTH_MAX + 1][3][16]; /* "depth03.R" ... */
} Picture;

/* The film as it is now, which must not change while the picture is in use, and `memory` made for it. */
void picture_init(Picture *picture, const PictureSettings *settings, const Film *film, const PictureMemory *memory);

/* Makes rows first ... first + count - 1 of all groups, EXR_BAND_ROWS at most. */
void picture_band(Picture *picture, int first, int count);

/* Row y of the picture itself, 3 values a pixel, until the next call of either function. */
const float *picture_row(Picture *picture, int y);

#endif
