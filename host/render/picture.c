#include "render/picture.h"

#include "image/despeckle.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- memory ------------------------------------------------------------------------------------------------------ */

/* OpenEXR holds a band packed, rearranged and compressed, each possibly slightly larger than the band; the rest is for
 * zlib, libpng and the header. */
#define SPARE_BANDS 4
#define SPARE_BYTES ((size_t)2 << 20)

static size_t depth_groups(uint last)
{
    last = last < SPLAT_DEPTH_MAX ? last : SPLAT_DEPTH_MAX;
    return last >= SPLAT_DEPTH_MIN ? last + 1 - SPLAT_DEPTH_MIN : 0;
}

/* Most groups that a picture with these settings has. */
static size_t groups_of(const PictureSettings *settings, uint depth)
{
    unsigned wanted = settings->layers ? settings->layers->wanted : 0;
    size_t groups = settings->despeckle > 0.0 ? 2 : 1;
    for (unsigned layer = 0; layer < LAYER_BY_DEPTH; ++layer)
        if ((wanted & LAYER_BIT(layer)) != 0)
            groups += layer == LAYER_HALVES ? 2 : 1;
    return groups + ((wanted & LAYER_BIT(LAYER_BY_DEPTH)) != 0 ? depth_groups(depth) : 0);
}

bool picture_memory_init(PictureMemory *memory, const PictureSettings *settings, int width, int height, uint depth,
                         Error *error)
{
    size_t row = 3 * (size_t)width, groups = groups_of(settings, depth);
    size_t plane = groups * EXR_BAND_ROWS * row, values = plane + 2 * row; /* despeckling reads a row above and below */
    memory->spare_bytes = SPARE_BANDS * plane * sizeof(float) + SPARE_BYTES + sizeof(uint64_t) * (size_t)height;
    memory->values = malloc(values * sizeof *memory->values);
    memory->plane = malloc(plane * sizeof *memory->plane);
    memory->spare = malloc(memory->spare_bytes);
    if (memory->values && memory->plane && memory->spare)
        return true;
    picture_memory_destroy(memory);
    return error_memory(error, (values + (SPARE_BANDS + 1) * plane) * sizeof(float) + SPARE_BYTES,
                        "writing the picture");
}

void picture_memory_destroy(PictureMemory *memory)
{
    free(memory->values);
    free(memory->plane);
    free(memory->spare);
    *memory = (PictureMemory){0};
}

void picture_memory_lend(PictureMemory *memory)
{
    free(memory->spare);
    memory->spare = NULL;
}

/* If this fails, the next write merely has no reserve. */
void picture_memory_take_back(PictureMemory *memory)
{
    memory->spare = malloc(memory->spare_bytes);
}

/* ---- groups ------------------------------------------------------------------------------------------------------ */

/* A group whose channels are `red`, `green` and `blue`. */
static PictureGroup *group_add(Picture *picture, PictureSource source, const char *red, const char *green,
                               const char *blue, bool half)
{
    const char *const names[3] = {red, green, blue};
    PictureGroup *group = &picture->groups[picture->group_count++];
    *group = (PictureGroup){.source = source, .values = picture->free};
    for (size_t c = 0; c < 3; ++c)
        picture->channels[picture->channel_count++] = (ExrChannel){names[c], group->values + c, 3, half};
    picture->free += 3 * (size_t)picture->width * EXR_BAND_ROWS;
    return group;
}

static void film_set(PictureGroup *group, const Film *film, FilmPart part, float scale)
{
    group->film = film;
    group->part = part;
    group->scale = film_scale_of(film, scale);
}

static bool wants(const Picture *picture, Layer layer)
{
    const RenderLayers *layers = picture->settings.layers;
    return layers && (layers->wanted & LAYER_BIT(layer)) != 0;
}

static void depths_add(Picture *picture, const Film *film)
{
    for (uint depth = SPLAT_DEPTH_MIN; depth <= film->depth_last; ++depth) {
        char(*names)[16] = picture->depth_names[depth];
        for (int c = 0; c < 3; ++c)
            snprintf(names[c], sizeof names[c], "depth%02u.%c", depth, "RGB"[c]);
        PictureGroup *group = group_add(picture, PICTURE_DEPTH, names[0], names[1], names[2], false);
        film_set(group, film, FILM_LIGHT, picture->settings.scale);
        group->depth = depth;
    }
}

