#include "scene/coats_setup.h"

#include "scene/coat_base_table.h"
#include "scene/coat_table.h"
#include "scene/features.h"

static bool roughness_is_textured(const Material *m)
{
    return m->roughness_u.program != NONE || m->roughness_v.program != NONE;
}

/* Building a table takes milliseconds, and every coated material is compared with all of them. */
#define COATS_MAX 4096

/* Whether m can use the table of `other`. */
static bool coat_serves(const Material *m, const Material *other)
{
    if (other->kind != m->kind || (m->kind == MATERIAL_COATED_CONDUCTOR && other->scale != m->scale))
        return false;
    if (other->eta != m->eta || roughness_is_textured(m) != roughness_is_textured(other))
        return false;
    return roughness_is_textured(m) ||
           (material_alpha(m, &m->roughness_u) == material_alpha(other, &other->roughness_u) &&
            material_alpha(m, &m->roughness_v) == material_alpha(other, &other->roughness_v));
}

static bool interface_build(const Material *m, Array *lookup, uint32_t *first, Error *error)
{
    if (roughness_is_textured(m))
        return coat_table_build_range(m->eta, lookup, first, error);
    return coat_table_build(material_alpha(m, &m->roughness_u), material_alpha(m, &m->roughness_v), m->eta, lookup,
                            first, error);
}

static bool coat_build(Material *m, Array *lookup, Error *error)
{
    uint32_t interface; /* follows the record */
    if (m->kind != MATERIAL_COATED_CONDUCTOR)
        return interface_build(m, lookup, &m->coat_table, error);
    return coat_base_build(m->eta, m->scale, interface_is_rough(m), lookup, &m->coat_table, error) &&
           (!interface_is_rough(m) || interface_build(m, lookup, &interface, error));
}

/* Sets the table of m: that of an equal material in `owners` (uint), or a new one, which makes m an owner. */
static bool coat_find(Scene *scene, Array *owners, uint index, Error *error)
{
    Material *m = &ARRAY_AT(&scene->materials, Material, index);
    for (size_t j = 0; j < owners->count; ++j) {
        const Material *other = &ARRAY_AT(&scene->materials, Material, ARRAY_AT(owners, uint, j));
        if (coat_serves(m, other)) {
            m->coat_table = other->coat_table;
            return true;
        }
    }
    if (owners->count >= COATS_MAX) {
        error_set(error, "the scene has more than %d different coats", COATS_MAX);
        return error_fix(error, "give coated materials fewer values of roughness, eta and thickness");
    }
    uint *owner = array_grow(owners, 1, error);
    if (!owner)
        return false;
    *owner = index;
    return coat_build(m, &scene->lookup, error);
}

bool coats_setup(Scene *scene, Error *error)
{
    Array owners;
    bool good = true;
    array_init(&owners, sizeof(uint));
    for (size_t i = 0; good && i < scene->materials.count; ++i) {
        Material *m = &ARRAY_AT(&scene->materials, Material, i);
        m->coat_table = NONE;
        if (m->kind == MATERIAL_COATED_DIFFUSE)
            m->color1.value.y = coat_round_trip(m->eta, m->color1.value.x);
        if (m->kind == MATERIAL_COATED_CONDUCTOR || (m->kind == MATERIAL_COATED_DIFFUSE && scene_material_is_rough(m)))
            good = coat_find(scene, &owners, (uint)i, error);
    }
    array_destroy(&owners);
    return good;
}
