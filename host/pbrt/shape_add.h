/* Adds shapes to the scene. */
#ifndef TWINLIGHT_PBRT_SHAPE_ADD_H
#define TWINLIGHT_PBRT_SHAPE_ADD_H

#include "pbrt/context.h"

/* Context of a shape: material, transform, emission. */
typedef struct ShapeContext {
    Matrix ctm;
    Matrix inverse; /* valid if has_inverse */
    bool has_inverse;
    Shape shape; /* material, alpha, flags */
    AreaEmission emission;
    bool emits;
    bool interface; /* the shape has no material */
    bool invisible; /* and it separates no media: parameters are checked, but nothing is added */
    SourcePlace place;
} ShapeContext;

/* Adds a mesh, transformed by context->ctm: triangles (PRIMITIVE_TRIANGLE) or patches. Overwrites `positions` and
 * `normals`. Fails for vertices that are not finite or too large after the transform. */
bool shape_add_mesh(PbrtImport *im, const ShapeContext *context, uint kind, float *positions, float *normals,
                    const MeshData *mesh);

/* Adds curves, with control points and widths in the current space, which it overwrites. Widths are multiplied by the
 * transform's mean scale, the cube root of its determinant. */
bool shape_add_curves(PbrtImport *im, const ShapeContext *context, CurveData *data, Curve *curves);

/* Adds a sphere, disk or cylinder. */
bool shape_add_quadric(PbrtImport *im, const ShapeContext *context, uint kind, const Quadric *quadric);

/* Adds an emissive shape of an object definition to the world, transformed by the instance's ctm. */
bool emissive_shape_add(PbrtImport *im, const EmissiveShape *shape, const Matrix *ctm);

#endif
