/* Materials without textures. */
#include "gltf/test_gltf.h"

#include "bsdf/coat.h"

#include <string.h>

/* The square with this material. */
#define MATERIAL(members)                                                                                              \
    GLTF_SQUARE ",\"materials\":[{" members "}],\"nodes\":[{\"mesh\":0}," GLTF_LIGHT_NODE "]," GLTF_LIGHT

START_TEST(metal_is_a_conductor)
{
    Scene scene;
    gltf_scene(MATERIAL("\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.5,0.1,1],\"roughnessFactor\":0.4}"),
               &scene);
    const Material *m = gltf_material(&scene, 0);
    ck_assert_uint_eq(m->kind, MATERIAL_CONDUCTOR);
    ck_assert_uint_eq(m->flags, MATERIAL_CONDUCTOR_REFLECTANCE);
    assert_vec3(m->color0.value, 0.9, 0.5, 0.1, 1e-7);
    TEST_NEAR(m->roughness_u.value, 0.16, 1e-7); /* alpha, without pbrt's remapping */
    TEST_NEAR(m->roughness_v.value, 0.16, 1e-7);
    scene_destroy(&scene);
}
END_TEST

/* Hemispherical reflectance from outside for eta 1.5: 0.0918 (Egan, Hilgeman and Reichman 1973). */
#define INTERNAL (1.0 - (1.0 - 0.0918) / 2.25)

START_TEST(dielectric_is_coated_diffuse)
{
    Scene scene;
    gltf_scene(MATERIAL("\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.5,0,1],\"metallicFactor\":0,"
                        "\"roughnessFactor\":0}"),
               &scene);
    const Material *m = gltf_material(&scene, 0);
    ck_assert_uint_eq(m->kind, MATERIAL_COATED_DIFFUSE);
    TEST_NEAR(m->eta, 1.5, 0);
    TEST_NEAR(m->color1.value.x, 0, 0); /* a coat that absorbs nothing */
    TEST_NEAR(m->roughness_u.value, 0, 0);
    /* (1 - internal) base / (1 - internal base) is glTF's colour. */
    TEST_NEAR(m->color0.value.x, 1, 1e-6);
    TEST_NEAR((1.0 - INTERNAL) * (double)m->color0.value.y / (1.0 - INTERNAL * (double)m->color0.value.y), 0.5, 1e-4);
    TEST_NEAR(m->color0.value.z, 0, 0);
    scene_destroy(&scene);
}
END_TEST

START_TEST(rough_coats_keep_the_albedo)
{
    Error error = {{0}, {0}};
    Scene scene;
    gltf_scene(MATERIAL("\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,0.5,1],\"metallicFactor\":0}"), &scene);
    const Material *m = gltf_material(&scene, 0);
    TEST_NEAR(m->roughness_u.value, 1, 0);
    double base = (double)m->color0.value.x;
    ck_assert_msg(scene_finish(&scene, &error), "%s", error.message);
    /* Escape of the renderer's own table for this coat (bsdf/coat.h). */
    const float *row = &ELEMENT(&scene, lookup, float, ELEMENT(&scene, materials, Material, 0).coat_table + 1);
    double escape = (double)row[COAT_CELLS];
    TEST_NEAR(escape * base / (1.0 - (1.0 - escape) * base), 0.5, 1e-6);
    scene_destroy(&scene);
}
END_TEST

START_TEST(metallic_is_a_mix)
{
    Scene scene;
    gltf_scene(MATERIAL("\"pbrMetallicRoughness\":{\"metallicFactor\":0.25},"
                        "\"extensions\":{\"KHR_materials_ior\":{\"ior\":1.7}}"),
               &scene);
    const Material *m = gltf_material(&scene, 0);
    ck_assert_uint_eq(m->kind, MATERIAL_MIX);
    TEST_NEAR(m->amount.value, 0.25, 0);
    const Material *base = &ELEMENT(&scene, materials, Material, m->mix_a);
    ck_assert_uint_eq(base->kind, MATERIAL_COATED_DIFFUSE);
    TEST_NEAR(base->eta, 1.7, 1e-6);
    ck_assert_uint_eq(ELEMENT(&scene, materials, Material, m->mix_b).kind, MATERIAL_CONDUCTOR);
    scene_destroy(&scene);
}
END_TEST