/* Adds the layers that are parts of the picture's light. */
static void parts_add(Picture *picture, const Film *film)
{
    float scale = picture->settings.scale;
    if (film->light_samples == 0)
        return;
    if (wants(picture, LAYER_DIRECT))
        film_set(group_add(picture, PICTURE_FILM, "direct.R", "direct.G", "direct.B", false), film, FILM_OWN, scale);
    if (wants(picture, LAYER_INDIRECT))
        film_set(group_add(picture, PICTURE_FILM, "indirect.R", "indirect.G", "indirect.B", false), film, FILM_LIGHT,
                 scale);
    if (wants(picture, LAYER_HALVES)) {
        const Film *halves = picture->settings.layers->halves;
        film_set(group_add(picture, PICTURE_FILM, "halfA.R", "halfA.G", "halfA.B", false), &halves[0], FILM_ALL, scale);
        film_set(group_add(picture, PICTURE_FILM, "halfB.R", "halfB.G", "halfB.B", false), &halves[1], FILM_ALL, scale);
    }
    if (wants(picture, LAYER_VARIANCE))
        group_add(picture, PICTURE_VARIANCE, "variance.R", "variance.G", "variance.B", false);
    depths_add(picture, film);
}

static void variables_add(Picture *picture)
{
    const RenderLayers *layers = picture->settings.layers;
    if (wants(picture, LAYER_ALBEDO))
        film_set(group_add(picture, PICTURE_FILM, "albedo.R", "albedo.G", "albedo.B", true), &layers->aovs[AOV_ALBEDO],
                 FILM_ALL, 1.0f);
    if (wants(picture, LAYER_NORMAL))
        film_set(group_add(picture, PICTURE_FILM, "normal.X", "normal.Y", "normal.Z", true), &layers->aovs[AOV_NORMAL],
                 FILM_ALL, 1.0f);
    if (wants(picture, LAYER_DEPTH)) {
        film_set(group_add(picture, PICTURE_FILM, "Z", "", "", false), &layers->aovs[AOV_DEPTH], FILM_ALL, 1.0f);
        picture->channel_count -= 2; /* one channel, not three equal ones */
    }
}

void picture_init(Picture *picture, const PictureSettings *settings, const Film *film, const PictureMemory *memory)
{
    *picture = (Picture){
        .settings = *settings, .width = film->crop[2] - film->crop[0], .height = film->crop[3] - film->crop[1]};
    size_t row = 3 * (size_t)picture->width;
    picture->free = memory->values + row; /* leaves room for the row above the picture's own band */
    film_set(group_add(picture, PICTURE_FILM, "R", "G", "B", false), film, FILM_ALL, settings->scale);
    picture->free += row;
    parts_add(picture, film);
    variables_add(picture);
    if (settings->despeckle > 0.0)
        group_add(picture, PICTURE_DESPECKLED, "despeckled.R", "despeckled.G", "despeckled.B", false);
}

/* ---- bands ------------------------------------------------------------------------------------------------------- */

/* Extra rows above and below a band that despeckling reads; none at the picture's edges. */
static int rows_above(const Picture *picture, int first)
{
    return picture->settings.despeckle > 0.0 && first > 0 ? 1 : 0;
}

static int rows_below(const Picture *picture, int first, int count)
{
    return picture->settings.despeckle > 0.0 && first + count < picture->height ? 1 : 0;
}

/* The picture itself, with the extra rows around the band. */
static void own_band(const Picture *picture, int first, int count)
{
    const PictureGroup *own = &picture->groups[0];
    size_t width = (size_t)picture->width;
    int above = rows_above(picture, first), rows = above + count + rows_below(picture, first, count);
    film_resolve_pixels(own->film, own->part, own->scale, (size_t)(first - above) * width, (size_t)rows * width,
                        own->values - 3 * (size_t)above * width);
}

static void group_band(const Picture *picture, const PictureGroup *group, int first, int count)
{
    size_t width = (size_t)picture->width, pixel = (size_t)first * width, pixels = (size_t)count * width;
    int above = rows_above(picture, first), below = rows_below(picture, first, count);
    switch (group->source) {
    case PICTURE_FILM:
        film_resolve_pixels(group->film, group->part, group->scale, pixel, pixels, group->values);
        break;
    case PICTURE_DEPTH:
        film_resolve_depth(group->film, group->depth, group->scale, pixel, pixels, group->values);
        break;
    case PICTURE_VARIANCE:
        render_layers_variance(picture->settings.layers, picture->settings.scale, pixel, pixels, group->values);
        break;
    case PICTURE_DESPECKLED:
        despeckle(picture->groups[0].values - 3 * (size_t)above * width, picture->width, above + count + below, above,
                  count, (float)picture->settings.despeckle, group->values);
        break;
    }
}

void picture_band(Picture *picture, int first, int count)
{
    assert(count <= EXR_BAND_ROWS);
    own_band(picture, first, count);
    for (size_t i = 1; i < picture->group_count; ++i)
        group_band(picture, &picture->groups[i], first, count);
}

const float *picture_row(Picture *picture, int y)
{
    group_band(picture, &picture->groups[0], y, 1);
    return picture->groups[0].values;
}
