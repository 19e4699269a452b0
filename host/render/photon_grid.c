#include "render/photon_grid.h"

#include "base/key_sort.h"
#include "base/parallel.h"
#include "path/photon.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Photons on either side of a photon in the order of the grid that its predictions are compared with. The best two
 * comparisons must agree: the others may belong to light that came another way. */
#define COMPARED 8

/* The spread of slopes, relative to the standard deviation of the light's points and to the errors of predictions. For
 * an even disc and exact predictions the variance is least with 1.8; docs/CAUSTICS.md. */
#define SPREAD_OF_LIGHT 1.8
#define SPREAD_OF_ERROR 1.0

/* Least spread: rounding of directions. */
#define SPREAD_MIN 1e-6

/* Steradians: photons of lights with an extent whose lobe is wider are left out, since chance draws such a direction
 * often enough. */
#define LOBE_MAX 0.2

/* Kinds of photons that are counted; more are in the last group. */
#define KINDS_MAX 64u

/* Of the grid around the photons, relative to their extent: by rounding, places on their surfaces are outside it. */
#define GRID_MARGIN 1e-3f

/* Photons in an occupied cell of the coarsest level that is used, on average. */
#define CELL_PHOTONS 8u

/* Photons whose errors a thread finds at a time. */
#define SPREAD_PART 4096u

/* A record by its group and, within that, its code. */
typedef KeyedItem GridEntry;

/* Photons of one light without extent (or of all others) and one kind of path. */
typedef struct GridKind {
    uint light, vertices, lobes, count;
} GridKind;

/* Bits of a code. */
#define CODE_BITS (3u * PHOTON_LEVELS)

static uint entry_group(const GridEntry *entry)
{
    return (uint)(entry->key >> CODE_BITS);
}

static uint64_t entry_code(const GridEntry *entry)
{
    return entry->key & (((uint64_t)1 << CODE_BITS) - 1);
}

static void entry_set_group(GridEntry *entry, uint group)
{
    entry->key = (uint64_t)group << CODE_BITS | entry_code(entry);
}

void photon_grid_bounds(const Vec3 *first, size_t stride, uint count, PhotonParams *params)
{
    Vec3 low = *first, high = low;
    for (uint i = 1; i < count; ++i) {
        Vec3 p = *(const Vec3 *)((const char *)first + i * stride);
        low = vec3(float_min(low.x, p.x), float_min(low.y, p.y), float_min(low.z, p.z));
        high = vec3(float_max(high.x, p.x), float_max(high.y, p.y), float_max(high.z, p.z));
    }
    float side = float_max(vec3_max_component(vec3_sub(high, low)), 1e-6f * (1.0f + vec3_length(high)));
    float margin = GRID_MARGIN * side;
    params->origin = vec3_sub(low, vec3_splat(margin));
    params->cells_per_unit = (float)PHOTON_CELLS / (side + 3.0f * margin);
}

static bool kind_has(const GridKind *kind, const PhotonRecord *record)
{
    return kind->light == record->light && kind->vertices == record->vertices && kind->lobes == record->lobes;
}

/* Gives the most frequent kinds a group each, and the rest the last. */
static void groups_assign(GridEntry *entries, uint count)
{
    GridKind kinds[KINDS_MAX], *order[PHOTON_GROUPS - 1] = {0};
    uint known = 0;
    for (uint i = 0; i < count; ++i) {
        const PhotonRecord *record = entries[i].item;
        uint k = 0;
        while (k < known && !kind_has(&kinds[k], record))
            ++k;
        if (k == known && known < KINDS_MAX)
            kinds[known++] = (GridKind){record->light, record->vertices, record->lobes, 0};
        if (k < known)
            ++kinds[k].count;
    }
    for (uint g = 0; g + 1 < PHOTON_GROUPS; ++g) {
        for (uint k = 0; k < known; ++k)
            if (kinds[k].count > 0 && (!order[g] || kinds[k].count > order[g]->count))
                order[g] = &kinds[k];
        for (uint i = 0; i < count && order[g]; ++i)
            if (entry_group(&entries[i]) == PHOTON_GROUPS - 1 && kind_has(order[g], entries[i].item))
                entry_set_group(&entries[i], g);
        if (order[g])
            order[g]->count = 0;
    }
}

