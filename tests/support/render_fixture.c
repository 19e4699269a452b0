#include "support/render_fixture.h"

#include "backend_cpu.h"
#include "image/read.h"
#include "pbrt/import.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void require(bool done, const Error *error)
{
    if (!done)
        ck_abort_msg("%s (%s)", error->message, error->fix);
}

void fixture_scene(const RenderSetup *setup, Scene *scene)
{
    Error error = {0};
    ImportOptions options = {0};
    scene_init(scene);
    if (setup->text)
        require(pbrt_import_text(setup->text, strlen(setup->text), "test.pbrt", ".", &options, scene, &error), &error);
    else
        require(pbrt_import(setup->path, &options, scene, &error), &error);
    require(scene_finish(scene, &error), &error);
    if (setup->width > 0) {
        int crop[4] = {0, 0, setup->width, setup->height};
        require(scene_film_set(scene, setup->width, setup->height, crop, &error), &error);
    }
}

static const BackendInterface *setup_interface(const RenderSetup *setup)
{
    return setup->backend ? setup->backend : backend_cpu();
}

Backend *fixture_open(const RenderSetup *setup, const Scene *scene, Error *error)
{
    BackendScene view = scene_backend_view(scene);
    BackendOptions options = {.threads = setup->threads > 0 ? setup->threads : 2,
                              .batch = setup->batch,
                              .film = setup->film_on_device ? FILM_ON_DEVICE : FILM_ON_HOST,
                              .record_spans = setup->record_spans};
    return setup_interface(setup)->open(&view, &options, error);
}

static bool picture_save(void *context, const Film *film, const RenderTotals *totals, Error *error)
{
    (void)totals;
    (void)error;
    film_resolve(film, 1.0f, context);
    return true;
}

void fixture_render(const RenderSetup *setup, RenderedImage *image)
{
    Error error = {0};
    Scene scene;
    memset(image, 0, sizeof *image);
    const BackendInterface *interface = setup_interface(setup);
    fixture_scene(setup, &scene);
    image->width = scene.settings.width;
    image->height = scene.settings.height;
    Backend *backend = fixture_open(setup, &scene, &error);
    require(backend != NULL, &error);
    require(film_init(&image->film, image->width, image->height, scene.settings.crop, &error), &error);
    if (setup->quantum_of)
        image->film.quantum_exponent = setup->quantum_of->quantum_exponent;
    RenderOptions options = {.first_sample = setup->first_sample,
                             .samples = setup->samples,
                             .error = setup->error,
                             .max_depth = setup->max_depth > 0 ? setup->max_depth : scene.settings.max_depth,
                             .seed = setup->seed,
                             .photons = setup->photons,
                             .no_openings = setup->no_openings,
                             .reconstruction = setup->reconstruction,
                             .chains = setup->chains,
                             .layers = setup->layers,
                             .balance = setup->balance,
                             .only_strategy = setup->only_strategy,
                             .strategy = {setup->strategy[0], setup->strategy[1]},
                             .save_every = setup->saved ? 1e9 : 0.0,
                             .unweighted = setup->unweighted};
    RenderCallbacks callbacks = {.save = setup->saved ? picture_save : NULL, .context = setup->saved};
    const RenderTask task = {.integrator = setup->integrator ? setup->integrator : integrator_pt(),
                             .scene = &scene,
                             .backend = {interface, backend},
                             .options = &options,
                             .callbacks = &callbacks,
                             .keep_quantum = setup->quantum_of != NULL};
    if (setup->after_another) {
        Film another;
        require(film_init(&another, image->width, image->height, scene.settings.crop, &error), &error);
        ++options.seed;
        require(render_film(&task, &another, &image->result, &error), &error);
        --options.seed;
        film_destroy(&another);
    }
    require(render_film(&task, &image->film, &image->result, &error), &error);
    interface->close(backend);
    image->rgb = malloc((size_t)image->width * (size_t)image->height * 3 * sizeof *image->rgb);
    ck_assert_ptr_nonnull(image->rgb);
    film_resolve(&image->film, scene.settings.film_scale, image->rgb);
    scene_destroy(&scene);
}

void fixture_destroy(RenderedImage *image)
{
    film_destroy(&image->film);
    free(image->rgb);
    memset(image, 0, sizeof *image);
}

double fixture_block_mean(const float *rgb, int width, int x0, int y0, int x1, int y1)
{
    double sum = 0.0;
    for (int y = y0; y < y1; ++y)
        for (int i = 3 * (y * width + x0); i < 3 * (y * width + x1); ++i)
            sum += (double)rgb[i];
    return sum / (3.0 * (x1 - x0) * (y1 - y0));
}

double fixture_mean(const RenderedImage *image)
{
    return fixture_block_mean(image->rgb, image->width, 0, 0, image->width, image->height);
}

float *fixture_picture_read(const char *path, PictureView *view)
{
    Error error = {0};
    float *rgb;
    require(image_read_rgb(path, &rgb, &view->width, &view->height, &error), &error);
    view->rgb = rgb;
    return rgb;
}

/* The mean of block (i, j) of a grid x grid division. */
static double grid_mean(PictureView picture, int i, int j, int grid)
{
    int x0 = (int)lrint((double)picture.width * i / grid), x1 = (int)lrint((double)picture.width * (i + 1) / grid);
    int y0 = (int)lrint((double)picture.height * j / grid), y1 = (int)lrint((double)picture.height * (j + 1) / grid);
    return fixture_block_mean(picture.rgb, picture.width, x0, y0, x1, y1);
}

double fixture_block_difference(PictureView picture, PictureView reference, int grid)
{
    double floor_value = 0.01 * grid_mean(reference, 0, 0, 1), sum = 0.0;
    for (int j = 0; j < grid; ++j)
        for (int i = 0; i < grid; ++i) {
            double b = grid_mean(reference, i, j, grid);
            sum += fabs(grid_mean(picture, i, j, grid) - b) / (b + floor_value);
        }
    return sum / (grid * grid);
}
