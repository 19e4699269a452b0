/* The surfaces that separate media, and the medium that they leave at a place. For few rays, such as one per light:
 * every ray is intersected with all of these surfaces. */
#ifndef TWINLIGHT_SCENE_SEPARATIONS_H
#define TWINLIGHT_SCENE_SEPARATIONS_H

#include "base/array.h"
#include "layout/scene_view.h"
#include "scene/scene.h"

typedef struct Separations {
    SceneView view; /* geometry alone: alpha is not looked up */
    Array runs; /* SeparationRun, grouped by object */
    Array first_runs; /* uint: of each object, then the number of runs */
    Array tests; /* size_t: what testing a ray against all primitives of each object costs */
    size_t instance_count;
    size_t cost; /* of a ray against the surfaces that separate media, in tests of a triangle */
    size_t cost_all; /* and against all surfaces */
    size_t left; /* such tests until separations_medium_at gives up */
} Separations;

/* A place of which the medium is wanted. */
typedef struct SurroundedPoint {
    Vec3 p;
    Vec3 ng; /* normal of a surface that p is on, to whose side rays are sent; or 0 */
    uint expected; /* medium */
    uint around; /* the medium where a ray meets nothing */
} SurroundedPoint;

/* Collects the surfaces. The view, which is copied, and its arrays must outlive the object. Fails when out of memory;
 * to be destroyed in any case. */
bool separations_init(Separations *separations, const SceneView *view, size_t object_count, size_t instance_count,
                      Error *error);
void separations_destroy(Separations *separations);

/* The medium in which a ray is that begins at p in `medium` and has left the scene. */
uint separations_medium_behind(const Separations *separations, Vec3 p, uint medium);

/* The medium on the near side of the surfaces that separate media and are seen from p: rays through p can be in no
 * other. False if it is not known: other surfaces hide those, rays disagree because they are not closed, or the tests
 * are used up; then *medium is undefined. */
bool separations_medium_at(Separations *separations, const SurroundedPoint *point, uint *medium);

#endif
