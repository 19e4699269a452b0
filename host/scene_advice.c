#include "scene_advice.h"

#include "log.h"

/* Whether all that the material scatters goes where a mirror or smooth glass sends it. */
static bool material_is_delta(const Material *m)
{
    return m->kind == MATERIAL_THIN_DIELECTRIC ||
           ((m->kind == MATERIAL_DIELECTRIC || m->kind == MATERIAL_CONDUCTOR) && !scene_material_is_rough(m));
}

void scene_advise(const Scene *scene)
{
    bool delta = false;
    for (size_t i = 0; i < scene->materials.count; ++i)
        delta = delta || material_is_delta(&ARRAY_AT(&scene->materials, Material, i));
    if (delta && (scene->features & FEATURE_DELTA_LIGHT) != 0)
        log_message(LOG_INFO, "light of point, spot and distant lights that passes smooth glass or mirrors both before "
                              "and after a rough surface is found by no integrator and is missing; give a sun its size "
                              "(an infinite light's image), or a lamp a small sphere");
}