/* The finest level whose occupied cells hold CELL_PHOTONS on average. */
static uint level_choose(const GridEntry *entries, uint count)
{
    for (uint level = PHOTON_LEVELS; level > 1u; --level) {
        uint shift = 3u * (PHOTON_LEVELS - level), cells = 1;
        for (uint i = 1; i < count; ++i)
            cells += entry_code(&entries[i]) >> shift != entry_code(&entries[i - 1]) >> shift;
        if (count / cells >= CELL_PHOTONS)
            return level;
    }
    return 1u;
}

/* How far the predictions of entry i are from what photons nearby have found. */
static double prediction_error(const GridEntry *entries, uint count, uint i)
{
    const PhotonRecord *own = entries[i].item;
    double least = HUGE_VAL, second = HUGE_VAL; /* squared errors */
    for (int k = -COMPARED; k <= COMPARED; ++k) {
        if (k == 0 || (int64_t)i + k < 0 || (int64_t)i + k >= (int64_t)count)
            continue;
        const PhotonRecord *other = entries[(int64_t)i + k].item;
        Vec3 moved = vec3_sub(other->light_point, own->light_point);
        const double light_moved[2] = {(double)vec3_dot(moved, own->axes[0]), (double)vec3_dot(moved, own->axes[1])};
        double slopes[2], predicted[2];
        if (entry_group(&entries[(int64_t)i + k]) != entry_group(&entries[i]) || other->light != own->light ||
            !photon_slopes(own->direction, other->direction, slopes))
            continue;
        photon_predict(own, other->point, light_moved, predicted);
        const double a = slopes[0] - predicted[0], b = slopes[1] - predicted[1], square = a * a + b * b;
        second = fmin(second, fmax(least, square));
        least = fmin(least, square);
    }
    const double agreed = second < HUGE_VAL ? second : least;
    return agreed < HUGE_VAL ? sqrt(agreed) : 1.0;
}

/* Covariance of the slopes that show the light's points: by_light extent by_light^T; xx, xy, yy. */
static void slopes_covariance(const PhotonRecord *record, double covariance[3])
{
    const double *m = record->by_light, *e = record->extent,
                 a[4] = {m[0] * e[0] + m[1] * e[1], m[0] * e[1] + m[1] * e[2], m[2] * e[0] + m[3] * e[1],
                         m[2] * e[1] + m[3] * e[2]};
    covariance[0] = a[0] * m[0] + a[1] * m[1];
    covariance[1] = a[0] * m[2] + a[1] * m[3];
    covariance[2] = a[2] * m[2] + a[3] * m[3];
}

/* The lower triangular factor of the covariance of the light's spread and that of the prediction's error. */
static void spread_set(PhotonRecord *record, double error)
{
    const double light = SPREAD_OF_LIGHT * SPREAD_OF_LIGHT, own = fmax(SPREAD_OF_ERROR * error, SPREAD_MIN);
    double covariance[3];
    slopes_covariance(record, covariance);
    double root = sqrt(light * covariance[0] + own * own), below = light * covariance[1] / root;
    record->spread[0] = root;
    record->spread[1] = below;
    record->spread[2] = sqrt(fmax(light * covariance[2] + own * own - below * below, own * own));
}

/* The part of a lobe that the light fills. */
static double light_part(const PhotonRecord *record)
{
    const double *by_light = record->by_light, *e = record->extent;
    double filled = fabs(by_light[0] * by_light[3] - by_light[1] * by_light[2]) *
                    sqrt(fmax(e[0] * e[2] - e[1] * e[1], 0.0)) * SPREAD_OF_LIGHT * SPREAD_OF_LIGHT;
    return fmin(filled / (record->spread[0] * record->spread[2]), 1.0);
}

