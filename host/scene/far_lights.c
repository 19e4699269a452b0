#include "scene/far_lights.h"

#include "light/delta.h"

#include <math.h>

/* The part of the power that is divided by power: so a light has at least a quarter of its samples if another one, of a
 * small solid angle, takes the rest, which may not reach the scene at all. */
#define FAR_BY_POWER 0.25

/* Smaller solid angles count as this, that of the sun. */
#define SOLID_ANGLE_LEAST 6.8e-5

static bool is_far(const Scene *scene, size_t light)
{
    return light_is_far(light_kind(&ARRAY_AT(&scene->lights, Light, light)));
}

static double concentrated(double power, double solid_angle)
{
    return power / sqrt(fmax(solid_angle, SOLID_ANGLE_LEAST));
}

void far_lights_divide(const Scene *scene, double *powers, const double *solid_angles)
{
    double all = 0.0, all_concentrated = 0.0;
    size_t count = 0;
    for (size_t i = 0; i < scene->lights.count; ++i)
        if (is_far(scene, i) && powers[i] > 0.0) {
            all += powers[i];
            all_concentrated += concentrated(powers[i], solid_angles[i]);
            ++count;
        }
    if (count < 2 || !isfinite(all_concentrated))
        return;
    for (size_t i = 0; i < scene->lights.count; ++i)
        if (is_far(scene, i))
            powers[i] = FAR_BY_POWER * powers[i] +
                        (1.0 - FAR_BY_POWER) * all * (concentrated(powers[i], solid_angles[i]) / all_concentrated);
}

void far_lights_bound(const Scene *scene, double *powers)
{
    double far = 0.0, near = 0.0;
    for (size_t i = 0; i < scene->lights.count; ++i)
        *(is_far(scene, i) ? &far : &near) += powers[i];
    for (size_t i = 0; near > 0.0 && far > near && i < scene->lights.count; ++i)
        if (is_far(scene, i))
            powers[i] *= near / far;
}
