/* A texture's program under construction, from the parameters of its directive. */
#ifndef TWINLIGHT_PBRT_TEXTURE_BUILDER_H
#define TWINLIGHT_PBRT_TEXTURE_BUILDER_H

#include "pbrt/context.h"

/* Maximum number of ops of a texture, including those of the textures it refers to, which can double at each level. */
#define TEXTURE_OPS_MAX 256

/* A program under construction. */
typedef struct Builder {
    PbrtImport *im;
    ParamList *list;
    bool spectrum;
    TextureOp ops[TEXTURE_OPS_MAX];
    uint count;
} Builder;

/* Each does nothing to the program if builder->list has failed, and lets it fail on errors. */

/* Appends `count` ops; fails if there are too many. */
void builder_ops(Builder *b, const TextureOp *ops, uint count);

/* Appends an op that pushes `value`. */
void builder_constant(Builder *b, Vec3 value);

/* Appends a parameter that is a texture or a constant; returns the index of its first op. */
uint builder_operand(Builder *b, const char *name, bool spectrum, float fallback);

/* Sets the space of an op to the current one. */
void builder_space(Builder *b, TextureOp *op);

/* Reads the two-dimensional mapping of an op. A mapping accepts only its own parameters; those of other mappings are
 * unknown, as in pbrt. */
void builder_mapping(Builder *b, TextureOp *op);

/* Read the parameters of a kind of texture (pbrt/texture_procedural.c). */
void texture_fbm_read(Builder *b);
void texture_wrinkled_read(Builder *b);
void texture_windy_read(Builder *b);
void texture_marble_read(Builder *b);
void texture_dots_read(Builder *b);
void texture_bilerp_read(Builder *b);
void texture_direction_mix_read(Builder *b);

#endif