static bool record_is_useful(const PhotonRecord *record)
{
    return record->light != NONE || M_PI * record->spread[0] * record->spread[2] < LOBE_MAX;
}

typedef struct SpreadSearch {
    GridEntry *entries;
    uint count;
} SpreadSearch;

/* Sets the spreads of a part of the entries. */
static void spreads_set(void *context, size_t part)
{
    const SpreadSearch *search = context;
    const uint first = (uint)part * SPREAD_PART;
    const uint end = search->count - first < SPREAD_PART ? search->count : first + SPREAD_PART;
    for (uint i = first; i < end; ++i)
        spread_set(search->entries[i].item, prediction_error(search->entries, search->count, i));
}

/* Sets the spreads of sorted entries. Returns the mean, over the useful entries, of the part of the lobe that the light
 * fills; 1 if none is useful. */
static double entries_spread(GridEntry *entries, uint count, int threads)
{
    SpreadSearch search = {entries, count};
    double sum = 0.0;
    uint useful = 0;
    parallel_run((count + SPREAD_PART - 1) / SPREAD_PART, threads, spreads_set, &search);
    for (uint i = 0; i < count; ++i)
        if (record_is_useful(entries[i].item)) {
            sum += light_part(entries[i].item);
            ++useful;
        }
    return useful > 0 ? sum / useful : 1.0;
}

/* Leaves out entries of no use; returns how many remain. */
static uint entries_keep(GridEntry *entries, uint count)
{
    uint kept = 0;
    for (uint i = 0; i < count; ++i)
        if (record_is_useful(entries[i].item))
            entries[kept++] = entries[i];
    return kept;
}

static void vector_put(uint *words, Vec3 v)
{
    words[0] = float_bits(v.x);
    words[1] = float_bits(v.y);
    words[2] = float_bits(v.z);
}

/* Two numbers in a word, for photon_pair. */
static uint pair_put(const double numbers[2])
{
    const uint half = 0x8000u; /* rounds to the nearest */
    return ((float_bits((float)numbers[0]) + half) & 0xffff0000u) | (float_bits((float)numbers[1]) + half) >> 16;
}

static void words_fill(const GridEntry *entries, uint count, uint *words)
{
    for (uint i = 0; i < count; ++i) {
        const PhotonRecord *record = entries[i].item;
        uint *photon = words + photon_record_at(count, i);
        words[PHOTON_CODE_WORDS * (size_t)i] = (uint)entry_code(&entries[i]);
        words[PHOTON_CODE_WORDS * (size_t)i + 1] = (uint)(entry_code(&entries[i]) >> 32u);
        vector_put(photon + PHOTON_POINT, record->point);
        vector_put(photon + PHOTON_DIRECTION, record->direction);
        for (int row = 0; row < 2; ++row)
            photon[PHOTON_BY_PLACE + (uint)row] = pair_put(record->by_place + 2 * row);
        for (int k = 0; k < 3; ++k)
            photon[PHOTON_SPREAD + (uint)k] = float_bits((float)record->spread[k]);
        photon[PHOTON_LIGHT] = record->light;
    }
}

/* Where the groups begin, and their levels. */
static void groups_set(const GridEntry *entries, PhotonParams *params)
{
    for (uint g = 0, i = 0; g < PHOTON_GROUPS; ++g) {
        params->first[g] = i;
        while (i < params->count && entry_group(&entries[i]) == g)
            ++i;
        params->first[g + 1] = i;
        params->level[g] = level_choose(entries + params->first[g], i - params->first[g]);
    }
}

/* Where the directories of the groups that have photons are: of the finest cells with which they take no more words
 * than there are photons. Returns the words of all. */
