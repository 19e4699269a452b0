/* Renders scenes given as text or file, for tests of whole images. */
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
    ErrorGoal error;
    int max_depth; /* 0: the scene's */
    int threads;
    const BackendInterface *backend; /* NULL: the CPU's */
    uint batch; /* for a device; 0: its default */
    bool film_on_device;
    bool record_spans;
    uint64_t seed;
    unsigned photons;
    bool no_openings;
    unsigned reconstruction; /* RECONSTRUCTION_* */
    bool after_another; /* the backend has rendered with the next seed before */
    const Integrator *integrator; /* NULL: path tracing */
    bool balance, only_strategy, unweighted; /* as in RenderOptions */
    unsigned strategy[2];
    ChainOptions chains;
    struct RenderLayers *layers; /* as in RenderOptions; to be destroyed by the test */
    float *saved; /* receives the pixels of the first picture that is saved; NULL: none is */
    const Film *quantum_of; /* uses the quantum of this film; NULL: a pilot's */
} RenderSetup;

typedef struct RenderedImage {
    Film film;
    RenderResult result;
    int width, height;
    float *rgb; /* 3 per pixel */
} RenderedImage;

/* Opens the backend on a finished scene; returns NULL with its error. */
Backend *fixture_open(const RenderSetup *setup, const Scene *scene, Error *error);

/* Reads and finishes the scene. */
void fixture_scene(const RenderSetup *setup, Scene *scene);

/* Fails the Check test, with the error's text, if anything goes wrong. */
void fixture_render(const RenderSetup *setup, RenderedImage *image);
void fixture_destroy(RenderedImage *image);

/* Mean over all pixels and channels. */
double fixture_mean(const RenderedImage *image);

/* Mean over channels of the block of pixels [x0, x1) x [y0, y1). */
double fixture_block_mean(const float *rgb, int width, int x0, int y0, int x1, int y1);

/* An image of 3 floats per pixel. */
typedef struct PictureView {
    const float *rgb;
    int width, height;
} PictureView;

/* Reads an image into a buffer that the view refers to and the caller frees. Fails the test if it cannot be read. */
float *fixture_picture_read(const char *path, PictureView *view);

/* Mean over grid x grid blocks of |a - b| / (b + 0.01 mean b), with b the blocks of `reference`, whose size may
 * differ. */
double fixture_block_difference(PictureView picture, PictureView reference, int grid);

#endif
