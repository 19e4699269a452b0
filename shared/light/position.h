/* What lights at a point have in common. */
#ifndef TWINLIGHT_LIGHT_POSITION_H
#define TWINLIGHT_LIGHT_POSITION_H

#include "layout/path_types.h"
#include "light/emission.h"

/* For light_NAME_sample of lights with a position: sets all but radiance. False: ref is that position. */
SHARED_FUNCTION bool position_light_sample(const SceneView *scene, __global const Light *source, Vec3 ref,
                                           LightSample *sample, float *distance2)
{
    sample->p = light_detail(scene, source)->position;
    Vec3 d = vec3_sub(sample->p, ref);
    *distance2 = vec3_length_squared(d);
    if (!(*distance2 > 0.0f))
        return false;
    sample->infinite = 0u;
    sample->wi = vec3_scale(d, 1.0f / float_sqrt(*distance2));
    return true;
}

/* For light_NAME_emit: all but w and pdf_w. */
SHARED_FUNCTION void position_light_emit(const SceneView *scene, __global const Light *source, LightEmission *emission)
{
    emission->p = light_detail(scene, source)->position;
    emission->pdf_p = 1.0f;
    emission->delta_position = 1u;
}

#endif
