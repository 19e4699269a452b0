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

static int depth_groups(uint last)
{
    last = last < SPLAT_DEPTH_MAX ? last : SPLAT_DEPTH_MAX;
    return last >= SPLAT_DEPTH_MIN ? (int)(last + 1 - SPLAT_DEPTH_MIN) : 0;
}

static bool wants(const PictureSettings *settings, Layer layer)
{
    return settings->layers && (settings->layers->wanted & LAYER_BIT(layer)) != 0;
}

/* Most groups that a picture with these settings has. */
static size_t groups_of(const PictureSettings *settings, uint depth)
{
    int groups = settings->despeckle > 0.0 ? 2 : 1;
#define COUNT(NAME, name, text, count)                                                                                 \
    if (wants(settings, LAYER_##NAME))                                                                                 \
        groups += LAYER_##NAME == LAYER_BY_DEPTH ? depth_groups(depth) : (count);
    LAYER_LIST_LIGHT(COUNT)
#undef COUNT
#define COUNT(NAME, ...) groups += wants(settings, LAYER_##NAME) ? 1 : 0;
    AOV_LIST(COUNT)
#undef COUNT
    return (size_t)groups;
}

bool picture_memory_init(PictureMemory *memory, const PictureSettings *settings, int width, int height, uint depth,
                         int threads, Error *error)
{
    size_t row = 3 * (size_t)width, groups = groups_of(settings, depth);
    size_t plane = groups * EXR_BAND_ROWS * row, values = plane + 2 * row; /* despeckling reads a row above and below */
    *memory = (PictureMemory){.lane_count = threads < PICTURE_LANES_MAX ? threads : PICTURE_LANES_MAX};
    memory->lane_count = memory->lane_count > 1 ? memory->lane_count : 1;
    memory->picture_values = groups * row * (size_t)height;
    size_t lanes = (size_t)memory->lane_count;
    memory->spare_bytes =
        SPARE_BANDS * lanes * plane * sizeof(float) + lanes * SPARE_BYTES + sizeof(uint64_t) * (size_t)height;
    memory->spare = malloc(memory->spare_bytes);
    bool complete = memory->spare != NULL;
    for (size_t i = 0; i < lanes; ++i) {
        memory->lanes[i].values = malloc(values * sizeof *memory->lanes[i].values);
        memory->lanes[i].plane = malloc(plane * sizeof *memory->lanes[i].plane);
        complete = complete && memory->lanes[i].values && memory->lanes[i].plane;
    }
    if (complete)
        return true;
    picture_memory_destroy(memory);
    return error_memory(error, lanes * ((values + (SPARE_BANDS + 1) * plane) * sizeof(float) + SPARE_BYTES),
                        "writing the picture");
}

void picture_memory_destroy(PictureMemory *memory)
{
    for (int i = 0; i < PICTURE_LANES_MAX; ++i) {
        free(memory->lanes[i].values);
        free(memory->lanes[i].plane);
    }
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
    *group = (PictureGroup){.source = source, .channel = red, .channels = 3, .values = picture->free};
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

/* A group of light: part of `film`, in channels name.R, .G and .B. */
#define LIGHT_ADD(picture, name, film, part)                                                                           \
    film_set(group_add(picture, PICTURE_FILM, name ".R", name ".G", name ".B", false), film, part,                     \
             (picture)->settings.scale)

static void direct_add(Picture *picture, const Film *film)
{
    LIGHT_ADD(picture, "direct", film, FILM_OWN);
}

static void indirect_add(Picture *picture, const Film *film)
{
    LIGHT_ADD(picture, "indirect", film, FILM_LIGHT);
}

static void halves_add(Picture *picture, const Film *film)
{
    (void)film;
    LIGHT_ADD(picture, "halfA", &picture->settings.layers->halves[0], FILM_ALL);
    LIGHT_ADD(picture, "halfB", &picture->settings.layers->halves[1], FILM_ALL);
}

static void variance_add(Picture *picture, const Film *film)
{
    (void)film;
    group_add(picture, PICTURE_VARIANCE, "variance.R", "variance.G", "variance.B", false);
}

static void by_depth_add(Picture *picture, const Film *film)
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
    if (film->light_samples == 0)
        return;
#define ADD(NAME, name, text, groups)                                                                                  \
    if (wants(&picture->settings, LAYER_##NAME))                                                                       \
        name##_add(picture, film);
    LAYER_LIST_LIGHT(ADD)
#undef ADD
}

static void variable_add(Picture *picture, uint aov, uint values, const char *red, const char *green, const char *blue)
{
    bool one = !green[0];
    PictureGroup *group = group_add(picture, PICTURE_VARIABLE, red, green, blue, values == AOV_LIGHTLIKE);
    group->variable = &picture->settings.layers->aovs[aov];
    group->channels = one ? 1 : 3;
    picture->channel_count -= one ? 2 : 0; /* not three equal ones */
}

static void variables_add(Picture *picture)
{
#define ADD(NAME, name, text, values, red, green, blue)                                                                \
    if (wants(&picture->settings, LAYER_##NAME))                                                                       \
        variable_add(picture, AOV_##NAME, values, red, green, blue);
    AOV_LIST(ADD)
#undef ADD
}

void picture_init(Picture *picture, const PictureSettings *settings, const Film *film, const PictureMemory *memory,
                  int lane)
{
    *picture = (Picture){
        .settings = *settings, .width = film->crop[2] - film->crop[0], .height = film->crop[3] - film->crop[1]};
    size_t row = 3 * (size_t)picture->width;
    picture->free = memory->lanes[lane].values + row; /* leaves room for the row above the picture's own band */
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

void picture_group_band(const Picture *picture, const PictureGroup *group, int first, int count)
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
    case PICTURE_VARIABLE:
        aov_image_resolve(group->variable, pixel, pixels, group->values);
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
        picture_group_band(picture, &picture->groups[i], first, count);
}

const float *picture_row(Picture *picture, int y)
{
    picture_group_band(picture, &picture->groups[0], y, 1);
    return picture->groups[0].values;
}
