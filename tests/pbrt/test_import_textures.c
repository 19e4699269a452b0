/* Texture expressions: their programs, folding, mappings, images. */
#include "pbrt/test_import.h"
#include "support/test_files.h"

#include <string.h>

/* Operation codes of the last material's colour program, as digits; "" if it is constant. */
static const char *program_codes(const char *textures, Scene *scene, const TextureOp **ops)
{
    static char codes[300];
    char text[4096];
    size_t n = 0;
    snprintf(text, sizeof text, "%s Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"", textures);
    import_world(text, scene);
    const Material *m = &ELEMENT(scene, materials, Material, 0);
    *ops = NULL;
    if (m->color0.program != NONE)
        for (*ops = &ELEMENT(scene, texture_ops, TextureOp, m->color0.program); (*ops)[n].code != TEXTURE_END; ++n)
            codes[n] = (char)('0' + (*ops)[n].code);
    codes[n] = '\0';
    return codes;
}

START_TEST(constants_fold)
{
    static const struct {
        const char *textures;
        float rgb[3];
    } cases[] = {
        {"Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [ 0.1 0.2 0.3 ]", {0.1f, 0.2f, 0.3f}},
        {"Texture \"t\" \"spectrum\" \"constant\"", {1, 1, 1}},
        {"Texture \"t\" \"spectrum\" \"scale\" \"rgb tex\" [ 0.5 1 0 ] \"float scale\" 0.5", {0.25f, 0.5f, 0}},
        {"Texture \"t\" \"spectrum\" \"mix\" \"float amount\" 0.25 \"rgb tex1\" [ 1 0 0 ] \"rgb tex2\" [ 0 1 0 ]",
         {0.75f, 0.25f, 0}},
        {"Texture \"t\" \"spectrum\" \"mix\"", {0.5f, 0.5f, 0.5f}},
        {"Texture \"s\" \"float\" \"constant\" \"float value\" 0.5\n"
         "Texture \"t\" \"spectrum\" \"scale\" \"rgb tex\" [ 1 1 1 ] \"texture scale\" \"s\"",
         {0.5f, 0.5f, 0.5f}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        Scene scene;
        const TextureOp *ops;
        ck_assert_str_eq(program_codes(cases[i].textures, &scene, &ops), "");
        assert_vec3(ELEMENT(&scene, materials, Material, 0).color0.value, cases[i].rgb[0], cases[i].rgb[1],
                    cases[i].rgb[2], 1e-6f);
        ck_assert_uint_eq(scene.texture_ops.count, 0);
        scene_destroy(&scene);
    }
}
END_TEST

START_TEST(postfix_programs)
{
    Scene scene;
    const TextureOp *ops;
    static const char CHECKER[] = "Texture \"c\" \"float\" \"checkerboard\" \"float uscale\" 8 \"float vdelta\" 0.5\n";
    char text[1024];
    snprintf(
        text, sizeof text,
        "%sTexture \"t\" \"spectrum\" \"mix\" \"texture amount\" \"c\" \"rgb tex1\" [ 1 0 0 ] \"rgb tex2\" [ 0 0 1 ]",
        CHECKER);
    /* amount (1 0 checker), tex1, tex2, mix */
    ck_assert_str_eq(program_codes(text, &scene, &ops), "115114");
    ASSERT_FLOAT(ops[0].value.x, 1.0f);
    ASSERT_FLOAT(ops[1].value.x, 0.0f);
    ck_assert_uint_eq(ops[2].mapping, MAPPING_UV);
    ASSERT_FLOAT(ops[2].uv_map[0], 8.0f);
    ASSERT_FLOAT(ops[2].uv_map[1], 1.0f);
    ASSERT_FLOAT(ops[2].uv_map[3], 0.5f);
    ASSERT_FLOAT(ops[3].value.x, 1.0f);
    ASSERT_FLOAT(ops[4].value.z, 1.0f);
    scene_destroy(&scene);
    snprintf(text, sizeof text, "%sTexture \"t\" \"spectrum\" \"scale\" \"rgb tex\" [ 1 0 0 ] \"texture scale\" \"c\"",
             CHECKER);
    ck_assert_str_eq(program_codes(text, &scene, &ops), "11153");
    scene_destroy(&scene);
}
END_TEST

START_TEST(a_texture_used_twice_has_one_program)
{
    Scene scene;
    import_world("Texture \"t\" \"spectrum\" \"checkerboard\" Material \"diffuse\" \"texture reflectance\" \"t\"\n"
                 "Material \"coateddiffuse\" \"texture reflectance\" \"t\"",
                 &scene);
    ck_assert_uint_eq(ELEMENT(&scene, materials, Material, 0).color0.program, 0);
    ck_assert_uint_eq(ELEMENT(&scene, materials, Material, 1).color0.program, 0);
    ck_assert_uint_eq(scene.texture_ops.count, 4);
    scene_destroy(&scene);
}
END_TEST

START_TEST(mappings)
{
    Scene scene;
    const TextureOp *ops;
    program_codes(
        "Translate 1 2 3 Scale 2 2 2 Texture \"t\" \"spectrum\" \"checkerboard\" \"string mapping\" \"planar\"\n"
        "\"vector3 v1\" [ 0 0 1 ] \"float udelta\" 0.5",
        &scene, &ops);
    ck_assert_uint_eq(ops[2].mapping, MAPPING_PLANAR);
    static const float PLANAR[8] = {0, 0, 1, 0.5f, 0, 1, 0, 0};
    ck_assert_mem_eq(ops[2].uv_map, PLANAR, sizeof PLANAR);
    assert_vec3(affine_point(ops[2].texture_from_world, vec3(3, 4, 5)), 1, 1, 1, 1e-6f);
    scene_destroy(&scene);
    program_codes("Texture \"t\" \"spectrum\" \"checkerboard\" \"string mapping\" \"spherical\"", &scene, &ops);
    ck_assert_uint_eq(ops[2].mapping, MAPPING_SPHERICAL);
    scene_destroy(&scene);
    program_codes("Texture \"t\" \"spectrum\" \"checkerboard\" \"string mapping\" \"cylindrical\"", &scene, &ops);
    ck_assert_uint_eq(ops[2].mapping, MAPPING_CYLINDRICAL);
    scene_destroy(&scene);
    program_codes("Translate 1 0 0 Texture \"t\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3", &scene, &ops);
    ck_assert_uint_eq(ops[2].mapping, MAPPING_3D);
    assert_vec3(affine_point(ops[2].texture_from_world, vec3(1, 0, 0)), 0, 0, 0, 0.0f);
    scene_destroy(&scene);
}
END_TEST

START_TEST(float_textures_of_materials)
{
    Scene scene;
    import_world("Texture \"r\" \"float\" \"checkerboard\" \"float tex1\" 0.1 \"float tex2\" 0.4\n"
                 "Material \"conductor\" \"texture roughness\" \"r\" \"texture displacement\" \"r\"",
                 &scene);
    const Material *m = &ELEMENT(&scene, materials, Material, 0);
    ck_assert_uint_eq(m->roughness_u.program, 0);
    ck_assert_uint_eq(m->roughness_v.program, 0);
    ck_assert_uint_eq(m->displacement.program, 0);
    scene_destroy(&scene);
    import_world("Material \"conductor\" \"float displacement\" 0.1", &scene);
    ck_assert_uint_eq(ELEMENT(&scene, materials, Material, 0).displacement.program, NONE);
    scene_destroy(&scene);
}
END_TEST

/* a.pfm: a 2 x 1 image. */
static void image_write(void)
{
    static const char HEAD[] = "PF\n2 1\n-1.0\n";
    static const float PIXELS[6] = {0.25f, 0.5f, 0.75f, 1, 1, 1};
    char file[sizeof HEAD - 1 + sizeof PIXELS];
    memcpy(file, HEAD, sizeof HEAD - 1);
    memcpy(file + sizeof HEAD - 1, PIXELS, sizeof PIXELS);
    test_file_write(test_path("a.pfm"), file, sizeof file);
}

START_TEST(images)
{
    Scene scene;
    image_write();
    import_text_in(
        "WorldBegin Texture \"i\" \"spectrum\" \"imagemap\" \"string filename\" \"a.pfm\" \"float scale\" 2\n"
        "\"bool invert\" true \"string wrap\" \"clamp\" \"string filter\" \"point\"\n"
        "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"i\" \"float scale\" 0.25\n"
        "Material \"diffuse\" \"texture reflectance\" \"t\" \"string normalmap\" \"a.pfm\"\n"
        "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]",
        test_folder, false, &scene);
    const Material *m = &ELEMENT(&scene, materials, Material, 0);
    const TextureOp *op = &ELEMENT(&scene, texture_ops, TextureOp, m->color0.program);
    ck_assert_uint_eq(op[0].code, TEXTURE_IMAGE);
    /* The factor is folded into the image's own scale, before the inversion, as in pbrt. */
    ASSERT_FLOAT(op[0].scale, 0.5f);
    ck_assert_uint_eq(op[0].invert, 1);
    ck_assert_uint_eq(op[1].code, TEXTURE_END);
    const TextureImage *image = &ELEMENT(&scene, images, TextureImage, op[0].index);
    ck_assert_uint_eq(image->width, 2);
    ck_assert_uint_eq(image->wrap, WRAP_CLAMP);
    ck_assert_uint_eq(image->filter, FILTER_POINT);
    ck_assert_uint_ne(m->normal_map, NONE);
    ck_assert_uint_eq(ELEMENT(&scene, images, TextureImage, m->normal_map).wrap, WRAP_REPEAT);
    scene_destroy(&scene);
}
END_TEST

/* A colour image as a float texture counts as its mean, wherever it is used. */
START_TEST(float_image_in_a_colour_texture)
{
    Scene scene;
    image_write();
    import_text_in("WorldBegin Texture \"c\" \"spectrum\" \"imagemap\" \"string filename\" \"a.pfm\"\n"
                   "Texture \"f\" \"float\" \"imagemap\" \"string filename\" \"a.pfm\"\n"
                   "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"c\" \"texture scale\" \"f\"\n"
                   "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
                   "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]",
                   test_folder, false, &scene);
    const TextureOp *op =
        &ELEMENT(&scene, texture_ops, TextureOp, ELEMENT(&scene, materials, Material, 0).color0.program);
    ck_assert_uint_eq(op[0].code + op[1].code, TEXTURE_IMAGE + TEXTURE_IMAGE_FLOAT);
    ck_assert_uint_ne(op[0].code, op[1].code);
    ck_assert_uint_eq(op[2].code, TEXTURE_SCALE);
    scene_destroy(&scene);
}
END_TEST

START_TEST(procedural_textures)
{
    Scene scene;
    const TextureOp *ops;
    const char *codes =
        program_codes("Scale 2 2 2 Texture \"n\" \"float\" \"wrinkled\" \"integer octaves\" 3 \"float roughness\" "
                      "0.25\nTexture \"m\" \"spectrum\" \"marble\" \"float scale\" 4 \"float variation\" 1\n"
                      "Texture \"t\" \"spectrum\" \"mix\" \"texture amount\" \"n\" \"texture tex2\" \"m\"",
                      &scene, &ops);
    const char wanted[] = {'0' + TEXTURE_WRINKLED, '0' + TEXTURE_CONSTANT, '0' + TEXTURE_MARBLE, '0' + TEXTURE_MIX, 0};
    ck_assert_str_eq(codes, wanted);
    ck_assert_uint_eq(ops[0].index, 3);
    ASSERT_FLOAT(ops[0].uv_map[0], 0.25f);
    ASSERT_FLOAT(ops[0].texture_from_world.m[0], 0.5f);
    ck_assert_uint_eq(ops[0].mapping, MAPPING_3D);
    ck_assert_uint_eq(ops[2].index, 8);
    ASSERT_FLOAT(ops[2].scale, 4.0f);
    ASSERT_FLOAT(ops[2].uv_map[1], 1.0f);
    scene_destroy(&scene);
    codes = program_codes(
        "Rotate 90 0 0 1 Texture \"t\" \"spectrum\" \"directionmix\" \"rgb tex1\" [ 1 0 0 ] \"vector3 dir\" "
        "[ 0 5 0 ]",
        &scene, &ops);
    ck_assert_uint_eq(ops[2].code, TEXTURE_DIRECTION_MIX);
    assert_vec3(ops[2].value, -1, 0, 0, 1e-6f);
    assert_vec3(ops[0].value, 1, 0, 0, 0.0f);
    assert_vec3(ops[1].value, 1, 1, 1, 0.0f);
    scene_destroy(&scene);
    program_codes("Texture \"t\" \"spectrum\" \"bilerp\" \"rgb v10\" [ 0 0 1 ] \"float uscale\" 3", &scene, &ops);
    assert_vec3(ops[0].value, 0, 0, 0, 0.0f);
    assert_vec3(ops[1].value, 0, 0, 1, 0.0f);
    assert_vec3(ops[2].value, 1, 1, 1, 0.0f);
    ASSERT_FLOAT(ops[4].uv_map[0], 3.0f);
    scene_destroy(&scene);
    program_codes("Texture \"t\" \"spectrum\" \"dots\" \"rgb outside\" [ 0 0 1 ]", &scene, &ops);
    ck_assert_uint_eq(ops[2].code, TEXTURE_DOTS);
    assert_vec3(ops[0].value, 1, 1, 1, 0.0f);
    assert_vec3(ops[1].value, 0, 0, 1, 0.0f);
    scene_destroy(&scene);
}
END_TEST

START_TEST(unsupported_textures)
{
    Scene scene;
    import_text_in("WorldBegin Texture \"t\" \"spectrum\" \"ptex\" \"string filename\" \"a\"\n"
                   "Material \"diffuse\" \"texture reflectance\" \"t\"",
                   "", true, &scene);
    assert_vec3(ELEMENT(&scene, materials, Material, 0).color0.value, 0.5f, 0.5f, 0.5f, 0.0f);
    ck_assert_ptr_nonnull(strstr(import_log(), "the texture \"ptex\" is not supported; instead: the constant 0.5"));
    scene_destroy(&scene);
}
END_TEST

TCase *import_textures_case(void)
{
    TCase *tcase = tcase_create("textures");
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_test(tcase, constants_fold);
    tcase_add_test(tcase, postfix_programs);
    tcase_add_test(tcase, a_texture_used_twice_has_one_program);
    tcase_add_test(tcase, mappings);
    tcase_add_test(tcase, float_textures_of_materials);
    tcase_add_test(tcase, images);
    tcase_add_test(tcase, float_image_in_a_colour_texture);
    tcase_add_test(tcase, procedural_textures);
    tcase_add_test(tcase, unsupported_textures);
    return tcase;
}
