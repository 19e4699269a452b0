#include "mmlt/combined_image.h"

#include "base/zeros.h"
#include "camera/film_sum.h"

#include <stdlib.h>
#include <string.h>

/* Floats for the light of paths of fewer than `segments` segments. */
static size_t depths_before(const Film *film, uint segments)
{
    return film_depth_place((uint)film_pixels(film), 1, segments, FILM_KIND_LIGHT);
}

bool combined_image_init(CombinedImage *image, const Film *film, Error *error)
{
    size_t values = 3 * film_pixels(film), depths = film->depth_sums ? depths_before(film, film->depth_last + 1) : 0;
    *image =
        (CombinedImage){.light = zeros_alloc(values, sizeof *image->light), .values = values, .depth_values = depths};
    if (depths > 0)
        image->depths = zeros_alloc(depths, sizeof *image->depths);
    return (image->light && (depths == 0 || image->depths)) ||
           error_memory(error, (values + depths) * sizeof(float), "a generation's picture");
}

bool paths_change_init(PathsChange *change, size_t values, Error *error)
{
    paths_change_forget(change);
    change->values = zeros_alloc(values, sizeof *change->values);
    return change->values || error_memory(error, values * sizeof *change->values, "the picture by path tracing");
}

void paths_change_forget(PathsChange *change)
{
    free(change->values);
    *change = (PathsChange){NULL, 0};
}

void paths_change_archive(Archive *archive, PathsChange *change, size_t values)
{
    bool known = change->values != NULL;
    Error error;
    archive_flags(archive, &known, 1, "whether path tracing is kept");
    if (archive->failed)
        return;
    if (!known)
        paths_change_forget(change);
    else if (!change->values && !paths_change_init(change, values, &error))
        archive_fail(archive, "%s", error_text(&error));
    else
        archive_floats(archive, change->values, values, RANGE_FLOATS, "the picture by path tracing");
    ARCHIVE_FIELD(archive, change->samples);
}

void combined_image_destroy(CombinedImage *image)
{
    free(image->light);
    free(image->depths);
    *image = (CombinedImage){0};
}

void combined_image_begin(CombinedImage *image, Combination *learner, Combination *teacher,
                          const double samples[ESTIMATOR_COUNT])
{
    image->learner = learner;
    image->teacher = teacher;
    image->worth = combination_weights_set(teacher, samples);
    image->saturated = image->vanished = image->not_finite = 0;
    memcpy(image->samples, samples, sizeof image->samples);
    memset(image->light, 0, image->values * sizeof *image->light);
    if (image->depths)
        memset(image->depths, 0, image->depth_values * sizeof *image->depths);
}

/* Sums of an estimator, 3 values a pixel, and the image that they go to. */
typedef struct EstimatorSums {
    const int64_t *light, *own, *rare;
    float *into;
} EstimatorSums;

typedef struct ImageAdding {
    CombinedImage *image;
    Film *film;
    bool take; /* empties the film */
    EstimatorKind kind;
    FilmLearning learning;
} ImageAdding;

/* Weights of the film's layers in a tile. */
typedef struct LayerWeights {
    double light, own, rare;
} LayerWeights;

/* Whether the estimator's film holds rare light. */
static bool rare_left(EstimatorKind kind)
{
    return kind == ESTIMATOR_CHAINS || kind == ESTIMATOR_PATHS;
}

/* Path tracing shows the part paths_rare of rare light itself, which is in its light; chains add the rest. Pools and
 * chains share the excess. */
static LayerWeights layer_weights(const CombinationTile *tile, EstimatorKind kind)
{
    double paths = tile->weight[ESTIMATOR_PATHS], by_chains = paths * (1.0 - tile->paths_rare);
    LayerWeights weights = {.light = tile->weight[kind]};
    if (kind == ESTIMATOR_CHAINS)
        weights.own = 1.0 - paths - tile->weight[ESTIMATOR_BIDIRECTIONAL];
    if (rare_left(kind))
        weights.rare = kind == ESTIMATOR_CHAINS ? by_chains : -by_chains;
    return weights;
}

/* Adds the values of the pixels first ... end - 1 of one tile. */
static void values_add(const EstimatorSums *sums, LayerWeights weights, double scale, size_t first, size_t end)
{
    for (size_t i = 3 * first; i < 3 * end; ++i) {
        double sum = weights.light * (double)film_sum_shown(sums->light[i]);
        if (weights.own > 0.0)
            sum += weights.own * (double)film_sum_shown(sums->own[i]);
        if (sums->rare)
            sum += weights.rare * (double)film_sum_shown(sums->rare[i]);
        sums->into[i] = (float)((double)sums->into[i] + scale * sum);
    }
}

static void sums_add(const ImageAdding *adding, EstimatorSums sums, RowRange pixels)
{
    const CombinedImage *image = adding->image;
    const Combination *teacher = image->teacher;
    const double scale = (double)image->worth / image->samples[adding->kind];
    for (size_t pixel = pixels.first, end; pixel < pixels.end; pixel = end) {
        const CombinationTile *tile = &teacher->known[combination_tile_of(teacher, pixel)];
        end = combination_run_end(teacher, pixel, TILE_SIDE);
        values_add(&sums, layer_weights(tile, adding->kind), scale, pixel, end);
    }
}