START_TEST(transmission_is_glass)
{
    Scene scene;
    gltf_scene(MATERIAL("\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.1},"
                        "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1}}"),
               &scene);
    ck_assert_uint_eq(gltf_material(&scene, 0)->kind, MATERIAL_THIN_DIELECTRIC);
    gltf_says("what materials[0] transmits is not tinted, and a thin pane is smooth");
    scene_destroy(&scene);
    gltf_scene(
        MATERIAL("\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.5},\"extensions\":{"
                 "\"KHR_materials_transmission\":{\"transmissionFactor\":0.75},\"KHR_materials_ior\":{\"ior\":1.33},"
                 "\"KHR_materials_volume\":{\"thicknessFactor\":1}}"),
        &scene);
    const Material *m = gltf_material(&scene, 0);
    ck_assert_uint_eq(m->kind, MATERIAL_MIX);
    TEST_NEAR(m->amount.value, 0.75, 0);
    ck_assert_uint_eq(ELEMENT(&scene, materials, Material, m->mix_a).kind, MATERIAL_COATED_DIFFUSE);
    const Material *glass = &ELEMENT(&scene, materials, Material, m->mix_b);
    ck_assert_uint_eq(glass->kind, MATERIAL_DIELECTRIC);
    TEST_NEAR(glass->eta, 1.33, 1e-6);
    TEST_NEAR(glass->roughness_u.value, 0.25, 0);
    scene_destroy(&scene);
}
END_TEST

/* A clear coat lies over metal, takes the place of the base's own coat, and is a mix with what is not under it. */
START_TEST(clear_coats)
{
    Scene scene;
    gltf_scene(MATERIAL("\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.5,0.1,1],\"roughnessFactor\":0.5},"
                        "\"extensions\":{\"KHR_materials_clearcoat\":{\"clearcoatFactor\":1,"
                        "\"clearcoatRoughnessFactor\":0.3}}"),
               &scene);
    const Material *m = gltf_material(&scene, 0);
    ck_assert_uint_eq(m->kind, MATERIAL_COATED_CONDUCTOR);
    TEST_NEAR(m->eta, 1.5, 0);
    TEST_NEAR(m->roughness_u.value, 0.09, 1e-7);
    TEST_NEAR(m->base_u.value, 0.25, 1e-7);
    TEST_NEAR(m->scale, 0, 0);
    scene_destroy(&scene);
    gltf_scene(MATERIAL("\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,0.5,1],\"metallicFactor\":0},"
                        "\"extensions\":{\"KHR_materials_ior\":{\"ior\":1.8},\"KHR_materials_clearcoat\":{"
                        "\"clearcoatFactor\":0.25}}"),
               &scene);
    m = gltf_material(&scene, 0);
    ck_assert_uint_eq(m->kind, MATERIAL_MIX);
    TEST_NEAR(m->amount.value, 0.25, 0);
    const Material *bare = &ELEMENT(&scene, materials, Material, m->mix_a),
                   *coated = &ELEMENT(&scene, materials, Material, m->mix_b);
    ck_assert_uint_eq(bare->kind, MATERIAL_COATED_DIFFUSE);
    ck_assert_uint_eq(coated->kind, MATERIAL_COATED_DIFFUSE);
    TEST_NEAR(bare->eta, 1.8, 1e-6);
    TEST_NEAR(bare->roughness_u.value, 1, 0);
    TEST_NEAR(coated->eta, 1.5, 0);
    TEST_NEAR(coated->roughness_u.value, 0, 0);
    double base = (double)coated->color0.value.x;
    TEST_NEAR((1.0 - INTERNAL) * base / (1.0 - INTERNAL * base), 0.5, 1e-4);
    scene_destroy(&scene);
}
END_TEST

START_TEST(clear_coats_leave_out)
{
    Scene scene;
    gltf_scene(MATERIAL("\"pbrMetallicRoughness\":{\"metallicFactor\":0},\"extensions\":{"
                        "\"KHR_materials_transmission\":{\"transmissionFactor\":1},"
                        "\"KHR_materials_clearcoat\":{\"clearcoatFactor\":1}}"),
               &scene);
    ck_assert_uint_eq(gltf_material(&scene, 0)->kind, MATERIAL_THIN_DIELECTRIC);
    gltf_says("the clear coat of materials[0] leaves out what transmits light");
    scene_destroy(&scene);
    gltf_scene(MATERIAL("\"extensions\":{\"KHR_materials_unlit\":{},"
                        "\"KHR_materials_clearcoat\":{\"clearcoatFactor\":1}}"),
               &scene);
    ck_assert_uint_eq(gltf_material(&scene, 0)->kind, MATERIAL_DIFFUSE);
    scene_destroy(&scene);
}
END_TEST

START_TEST(surfaces_without_gloss_are_diffuse)
{
    static const char *const EXTENSIONS[] = {"\"KHR_materials_unlit\":{}",
                                             "\"KHR_materials_specular\":{\"specularFactor\":0}",
                                             "\"KHR_materials_ior\":{\"ior\":1}"};
    for (int i = 0; i < 3; ++i) {
        char members[1024];
        Scene scene;
        snprintf(members, sizeof members,
                 GLTF_SQUARE ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,1,1],"
                             "\"metallicFactor\":0},\"extensions\":{%s}}],"
                             "\"nodes\":[{\"mesh\":0}," GLTF_LIGHT_NODE "]," GLTF_LIGHT,
                 EXTENSIONS[i]);
        gltf_scene(members, &scene);
        ck_assert_uint_eq(gltf_material(&scene, 0)->kind, MATERIAL_DIFFUSE);
        assert_vec3(gltf_material(&scene, 0)->color0.value, 0.5, 0.25, 1, 0);
        ck_assert_int_eq(strstr(gltf_log(), "materials[0] is unlit") != NULL, i == 0);
        scene_destroy(&scene);
    }
}
END_TEST

