/* Textures computed from coordinates alone: noise, dots, mixes by direction, bilinear interpolation. */
#include "math/noise.h"
#include "pbrt/errors.h"
#include "pbrt/state.h"
#include "pbrt/texture_builder.h"
#include "pbrt/values.h"

#include <math.h>

/* Limit of the weight of an octave over that of the one before: its powers must fit a float. */
#define NOISE_ROUGHNESS_MAX 2.0f

/* Octaves and roughness of a noise texture at points of the current space. */
static void noise_read(Builder *b, TextureOp *op)
{
    int octaves = param_integer(b->list, "octaves", 8);
    op->uv_map[0] = param_float(b->list, "roughness", 0.5f);
    op->index = (uint)octaves;
    op->mapping = MAPPING_3D;
    if (octaves < 1 || octaves > NOISE_OCTAVES_MAX)
        param_error(b->list, "octaves", "the number of octaves must be between 1 and %d", NOISE_OCTAVES_MAX);
    if (!(op->uv_map[0] >= 0.0f && op->uv_map[0] <= NOISE_ROUGHNESS_MAX))
        param_error(b->list, "roughness", "the roughness of noise must be between 0 and %g",
                    (double)NOISE_ROUGHNESS_MAX);
    builder_space(b, op);
}

void texture_fbm_read(Builder *b)
{
    TextureOp op = {.code = TEXTURE_FBM};
    noise_read(b, &op);
    builder_ops(b, &op, 1);
}

void texture_wrinkled_read(Builder *b)
{
    TextureOp op = {.code = TEXTURE_WRINKLED};
    noise_read(b, &op);
    builder_ops(b, &op, 1);
}

void texture_windy_read(Builder *b)
{
    TextureOp op = {.code = TEXTURE_WINDY, .mapping = MAPPING_3D};
    builder_space(b, &op);
    builder_ops(b, &op, 1);
}

void texture_marble_read(Builder *b)
{
    TextureOp op = {.code = TEXTURE_MARBLE};
    noise_read(b, &op);
    op.scale = param_float(b->list, "scale", 1.0f);
    op.uv_map[1] = param_float(b->list, "variation", 0.2f);
    builder_ops(b, &op, 1);
}

void texture_dots_read(Builder *b)
{
    TextureOp op = {.code = TEXTURE_DOTS};
    builder_operand(b, "inside", b->spectrum, 1.0f);
    builder_operand(b, "outside", b->spectrum, 0.0f);
    builder_mapping(b, &op);
    builder_ops(b, &op, 1);
}

/* Corners are constants, in the order of the op's operands. */
void texture_bilerp_read(Builder *b)
{
    static const char *const CORNERS[] = {"v00", "v10", "v01", "v11"};
    TextureOp op = {.code = TEXTURE_BILERP};
    for (int i = 0; i < 4; ++i) {
        float rgb[3] = {i >= 2 ? 1.0f : 0.0f, i >= 2 ? 1.0f : 0.0f, i >= 2 ? 1.0f : 0.0f};
        if (b->spectrum)
            value_color(b->im, b->list, CORNERS[i], COLOR_REFLECTANCE, rgb);
        else
            rgb[0] = rgb[1] = rgb[2] = param_float(b->list, CORNERS[i], rgb[0]);
        builder_constant(b, vec3(rgb[0], rgb[1], rgb[2]));
    }
    builder_mapping(b, &op);
    builder_ops(b, &op, 1);
}

/* The direction is given in the current space. */
void texture_direction_mix_read(Builder *b)
{
    TextureOp op = {.code = TEXTURE_DIRECTION_MIX};
    float dir[3] = {0.0f, 1.0f, 0.0f};
    Matrix ctm;
    builder_operand(b, "tex1", b->spectrum, 0.0f);
    builder_operand(b, "tex2", b->spectrum, 1.0f);
    param_vector(b->list, "dir", PARAM_VECTOR3, dir);
    if (b->list->failed || !import_ctm(b->im, b->im->place, &ctm)) {
        b->list->failed = true;
        return;
    }
    double world[3], length;
    for (int i = 0; i < 3; ++i)
        world[i] =
            ctm.m[4 * i] * (double)dir[0] + ctm.m[4 * i + 1] * (double)dir[1] + ctm.m[4 * i + 2] * (double)dir[2];
    length = sqrt(world[0] * world[0] + world[1] * world[1] + world[2] * world[2]);
    if (!(length > 0.0 && isfinite(length)))
        param_error(b->list, "dir", "the direction \"dir\" has no length after the current transform");
    op.value = vec3((float)(world[0] / length), (float)(world[1] / length), (float)(world[2] / length));
    builder_ops(b, &op, 1);
}