/* The sums of all depths, or of paths of `segments` segments. */
static EstimatorSums film_sums(const ImageAdding *adding)
{
    const Film *film = adding->film;
    return (EstimatorSums){film->light_sums, film->sums, rare_left(adding->kind) ? film->rare_sums : NULL,
                           adding->image->light};
}

static EstimatorSums film_sums_of(const ImageAdding *adding, uint segments)
{
    const Film *film = adding->film;
    return (EstimatorSums){film_depth_sums(film, segments, FILM_KIND_LIGHT),
                           film_depth_sums(film, segments, FILM_KIND_OWN),
                           rare_left(adding->kind) ? film_depth_sums(film, segments, FILM_KIND_RARE) : NULL,
                           adding->image->depths + depths_before(film, segments)};
}

/* Path tracing alone would show all of its light, rare light included ... */
static void change_add_paths(const ImageAdding *adding, RowRange pixels)
{
    float *values = adding->image->change->values;
    for (size_t i = 3 * pixels.first; i < 3 * pixels.end; ++i)
        values[i] = (float)((double)values[i] + (double)film_sum_shown(adding->film->light_sums[i]));
}

/* ... and not the image. */
static void change_subtract_image(const CombinedImage *image, RowRange pixels)
{
    for (size_t i = 3 * pixels.first; i < 3 * pixels.end; ++i)
        image->change->values[i] -= image->light[i];
}

static void pixels_empty(const ImageAdding *adding, RowRange pixels)
{
    if (adding->kind == ESTIMATOR_BIDIRECTIONAL)
        film_pixels_clear_light(adding->film, pixels.first, pixels.end);
    else
        film_pixels_clear(adding->film, pixels.first, pixels.end);
}

static void row_add(void *context, size_t row)
{
    const ImageAdding *adding = context;
    const Combination *learner = adding->image->learner;
    RowRange pixels = combination_row_pixels(learner, row);
    learner->rows[row].full = film_full_pixels_of(adding->film, pixels.first, pixels.end);
    combination_row_learn(&adding->learning, row);
    if (adding->image->samples[adding->kind] > 0.0)
        sums_add(adding, film_sums(adding), pixels);
    if (adding->kind == ESTIMATOR_PATHS && adding->image->change)
        change_add_paths(adding, pixels);
    for (uint segments = SPLAT_DEPTH_MIN; adding->image->depths && segments <= adding->film->depth_last; ++segments)
        sums_add(adding, film_sums_of(adding, segments), pixels);
    if (adding->take)
        pixels_empty(adding, pixels);
}

/* Samples of direct light: those of path tracing, and those of bidirectional path tracing that are shown. */
static double direct_samples(const CombinedImage *image)
{
    const bool trial = image->teacher->bidirectional_trial;
    return image->samples[ESTIMATOR_PATHS] + (trial ? 0.0 : image->samples[ESTIMATOR_BIDIRECTIONAL]);
}

static void film_add(CombinedImage *image, EstimatorKind kind, Film *film, bool take)
{
    ImageAdding adding = {.image = image, .film = film, .take = take, .kind = kind};
    combination_learning_begin(&adding.learning, image->learner, kind, film, image->samples[kind],
                               direct_samples(image));
    combination_rows_run(image->learner, row_add, &adding);
    /* A sum that is full in an estimator need not be so in the combination. */
    for (int row = 0; row < image->learner->tiles[1]; ++row)
        image->saturated += image->learner->rows[row].full;
    image->saturated += film->saturated;
    image->vanished += film->vanished;
    image->not_finite += film->not_finite;
}

void combined_image_add(CombinedImage *image, EstimatorKind kind, Film *film)
{
    if (image->samples[kind] > 0.0 || (kind == ESTIMATOR_PATHS && direct_samples(image) > 0.0))
        film_add(image, kind, film, false);
}

void combined_image_take(CombinedImage *image, EstimatorKind kind, Film *film)
{
    const uint32_t every = kind == ESTIMATOR_BIDIRECTIONAL ? film->every_count : 0;
    if (image->samples[kind] > 0.0)
        film_add(image, kind, film, true);
    film_counters_clear(film);
    film->every_count = every;
}

typedef struct ImageFinishing {
    const CombinedImage *image;
    Film *film;
} ImageFinishing;

static void sums_set(int64_t *sums, const float *light, RowRange pixels)
{
    for (size_t i = 3 * pixels.first; i < 3 * pixels.end; ++i)
        sums[i] = film_sum_rounded((double)light[i]);
}

static void row_finish(void *context, size_t row)
{
    const ImageFinishing *finishing = context;
    const CombinedImage *image = finishing->image;
    Film *film = finishing->film;
    RowRange pixels = combination_row_pixels(image->learner, row);
    sums_set(film->light_sums, image->light, pixels);
    if (image->change)
        change_subtract_image(image, pixels);
    for (uint segments = SPLAT_DEPTH_MIN; image->depths && segments <= film->depth_last; ++segments)
        sums_set(film_depth_sums(film, segments, FILM_KIND_LIGHT), image->depths + depths_before(film, segments),
                 pixels);
}

void combined_image_finish(const CombinedImage *image, Film *film)
{
    ImageFinishing finishing = {image, film};
    combination_rows_run(image->learner, row_finish, &finishing);
    if (image->change)
        image->change->samples += (int64_t)image->samples[ESTIMATOR_PATHS] - (int64_t)image->worth;
    film->light_samples = image->worth;
    film->saturated = image->saturated;
    film->vanished = image->vanished;
    film->not_finite = image->not_finite;
}
