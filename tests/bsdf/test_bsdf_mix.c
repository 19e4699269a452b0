/* The choice among the materials of a mix. */
#include "bsdf/material.h"
#include "support/bsdf_cases.h"

#define DRAWS 4096

/* A mix of material 1 with another mix, of 3 and 4 in equal parts. */
static void materials_set(Material materials[5], float amount)
{
    memset(materials, 0, 5 * sizeof *materials);
    for (int i = 0; i < 5; ++i)
        materials[i].kind = MATERIAL_DIFFUSE;
    materials[0] = (Material){
        .kind = MATERIAL_MIX, .mix_a = amount < 0.5f ? 2 : 1, .mix_b = amount < 0.5f ? 1 : 2, .amount = {amount, NONE}};
    materials[2] = (Material){.kind = MATERIAL_MIX, .mix_a = 3, .mix_b = 4, .amount = {0.5f, NONE}};
}

/* Amounts that a texture makes less than 0 or more than 1 count as these: the inner mix is always chosen, and its
 * materials equally often. */
START_TEST(test_amounts)
{
    static const float AMOUNTS[] = {-3.0f, 0.0f, 1.0f, 2.0f, 1e30f};
    for (size_t a = 0; a < sizeof AMOUNTS / sizeof AMOUNTS[0]; ++a) {
        Material materials[5];
        const SceneView scene = {.materials = materials};
        const TexturePoint point = {.p = vec3_splat(0.0f)};
        int chosen[5] = {0};
        materials_set(materials, AMOUNTS[a]);
        for (int i = 0; i < DRAWS; ++i)
            ++chosen[material_choose(&scene, 0, &point, ((float)i + 0.5f) / DRAWS)];
        ck_assert_int_eq(chosen[3], DRAWS / 2);
        ck_assert_int_eq(chosen[4], DRAWS / 2);
    }
}
END_TEST

TCase *bsdf_mix_tests(void)
{
    TCase *tcase = tcase_create("mix");
    tcase_add_test(tcase, test_amounts);
    return tcase;
}
