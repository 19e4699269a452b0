#include "serve/snapshot.h"

#include "base/parallel.h"
#include "base/timing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- layers ------------------------------------------------------------------------------------------------------ */

SnapshotLayer *snapshot_find(Snapshot *snapshot, const char *name)
{
    for (size_t i = 0; i < snapshot->layer_count; ++i)
        if (strcmp(snapshot->layers[i].name, name) == 0)
            return &snapshot->layers[i];
    return NULL;
}

static SnapshotLayer *layer_add(Snapshot *snapshot, const char *name, int channels)
{
    SnapshotLayer *layer = &snapshot->layers[snapshot->layer_count++];
    *layer = (SnapshotLayer){.channels = channels};
    snprintf(layer->name, sizeof layer->name, "%s", name);
    return layer;
}

/* "direct" of "direct.R", "depth" of "Z", "picture" of "R". */
static void name_make(char *name, size_t size, const char *channel)
{
    const char *text = strchr(channel, '.') ? channel : SNAPSHOT_PICTURE;
#define NAME(NAME, name, layer, values, red, ...) text = strcmp(channel, red) == 0 ? (layer) : text;
    AOV_LIST(NAME)
#undef NAME
    snprintf(name, size, "%.*s", (int)strcspn(text, "."), text);
}

/* The layer of a group of channels; added if it is new. */
static SnapshotLayer *layer_of(Snapshot *snapshot, const PictureGroup *group)
{
    char name[sizeof snapshot->layers[0].name];
    name_make(name, sizeof name, group->channel);
    SnapshotLayer *layer = snapshot_find(snapshot, name);
    return layer ? layer : layer_add(snapshot, name, group->channels);
}

void snapshot_init(Snapshot *snapshot, int width, int height)
{
    *snapshot = (Snapshot){.width = width, .height = height};
    pthread_mutex_init(&snapshot->lock, NULL);
    layer_add(snapshot, SNAPSHOT_PICTURE, 3);
}

void snapshot_destroy(Snapshot *snapshot)
{
    for (size_t i = 0; i < snapshot->layer_count; ++i)
        free(snapshot->layers[i].rgb);
    pthread_mutex_destroy(&snapshot->lock);
}

void snapshot_ask(SnapshotLayer *layer)
{
    layer->wanted = timing_now() + SNAPSHOT_WANTED_SECONDS;
}

void snapshot_watch(Snapshot *snapshot)
{
    snapshot->watched = timing_now() + SNAPSHOT_WANTED_SECONDS;
}

void snapshot_reader_count(Snapshot *snapshot, double *counted)
{
    double now = timing_thread();
    snapshot->cost += now - *counted;
    *counted = now;
}

/* ---- publishing -------------------------------------------------------------------------------------------------- */

/* A publication: bands of the wanted layers, by several threads. */
typedef struct Publication {
    const SnapshotSource *source;
    int height;
    size_t count;
    size_t groups[PICTURE_GROUPS_MAX]; /* of the picture */
    float *rgb[PICTURE_GROUPS_MAX]; /* of their layers */
} Publication;

/* Resolves every lane_count-th band. */
static void lane_publish(void *context, size_t lane)
{
    const Publication *publication = context;
    const SnapshotSource *source = publication->source;
    Picture picture;
    picture_init(&picture, source->settings, source->film, source->memory, (int)lane);
    size_t row = 3 * (size_t)picture.width;
    for (int first = (int)lane * EXR_BAND_ROWS; first < picture.height;
         first += source->memory->lane_count * EXR_BAND_ROWS) {
        int rows = picture.height - first < EXR_BAND_ROWS ? picture.height - first : EXR_BAND_ROWS;
        for (size_t i = 0; i < publication->count; ++i) {
            const PictureGroup *group = &picture.groups[publication->groups[i]];
            picture_group_band(&picture, group, first, rows);
            memcpy(publication->rgb[i] + (size_t)first * row, group->values, (size_t)rows * row * sizeof(float));
        }
    }
}

/* Notes the groups of layers that are wanted; those for which there is no memory are left out. */
static void layers_choose(Snapshot *snapshot, const Picture *picture, Publication *publication)
{
    double now = timing_now();
    size_t values = 3 * (size_t)snapshot->width * (size_t)snapshot->height;
    for (size_t i = 0; i < picture->group_count; ++i) {
        const PictureGroup *group = &picture->groups[i];
        if (group->source == PICTURE_DESPECKLED)
            continue;
        SnapshotLayer *layer = layer_of(snapshot, group);
        if (layer->wanted < now && !layer->once)
            continue;
        layer->once = false;
        layer->rgb = layer->rgb ? layer->rgb : malloc(values * sizeof *layer->rgb);
        if (!layer->rgb)
            continue;
        layer->version = snapshot->version + 1;
        publication->rgb[publication->count] = layer->rgb;
        publication->groups[publication->count++] = i;
    }
}

/* The time between the latest publication and the next one. */
static double seconds_between(const Snapshot *snapshot)
{
    double cheap = snapshot->cost / (SNAPSHOT_TIME_PART * (double)snapshot->threads);
    return fmin(fmax(SNAPSHOT_SECONDS, cheap), SNAPSHOT_SECONDS_MOST);
}

bool snapshot_due(Snapshot *snapshot)
{
    double now = timing_now();
    if (pthread_mutex_trylock(&snapshot->lock) != 0)
        return false;
    bool wanted = snapshot->watched >= now;
    for (size_t i = 0; i < snapshot->layer_count && !wanted; ++i)
        wanted = snapshot->layers[i].wanted >= now;
    if (wanted && (snapshot->version == 0 || now >= snapshot->published + seconds_between(snapshot)))
        return true;
    pthread_mutex_unlock(&snapshot->lock);
    return false;
}

void snapshot_publish(Snapshot *snapshot, const SnapshotSource *source)
{
    double begin = timing_now();
    Picture picture;
    Publication publication = {.source = source, .height = snapshot->height};
    picture_init(&picture, source->settings, source->film, source->memory, 0);
    layers_choose(snapshot, &picture, &publication);
    parallel_run((size_t)source->memory->lane_count, source->memory->lane_count, lane_publish, &publication);
    snapshot->status = *source->status;
    ++snapshot->version;
    snapshot->published = timing_now();
    snapshot->threads = source->memory->lane_count;
    snapshot->cost = (snapshot->published - begin) * (double)snapshot->threads;
}

bool snapshot_copy(Snapshot *snapshot, const char *name, uint64_t *version, float *rgb)
{
    pthread_mutex_lock(&snapshot->lock);
    const SnapshotLayer *layer = snapshot_find(snapshot, name);
    bool newer = layer && layer->rgb && layer->version > *version;
    if (newer) {
        memcpy(rgb, layer->rgb, 3 * (size_t)snapshot->width * (size_t)snapshot->height * sizeof *rgb);
        *version = layer->version;
    }
    pthread_mutex_unlock(&snapshot->lock);
    return newer;
}
