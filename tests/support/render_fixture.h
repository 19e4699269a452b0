/* Renders scenes given as text or file, for tests of whole pictures. */
#ifndef TWINLIGHT_TESTS_SUPPORT_RENDER_FIXTURE_H
#define TWINLIGHT_TESTS_SUPPORT_RENDER_FIXTURE_H

#include "film/film.h"
#include "render/render.h"
#include "scene/scene.h"

typedef struct RenderSetup {
    const char *text; /* scene in pbrt's format; NULL: read `path` */
    const char *path;
    int width, height; /* 0: the scene's */
    unsigned first_sample, samples;
    int max_depth; /* 0: the scene's */
    int threads;
    const BackendInterface *backend; /* NULL: the CPU's */
    uint batch; /* of a device; 0: it chooses */
    bool film_on_device;
    bool record_spans;
    uint64_t seed;
    const Integrator *integrator; /* NULL: path tracing */
    bool balance, only_strategy, unweighted; /* RenderOptions */
    unsigned strategy[2];
    ChainOptions chains;
    struct RenderLayers *layers; /* RenderOptions; to be destroyed by the test */
    const Film *quantum_of; /* takes the quantum of this film; NULL: of a pilot */
} RenderSetup;

typedef struct RenderedImage {
    Film film;
    RenderResult result;
    int width, height;
    float *rgb; /* 3 a pixel */
} RenderedImage;

/* Opens the backend on a finished scene; NULL with its error. */
Backend *fixture_open(const RenderSetup *setup, const Scene *scene, Error *error);

/* Reads and finishes the scene. */
void fixture_scene(const RenderSetup *setup, Scene *scene);

/* Fails the Check test, with the error's text, when anything goes wrong. */
void fixture_render(const RenderSetup *setup, RenderedImage *image);
void fixture_destroy(RenderedImage *image);

/* Mean over all pixels and channels. */
double fixture_mean(const RenderedImage *image);

/* Mean over channels of the block of pixels [x0, x1) x [y0, y1). */
double fixture_block_mean(const float *rgb, int width, int x0, int y0, int x1, int y1);

/* A picture of 3 floats a pixel. */
typedef struct PictureView {
    const float *rgb;
    int width, height;
} PictureView;

/* Reads a picture; the caller frees what is returned, which the view shows. Fails the test when it cannot be read. */
float *fixture_picture_read(const char *path, PictureView *view);

/* Mean over a grid x grid of blocks of |a - b| / (b + 0.01 mean b), b the blocks of `reference`, which may have another
 * size. */
double fixture_block_difference(PictureView picture, PictureView reference, int grid);

#endif
