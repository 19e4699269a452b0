#include "mmlt/blend.h"

#include "camera/film_sum.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a sample of each stream takes, in samples of path tracing: typical ones of the CPU backend. Figures that do not
 * depend on the machine, so that the image does not either. */
static const double COSTS[BLEND_STREAMS] = {1.2, 4.0, 1.0};

/* Before anything is known, work of path tracing counts for so much of that of pools. With all of it, a lamp in glass had a
 * third more square error in small pictures and beaten metal a sixth; with none, a large one of a diffuse room had a third more. */
#define FIRST_PATHS 0.25

/* Keeps what has no variance, because it is black, from a division by zero. */
#define SPREAD_MIN 1e-30

/* A plan divides the time into so many parts. */
#define PLAN_PARTS 20

/* What chains show varies by where they begin, which falls with the pools' samples, and by what they do then, which falls with
 * their steps. In the time T the two are a / T_pool + b / T_steps, and the best division gives pools the part
 * sqrt(a) / (sqrt(a) + sqrt(b)) of it: this one. Measured at equal time on a lamp in glass, a glossy hall and a door ajar,
 * 128 x 128 pixels and 20 seconds of one thread: with 0.25 the blocks of 8 x 8 pixels have 1.3 to 2 times the square error,
 * with 0.8 pixels have, but for their worst hundredth, 1.3 to 1.6 times. 0.4 and 0.55 differ by less than six pictures can
 * tell. */
#define POOL_PART 0.45

double blend_work(const double samples[BLEND_STREAMS])
{
    double work = 0.0;
    for (int s = 0; s < BLEND_STREAMS; ++s)
        work += COSTS[s] * samples[s];
    return work;
}

bool blend_init(Blend *blend, const Film *film, Error *error)
{
    *blend = (Blend){0};
    for (int i = 0; i < 2; ++i) {
        blend->size[i] = film->crop[i + 2] - film->crop[i];
        blend->tiles[i] = (blend->size[i] + BLEND_TILE - 1) / BLEND_TILE;
    }
    size_t tiles = blend_tile_count(blend);
    blend->known = calloc(tiles, sizeof *blend->known);
    blend->rarity = malloc(tiles * sizeof *blend->rarity);
    blend->gaps = calloc(tiles, sizeof *blend->gaps);
    if (!blend->known || !blend->rarity || !blend->gaps)
        return error_memory(error, tiles * (sizeof *blend->known + 2 * sizeof *blend->gaps), "tiles");
    for (size_t i = 0; i < tiles; ++i)
        blend->rarity[i] = 1.0;
    for (int s = 0; s < BLEND_SERIES; ++s)
        if (!pixel_series_init(&blend->pixels[s], film_pixels(film), 1, error) ||
            !pixel_series_init(&blend->sums[s], blend_tile_count(blend), 1, error))
            return false;
    return pixel_series_init(&blend->direct, film_pixels(film), 1, error);
}

void blend_destroy(Blend *blend)
{
    for (int s = 0; s < BLEND_SERIES; ++s) {
        pixel_series_destroy(&blend->pixels[s]);
        pixel_series_destroy(&blend->sums[s]);
    }
    pixel_series_destroy(&blend->direct);
    free(blend->known);
    free(blend->rarity);
    free(blend->gaps);
    *blend = (Blend){0};
}

/* ---- a generation ------------------------------------------------------------------------------------------------ */

/* How a tile is best shown with so many samples of every stream. */
typedef struct TileBlend {
    double paths; /* the share of path tracing with what it does not show */
    double chains; /* the share of chains among themselves and the pool, which share what pools do not show */
    double variance;
} TileBlend;

/* Two estimates: chains with the pool, of variance a, and path tracing with what it does not show, of variance b. The latter
 * comes from the same chains as much of the former, c is what both have of it. The share w of the second that makes
 * (1 - w)^2 a + w^2 b + 2 w (1 - w) c smallest. */
static TileBlend tile_blend(const BlendTile *tile, const double samples[BLEND_STREAMS])
{
    const double *spread = tile->spread;
    double by_chains = samples[BLEND_CHAINS] / fmax(spread[BLEND_CHAINS], SPREAD_MIN);
    double by_pool = samples[BLEND_POOL] / fmax(spread[BLEND_POOL], SPREAD_MIN);
    double a = 1.0 / (by_chains + by_pool) + spread[BLEND_EXCESS] / samples[BLEND_CHAINS];
    TileBlend best = {.chains = by_chains / (by_chains + by_pool), .variance = a};
    if (!(samples[BLEND_PATHS] > 0.0))
        return best;
    double rare = spread[BLEND_RARE] / samples[BLEND_CHAINS], c = best.chains * fmin(rare, a);
    double b = fmax(spread[BLEND_PATHS], SPREAD_MIN) / samples[BLEND_PATHS] + rare, both = a + b - 2.0 * c;
    best.paths = both > 0.0 ? fmin(fmax((a - c) / both, 0.0), 1.0) : 0.0;
    best.variance = (1.0 - best.paths) * (1.0 - best.paths) * a + best.paths * best.paths * b +
                    2.0 * best.paths * (1.0 - best.paths) * c;
    return best;
}