static size_t directories_place(PhotonParams *params)
{
    size_t groups = 0, words = 0;
    for (uint g = 0; g < PHOTON_GROUPS; ++g)
        groups += params->first[g] < params->first[g + 1];
    while (params->directory_level < PHOTON_LEVELS &&
           groups * (((size_t)8 << 3u * params->directory_level) + 1) <= params->count)
        ++params->directory_level;
    for (uint g = 0; g < PHOTON_GROUPS && params->directory_level > 0; ++g) {
        params->directory[g] = (uint)(photon_record_at(params->count, params->count) + words);
        if (params->first[g] < params->first[g + 1])
            words += ((size_t)1 << 3u * params->directory_level) + 1;
    }
    return words;
}

static void directories_fill(const PhotonParams *params, uint *words)
{
    const uint shift = 3u * (PHOTON_LEVELS - params->directory_level), cells = 1u << 3u * params->directory_level;
    for (uint g = 0; g < PHOTON_GROUPS && params->directory_level > 0; ++g) {
        const uint first = params->first[g], end = params->first[g + 1];
        uint photon = first;
        for (uint cell = 0; first < end && cell <= cells; ++cell) {
            while (photon < end && photon_code_at(words, photon) >> shift < cell)
                ++photon;
            words[params->directory[g] + cell] = photon;
        }
    }
}

/* Fills `entries` with every `every`-th record in the order of the grid, which params has the place of; returns their
 * number, or 0 if there is no memory to sort them. There are records. */
static uint entries_fill(const PhotonRecords *records, uint every, PhotonParams params, GridEntry *entries)
{
    uint count = 0;
    for (uint i = 0; i < records->count; i += every) {
        PhotonRecord *record = &records->records[i];
        entries[count] = (GridEntry){photon_code(params, record->point), record};
        entry_set_group(&entries[count++], PHOTON_GROUPS - 1);
    }
    groups_assign(entries, count);
    return key_sort(entries, count) ? count : 0;
}

/* Entries of every `every`-th record in the order of the grid, with spreads; NULL: no memory. Sets the grid's place. */
static GridEntry *entries_make(PhotonRecords *records, uint every, PhotonParams *params, uint *count, double *missed,
                               Error *error)
{
    GridEntry *entries = malloc(records->count * sizeof *entries);
    photon_grid_bounds(&records->records[0].point, sizeof *records->records, records->count, params);
    *count = entries ? entries_fill(records, every, *params, entries) : 0;
    if (*count == 0) {
        free(entries);
        error_memory(error, records->count * sizeof *entries, "photons");
        return NULL;
    }
    *missed = 1.0 - entries_spread(entries, *count, records->threads);
    return entries;
}

bool photon_grid_missed(PhotonRecords *records, const PhotonLights *lights, uint every, double *missed, Error *error)
{
    PhotonParams params = lights->params;
    uint count;
    GridEntry *entries = entries_make(records, every, &params, &count, missed, error);
    free(entries);
    return entries != NULL;
}

bool photon_grid_make(PhotonRecords *records, const PhotonLights *lights, PhotonMap *map, double *missed, Error *error)
{
    uint count;
    map->params = lights->params;
    GridEntry *entries = entries_make(records, 1, &map->params, &count, missed, error);
    if (!entries)
        return false;
    count = entries_keep(entries, count);
    map->params.count = count;
    if (count == 0) {
        free(entries);
        *map = (PhotonMap){0};
        return true;
    }
    groups_set(entries, &map->params);
    map->word_count = photon_record_at(count, count) + directories_place(&map->params);
    size_t bytes = map->word_count * sizeof *map->words;
    map->words = malloc(bytes);
    if (map->words) {
        words_fill(entries, count, map->words);
        directories_fill(&map->params, map->words);
    }
    free(entries);
    return map->words || error_memory(error, bytes, "photons");
}
