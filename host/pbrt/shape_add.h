/* Shapes on their way into the scene. */
#ifndef TWINLIGHT_PBRT_SHAPE_ADD_H
#define TWINLIGHT_PBRT_SHAPE_ADD_H

#include "pbrt/context.h"

/* A shape's surroundings: material, transform, emission. */
typedef struct ShapeContext {
    Matrix ctm;
    Matrix inverse; /* valid when has_inverse */
    bool has_inverse;
    Shape shape; /* material, alpha, flags */
    AreaEmission emission;
    bool emits;
    bool invisible; /* interface material: parameters are checked, nothing is added */
    SourcePlace place;
} ShapeContext;

/* Adds a mesh of the space that context->ctm leads from: triangles (PRIMITIVE_TRIANGLE) or patches. Overwrites the
 * mesh's positions and normals. Vertices that are not finite after the transform are an error. */
bool shape_add_mesh(PbrtImport *im, const ShapeContext *context, uint kind, float *positions, float *normals,
                    const MeshData *mesh);

/* Adds a sphere or disk. */
bool shape_add_quadric(PbrtImport *im, const ShapeContext *context, uint kind, const Quadric *quadric);

/* Adds an emissive shape of an object definition to the world, transformed by the instance's ctm. */
bool emissive_shape_add(PbrtImport *im, const EmissiveShape *shape, const Matrix *ctm);

#endif