/* Whether the variances of all streams that have samples are there. */
static bool blend_known(const Blend *blend, const double samples[BLEND_STREAMS])
{
    for (int s = 0; s < BLEND_STREAMS; ++s)
        if (samples[s] > 0.0 && !blend->ready[s])
            return false;
    return true;
}

/* Of each stream in the tile; all of them 1 together. Before anything is known, what counts is the work, and chains are worth
 * the pool from which they begin. So a large picture, of which the first pools see few pixels, is path traced at first. */
static void shares_set(Blend *blend, BlendTile *tile, const double samples[BLEND_STREAMS], bool known)
{
    memset(tile->share, 0, sizeof tile->share);
    if (blend->shown > 0 && samples[blend->shown - 1] > 0.0) {
        tile->share[blend->shown - 1] = 1.0;
    } else if (known) {
        TileBlend best = tile_blend(tile, samples);
        tile->share[BLEND_PATHS] = best.paths;
        tile->share[BLEND_CHAINS] = (1.0 - best.paths) * best.chains;
        tile->share[BLEND_POOL] = (1.0 - best.paths) * (1.0 - best.chains);
    } else {
        double pool = COSTS[BLEND_POOL] * samples[BLEND_POOL];
        double paths = FIRST_PATHS * COSTS[BLEND_PATHS] * samples[BLEND_PATHS];
        tile->share[BLEND_CHAINS] = tile->share[BLEND_POOL] = pool / (2.0 * pool + paths);
        tile->share[BLEND_PATHS] = paths / (2.0 * pool + paths);
    }
    for (int s = 0; s < BLEND_STREAMS; ++s)
        blend->share[s] += tile->share[s] / (double)blend_tile_count(blend);
}

/* Sums of the same paths in the films of all streams: 3 a pixel. */
typedef struct StreamSums {
    int64_t *light[BLEND_STREAMS]; /* below the limits */
    const int64_t *excess, *rare; /* of chains: what pools and what path tracing do not show */
} StreamSums;

static StreamSums stream_sums(Film *const films[])
{
    StreamSums sums = {.excess = films[BLEND_CHAINS]->sums, .rare = films[BLEND_CHAINS]->rare_sums};
    for (int s = 0; s < BLEND_STREAMS; ++s)
        sums.light[s] = films[s]->light_sums;
    return sums;
}

/* Those of paths of so many segments. */
static StreamSums stream_depth_sums(Film *const films[], uint segments)
{
    StreamSums sums = {.excess = film_depth_sums(films[BLEND_CHAINS], segments, FILM_KIND_OWN),
                       .rare = film_depth_sums(films[BLEND_CHAINS], segments, FILM_KIND_RARE)};
    for (int s = 0; s < BLEND_STREAMS; ++s)
        sums.light[s] = film_depth_sums(films[s], segments, FILM_KIND_LIGHT);
    return sums;
}

/* Those of the chains' light become the blend of all, of so much work. */
static void sums_join(const Blend *blend, const StreamSums *sums, const double samples[BLEND_STREAMS], double work)
{
    size_t values = 3 * (size_t)blend->size[0] * (size_t)blend->size[1];
    for (size_t i = 0; i < values; ++i) {
        const BlendTile *tile = &blend->known[blend_tile_of(blend, i / 3)];
        double sum = ((1.0 - tile->share[BLEND_PATHS]) * (double)film_sum_shown(sums->excess[i]) +
                      tile->share[BLEND_PATHS] * (double)film_sum_shown(sums->rare[i])) /
                     samples[BLEND_CHAINS];
        for (int s = 0; s < BLEND_STREAMS; ++s)
            if (samples[s] > 0.0)
                sum += tile->share[s] * (double)film_sum_shown(sums->light[s][i]) / samples[s];
        sums->light[BLEND_CHAINS][i] = film_sum_rounded(sum * work);
    }
}

/* The streams' light and the direct light become the chains' film, whose number of samples is now what the generation took:
 * that is its weight among others, which may have divided their time differently. */
