/* Finds the rectangles through which rays from infinity come, from a sample of those rays. */
#ifndef TWINLIGHT_RENDER_OPENING_FIT_H
#define TWINLIGHT_RENDER_OPENING_FIT_H

#include "base/error.h"
#include "layout/openings.h"
#include "render/opening_search.h"

/* Fills in up to `capacity` openings but for their light, and sets *count: none unless they reduce the variance by
 * much, compared with rays that start on a disc of that radius. `side` is 0 if light comes from both sides. Fails
 * when out of memory. */
bool openings_fit(FarRay *rays, size_t ray_count, float radius, Opening *openings, size_t capacity, size_t *count,
                  Error *error);

#endif