START_TEST(partial_gloss_is_said)
{
    static const struct {
        const char *members;
        bool partial;
    } CASES[] = {{"", false},
                 {"\"specularFactor\":1", false},
                 {"\"specularFactor\":0", false},
                 {"\"specularFactor\":0.5", true},
                 {"\"specularColorFactor\":[1,0,0]", true}};
    for (int i = 0; i < 5; ++i) {
        char members[1024];
        Scene scene;
        snprintf(members, sizeof members,
                 GLTF_SQUARE ",\"materials\":[{\"extensions\":{\"KHR_materials_specular\":{%s}}}],"
                             "\"nodes\":[{\"mesh\":0}," GLTF_LIGHT_NODE "]," GLTF_LIGHT,
                 CASES[i].members);
        gltf_scene(members, &scene);
        ck_assert_int_eq(strstr(gltf_log(), "KHR_materials_specular is ignored") != NULL, CASES[i].partial);
        scene_destroy(&scene);
    }
}
END_TEST

START_TEST(emission_has_its_strength)
{
    Scene scene;
    gltf_scene(MATERIAL("\"emissiveFactor\":[1,0.5,0.25],"
                        "\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":20}}"),
               &scene);
    ck_assert_uint_eq(scene.lights.count, 3); /* two triangles and the other light */
    const Light *light = &ELEMENT(&scene, lights, Light, 2);
    ck_assert_uint_eq(light_kind(light), LIGHT_AREA);
    assert_vec3(light->emission, 20, 10, 5, 1e-6);
    ck_assert_uint_eq(light->flags & LIGHT_TWO_SIDED, 0);
    scene_destroy(&scene);
    gltf_scene(MATERIAL("\"emissiveFactor\":[1,1,1],\"doubleSided\":true"), &scene);
    ck_assert_uint_eq(ELEMENT(&scene, lights, Light, 2).flags & LIGHT_TWO_SIDED, LIGHT_TWO_SIDED);
    assert_vec3(ELEMENT(&scene, lights, Light, 2).emission, 1, 1, 1, 0);
    scene_destroy(&scene);
}
END_TEST

START_TEST(emission_of_shared_meshes_is_repeated)
{
    Scene scene;
    gltf_scene(GLTF_SQUARE ",\"materials\":[{\"emissiveFactor\":[1,1,1]}],"
                           "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[0,0,2]}]",
               &scene);
    ck_assert_uint_eq(scene.lights.count, 4);
    ck_assert_uint_eq(scene.instances.count, 0);
    scene_destroy(&scene);
}
END_TEST

/* The program of the alpha of shape 0: its first operation. */
static const TextureOp *alpha_op(const Scene *scene)
{
    uint program = ELEMENT(scene, shapes, Shape, 0).alpha;
    return program == NONE ? NULL : &ELEMENT(scene, texture_ops, TextureOp, program);
}

START_TEST(alpha_is_transparency)
{
    Scene scene;
    gltf_scene(MATERIAL("\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.25]}"), &scene);
    ck_assert_ptr_nonnull(alpha_op(&scene));
    TEST_NEAR(alpha_op(&scene)->value.x, 0.25, 0);
    scene_destroy(&scene);
    gltf_scene(MATERIAL("\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.25]}"), &scene);
    ck_assert_ptr_null(alpha_op(&scene)); /* OPAQUE */
    scene_destroy(&scene);
    gltf_scene(MATERIAL("\"alphaMode\":\"MASK\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.5]}"), &scene);
    ck_assert_uint_eq(scene.primitives.count, 2); /* at the default cutoff */
    ck_assert_ptr_null(alpha_op(&scene));
    scene_destroy(&scene);
    gltf_scene(MATERIAL("\"alphaMode\":\"MASK\",\"alphaCutoff\":0.6,"
                        "\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.5]}"),
               &scene);
    ck_assert_uint_eq(scene.primitives.count, 0);
    scene_destroy(&scene);
}
END_TEST

TCase *gltf_materials_case(void)
{
    TCase *tests = gltf_case("materials");
    tcase_add_test(tests, metal_is_a_conductor);
    tcase_add_test(tests, dielectric_is_coated_diffuse);
    tcase_add_test(tests, rough_coats_keep_the_albedo);
    tcase_add_test(tests, metallic_is_a_mix);
    tcase_add_test(tests, transmission_is_glass);
    tcase_add_test(tests, clear_coats);
    tcase_add_test(tests, clear_coats_leave_out);
    tcase_add_test(tests, surfaces_without_gloss_are_diffuse);
    tcase_add_test(tests, partial_gloss_is_said);
    tcase_add_test(tests, emission_has_its_strength);
    tcase_add_test(tests, emission_of_shared_meshes_is_repeated);
    tcase_add_test(tests, alpha_is_transparency);
    return tests;
}