static void films_join(Blend *blend, Film *const films[])
{
    Film *into = films[BLEND_CHAINS];
    size_t pixels = film_pixels(into);
    double samples[BLEND_STREAMS];
    for (int s = 0; s < BLEND_STREAMS; ++s)
        samples[s] = (double)films[s]->light_samples;
    bool known = blend_known(blend, samples);
    double work = fmax(1.0, rint(blend_work(samples)));
    /* What is full in a stream need not be so in the blend. */
    uint64_t full = 0;
    for (int s = 0; s < BLEND_STREAMS; ++s)
        full += film_full_pixels(films[s]);
    memset(blend->share, 0, sizeof blend->share);
    for (size_t i = 0; i < blend_tile_count(blend); ++i)
        shares_set(blend, &blend->known[i], samples, known);
    StreamSums sums = stream_sums(films);
    sums_join(blend, &sums, samples, work);
    for (uint segments = SPLAT_DEPTH_MIN; into->depth_sums && segments <= into->depth_last; ++segments) {
        sums = stream_depth_sums(films, segments);
        sums_join(blend, &sums, samples, work);
    }
    into->light_samples = (uint64_t)work;
    memcpy(into->sums, films[BLEND_PATHS]->sums, 3 * pixels * sizeof *into->sums);
    memcpy(into->counts, films[BLEND_PATHS]->counts, pixels * sizeof *into->counts);
    for (int s = BLEND_CHAINS + 1; s < BLEND_STREAMS; ++s) {
        into->saturated += films[s]->saturated;
        into->vanished += films[s]->vanished;
        into->not_finite += films[s]->not_finite;
    }
    into->saturated += full;
}

bool blend_generation(Blend *blend, Blend *teacher, Film *const films[BLEND_STREAMS], const atomic_int *stop,
                      Error *error)
{
    size_t pixels = film_pixels(films[BLEND_CHAINS]), values = pixels + blend_tile_count(blend);
    double *ratios = malloc(blend_tile_count(blend) * sizeof *ratios);
    float *picture = malloc(values * sizeof *picture);
    if (ratios && picture) {
        blend_films_learn(blend, films, picture, picture + pixels, stop);
        films_join(teacher, films);
        if (!*stop)
            blend_spreads_update(blend, ratios);
    } else {
        error_memory(error, values * sizeof *picture, "a generation's pictures");
    }
    bool done = ratios && picture;
    free(ratios);
    free(picture);
    return done;
}

/* ---- how much of each -------------------------------------------------------------------------------------------- */

/* How a step of chains varies by so many samples of pools for each, in units of its variance by itself: 1 + a / b times the
 * cost of all steps over that of the samples. */
static double step_variance(double pool_per_step)
{
    const double root = POOL_PART / (1.0 - POOL_PART);
    return 1.0 + root * root * COSTS[BLEND_CHAINS] / (COSTS[BLEND_POOL] * pool_per_step);
}

/* How a step varies in a plan, over how it has varied with the pools so far. */
static double chains_factor(const Blend *blend, const double samples[BLEND_STREAMS])
{
    double pools = (double)blend->sums[BLEND_POOL].weight[0], steps = (double)blend->sums[BLEND_CHAINS].weight[0];
    return step_variance(samples[BLEND_POOL] / samples[BLEND_CHAINS]) / step_variance(pools / steps);
}

/* Mean over the tiles. */
static double mean_light(const Blend *blend)
{
    double light = 0.0;
    for (size_t i = 0; i < blend_tile_count(blend); ++i)
        light += blend->known[i].light / (double)blend_tile_count(blend);
    return light;
}

void blend_errors(const Blend *blend, const double samples[BLEND_STREAMS], double *errors)
{
    double light = mean_light(blend);
    bool known = blend_known(blend, samples) && light > 0.0;
    for (size_t i = 0; i < blend_tile_count(blend); ++i) {
        const BlendTile *tile = &blend->known[i];
        double square = tile->light * tile->light + DARK_PART * light * light;
        errors[i] = known ? tile_blend(tile, samples).variance / square : 0.0;
    }
}

/* Relative square error of the picture from so many samples of every stream. */
static double error_of(const Blend *blend, const double samples[BLEND_STREAMS])
{
    double sum = 0.0, light = mean_light(blend), factor = chains_factor(blend, samples);
    for (size_t i = 0; i < blend_tile_count(blend); ++i) {
        BlendTile tile = blend->known[i];
        tile.spread[BLEND_CHAINS] *= factor;
        tile.spread[BLEND_EXCESS] *= factor;
        tile.spread[BLEND_RARE] *= factor;
        sum += (tile_blend(&tile, samples).variance + tile.direct / samples[BLEND_PATHS]) /
               (tile.light * tile.light + DARK_PART * light * light);
    }
    return sum;
}

BlendPlan blend_plan(const Blend *blend)
{
    BlendPlan best = {0};
    double least = HUGE_VAL;
    for (int s = 0; s < BLEND_STREAMS; ++s)
        if (!blend->ready[s])
            return best;
    for (int paths = 1; paths < PLAN_PARTS; ++paths)
        for (int pool = 1; paths + pool < PLAN_PARTS; ++pool) {
            double samples[BLEND_STREAMS] = {
                [BLEND_CHAINS] = PLAN_PARTS - paths - pool, [BLEND_POOL] = pool, [BLEND_PATHS] = paths};
            for (int s = 0; s < BLEND_STREAMS; ++s)
                samples[s] /= COSTS[s];
            double error = error_of(blend, samples);
            if (error < least) {
                least = error;
                best.paths_per_step = samples[BLEND_PATHS] / samples[BLEND_CHAINS];
                best.pool_per_step = samples[BLEND_POOL] / samples[BLEND_CHAINS];
            }
        }
    return best;
}
