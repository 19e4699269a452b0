/* Textures of materials. */
#include "gltf/test_gltf.h"
#include "geometry/texture.h"

#include "image/color.h"
#include "scene/pack.h"

#include <string.h>

#define NODES "\"nodes\":[{\"mesh\":0}," GLTF_LIGHT_NODE "]," GLTF_LIGHT
#define MATERIAL(members) GLTF_SQUARE ",\"materials\":[{" members "}]," GLTF_TEXTURE "," NODES

/* The file's pixels, row by row. */
static const unsigned char PIXELS[4][4] = {{255, 0, 0, 255}, {0, 255, 0, 128}, {0, 0, 255, 64}, {128, 64, 32, 0}};

/* Texture coordinates of the centre of pixel i, as pbrt has them. */
static Vec2 pixel_uv(int i)
{
    return vec2(i % 2 == 0 ? 0.25f : 0.75f, i / 2 == 0 ? 0.75f : 0.25f);
}

static void scene_end(Scene *scene)
{
    Error error = {{0}, {0}};
    ck_assert_msg(scene_finish(scene, &error), "%s", error.message);
}

/* Value of a texture program of a finished scene. */
static Vec3 program_value(const Scene *scene, uint program, Vec2 uv)
{
    const SceneView view =
        scene_view(&scene->frame, scene->geometry_words.data, scene->tables_words.data, scene->texels.data);
    const TexturePoint point = {.p = vec3(0.0f, 0.0f, 0.0f), .uv = uv};
    return color_param_eval(&view, (ColorParam){.program = program}, &point);
}

static double number_value(const Scene *scene, uint program, Vec2 uv)
{
    const SceneView view =
        scene_view(&scene->frame, scene->geometry_words.data, scene->tables_words.data, scene->texels.data);
    const TexturePoint point = {.p = vec3(0.0f, 0.0f, 0.0f), .uv = uv};
    return (double)float_param_eval(&view, (FloatParam){.program = program}, &point);
}

START_TEST(base_colors_are_srgb)
{
    Scene scene;
    gltf_scene(
        MATERIAL("\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},\"baseColorFactor\":[0.5,1,0.25,1]}"),
        &scene);
    uint program = gltf_material(&scene, 0)->color0.program;
    scene_end(&scene);
    for (int i = 0; i < 4; ++i) {
        Vec3 found = program_value(&scene, program, pixel_uv(i));
        const double factor[3] = {0.5, 1.0, 0.25}, values[3] = {(double)found.x, (double)found.y, (double)found.z};
        for (int c = 0; c < 3; ++c) /* up to the rounding to bytes of sRGB */
            TEST_NEAR(color_srgb_encode(values[c]),
                      color_srgb_encode(factor[c] * color_srgb_decode(PIXELS[i][c] / 255.0)), 0.5001 / 255.0);
    }
    scene_destroy(&scene);
}
END_TEST

START_TEST(bases_under_coats_are_brighter)
{
    Scene scene;
    gltf_scene(
        MATERIAL(
            "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},\"metallicFactor\":0,\"roughnessFactor\":0}"),
        &scene);
    uint program = gltf_material(&scene, 0)->color0.program;
    scene_end(&scene);
    const double internal = 1.0 - (1.0 - 0.0918) / 2.25, albedo = color_srgb_decode(128 / 255.0);
    double found = (double)program_value(&scene, program, pixel_uv(3)).x;
    TEST_NEAR(color_srgb_encode(found), color_srgb_encode(albedo / (1.0 - internal + internal * albedo)), 0.51 / 255.0);
    scene_destroy(&scene);
}
END_TEST

START_TEST(roughness_is_green_and_metallic_blue)
{
    Scene scene;
    gltf_scene(MATERIAL("\"pbrMetallicRoughness\":{\"metallicRoughnessTexture\":{\"index\":0},\"metallicFactor\":0.5,"
                        "\"roughnessFactor\":0.8}"),
               &scene);
    const Material mix = *gltf_material(&scene, 0);
    ck_assert_uint_eq(mix.kind, MATERIAL_MIX);
    const Material metal = ELEMENT(&scene, materials, Material, mix.mix_b);
    scene_end(&scene);
    for (int i = 0; i < 4; ++i) {
        double roughness = 0.8 * PIXELS[i][1] / 255.0;
        TEST_NEAR(number_value(&scene, metal.roughness_u.program, pixel_uv(i)), roughness * roughness, 1e-6);
        TEST_NEAR(number_value(&scene, mix.amount.program, pixel_uv(i)), 0.5 * PIXELS[i][2] / 255.0, 1e-6);
    }
    scene_destroy(&scene);
}
END_TEST

START_TEST(alpha_is_that_of_the_base_color)
{
    Scene scene;
    gltf_scene(MATERIAL("\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},"
                        "\"baseColorFactor\":[1,1,1,0.5]}"),
               &scene);
    uint program = ELEMENT(&scene, shapes, Shape, 0).alpha;
    scene_end(&scene);
    for (int i = 0; i < 4; ++i)
        TEST_NEAR(number_value(&scene, program, pixel_uv(i)), 0.5 * PIXELS[i][3] / 255.0, 0.5001 / 255.0);
    scene_destroy(&scene);
    gltf_scene(MATERIAL("\"alphaMode\":\"MASK\",\"alphaCutoff\":0.25098,"
                        "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}"),
               &scene);
    program = ELEMENT(&scene, shapes, Shape, 0).alpha;
    scene_end(&scene);
    for (int i = 0; i < 4; ++i)
        TEST_NEAR(number_value(&scene, program, pixel_uv(i)), PIXELS[i][3] >= 64 ? 1.0 : 0.0, 0.0);
    scene_destroy(&scene);
}
END_TEST

START_TEST(transmission_is_red)
{
    Scene scene;
    gltf_scene(
        MATERIAL("\"pbrMetallicRoughness\":{\"metallicFactor\":0},\"extensions\":{\"KHR_materials_transmission\":{"
                 "\"transmissionFactor\":0.5,\"transmissionTexture\":{\"index\":0}}}"),
        &scene);
    uint program = gltf_material(&scene, 0)->amount.program;
    scene_end(&scene);
    for (int i = 0; i < 4; ++i)
        TEST_NEAR(number_value(&scene, program, pixel_uv(i)), 0.5 * PIXELS[i][0] / 255.0, 1e-6);
    scene_destroy(&scene);
}
END_TEST

/* The coat's factor is red, its roughness green, whose square is the alpha. */
START_TEST(clear_coats_are_red_and_green)
{
    Scene scene;
    gltf_scene(MATERIAL("\"normalTexture\":{\"index\":0},\"extensions\":{\"KHR_materials_clearcoat\":{"
                        "\"clearcoatFactor\":0.5,\"clearcoatTexture\":{\"index\":0},"
                        "\"clearcoatRoughnessFactor\":0.8,\"clearcoatRoughnessTexture\":{\"index\":0}}}"),
               &scene);
    gltf_says("the clear coat of materials[0] has the normals of what is below");
    const Material *m = gltf_material(&scene, 0);
    uint amount = m->amount.program, alpha = ELEMENT(&scene, materials, Material, m->mix_b).roughness_u.program;
    scene_end(&scene);
    for (int i = 0; i < 4; ++i) {
        double green = 0.8 * PIXELS[i][1] / 255.0;
        TEST_NEAR(number_value(&scene, amount, pixel_uv(i)), 0.5 * PIXELS[i][0] / 255.0, 1e-6);
        TEST_NEAR(number_value(&scene, alpha, pixel_uv(i)), green * green, 1e-6);
    }
    scene_destroy(&scene);
}
END_TEST

/* The normal that the map of material 0 has at pixel i. */
static Vec3 map_normal(const Scene *scene, int i)
{
    const SceneView view =
        scene_view(&scene->frame, scene->geometry_words.data, scene->tables_words.data, scene->texels.data);
    Vec3 rgb = image_lookup(&view, 0, pixel_uv(i));
    return vec3(2.0f * rgb.x - 1.0f, 2.0f * rgb.y - 1.0f, 2.0f * rgb.z - 1.0f);
}

START_TEST(normal_maps_have_their_scale)
{
    for (int pass = 0; pass < 2; ++pass) {
        Scene scene;
        if (pass == 0)
            gltf_scene(MATERIAL("\"normalTexture\":{\"index\":0}"), &scene);
        else
            gltf_scene(MATERIAL("\"normalTexture\":{\"index\":0,\"scale\":0.5}"), &scene);
        ck_assert_uint_eq(gltf_material(&scene, 0)->normal_map, 0);
        scene_end(&scene);
        for (int i = 0; i < 4; ++i) {
            Vec3 n = map_normal(&scene, i);
            double scale = pass == 0 ? 1.0 : 0.5, length = 0.0, expected[3];
            for (int c = 0; c < 3; ++c) {
                expected[c] = (2.0 * PIXELS[i][c] / 255.0 - 1.0) * (c < 2 ? scale : 1.0);
                length += expected[c] * expected[c];
            }
            length = pass == 0 ? 1.0 : sqrt(length);
            TEST_NEAR(n.x, expected[0] / length, 1.01 / 255.0);
            TEST_NEAR(n.y, expected[1] / length, 1.01 / 255.0);
            TEST_NEAR(n.z, expected[2] / length, 1.01 / 255.0);
        }
        scene_destroy(&scene);
    }
}
END_TEST

/* The operation that looks up the base colour. */
static const TextureOp *base_op(const Scene *scene)
{
    return &ELEMENT(scene, texture_ops, TextureOp, gltf_material(scene, 0)->color0.program);
}

#define TRANSFORMED(members) "\"index\":0,\"extensions\":{\"KHR_texture_transform\":{" members "}}"

START_TEST(transforms_scale_and_move)
{
    Scene scene;
    gltf_scene(MATERIAL("\"pbrMetallicRoughness\":{\"baseColorTexture\":{" TRANSFORMED(
                   "\"offset\":[0.25,0.5],\"scale\":[2,3]") "}}"),
               &scene);
    const float *map = base_op(&scene)->uv_map;
    /* glTF: u' = 2 u + 0.25, v' = 3 v + 0.5; with v counted from below: 1 - v' = 3 (1 - v) - 2.5. */
    TEST_NEAR(map[0], 2, 0);
    TEST_NEAR(map[1], 3, 0);
    TEST_NEAR(map[2], 0.25, 0);
    TEST_NEAR(map[3], -2.5, 0);
    TEST_NEAR(ELEMENT(&scene, uvs, Vec2, 2).x, 1, 0);
    scene_destroy(&scene);
}
END_TEST

START_TEST(turned_textures_turn_coordinates)
{
    Scene scene;
    /* A quarter turn: u' = v, v' = -u, counted from above. */
    gltf_scene(
        MATERIAL("\"pbrMetallicRoughness\":{\"baseColorTexture\":{" TRANSFORMED("\"rotation\":1.57079632679") "}}"),
        &scene);
    for (unsigned i = 0; i < 4; ++i) {
        Vec3 p = ELEMENT(&scene, positions, Vec3, i);
        Vec2 uv = ELEMENT(&scene, uvs, Vec2, i);
        TEST_NEAR(uv.x, 1 - p.y, 1e-6);
        TEST_NEAR(1 - uv.y, -p.x, 1e-6);
    }
    TEST_NEAR(base_op(&scene)->uv_map[0], 1, 1e-6);
    TEST_NEAR(base_op(&scene)->uv_map[3], 0, 1e-6);
    scene_destroy(&scene);
    gltf_scene(MATERIAL("\"normalTexture\":{\"index\":0},"
                        "\"pbrMetallicRoughness\":{\"baseColorTexture\":{" TRANSFORMED("\"rotation\":1") "}}"),
               &scene);
    gltf_says("materials[0] turns its textures by different angles: only one is kept");
    scene_destroy(&scene);
}
END_TEST

START_TEST(normal_maps_and_colors_move_apart)
{
    Scene scene;
    gltf_scene(
        MATERIAL("\"normalTexture\":{" TRANSFORMED(
            "\"scale\":[4,4]") "},"
                               "\"pbrMetallicRoughness\":{\"baseColorTexture\":{" TRANSFORMED("\"scale\":[2,8]") "}}"),
        &scene);
    TEST_NEAR(ELEMENT(&scene, uvs, Vec2, 1).x, 4, 0);
    TEST_NEAR(ELEMENT(&scene, uvs, Vec2, 3).y, 1, 0); /* the top stays where it is */
    TEST_NEAR(ELEMENT(&scene, uvs, Vec2, 0).y, -3, 0);
    TEST_NEAR(base_op(&scene)->uv_map[0], 0.5, 0);
    TEST_NEAR(base_op(&scene)->uv_map[1], 2, 0);
    scene_destroy(&scene);
}
END_TEST

START_TEST(samplers_wrap_and_filter)
{
    Scene scene;
    gltf_scene(GLTF_SQUARE ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],"
                           "\"images\":[{\"bufferView\":4,\"mimeType\":\"image/png\"}],"
                           "\"textures\":[{\"source\":0,\"sampler\":0}],"
                           "\"samplers\":[{\"wrapS\":33071,\"wrapT\":33071,\"magFilter\":9728}]," NODES,
               &scene);
    ck_assert_uint_eq(ELEMENT(&scene, images, TextureImage, 0).wrap, WRAP_CLAMP);
    ck_assert_uint_eq(ELEMENT(&scene, images, TextureImage, 0).filter, FILTER_POINT);
    scene_destroy(&scene);
}
END_TEST

START_TEST(emission_has_a_texture)
{
    Scene scene;
    /* Only the red of the image counts: the upper left of the square, which the second triangle mostly covers. */
    gltf_scene(MATERIAL("\"emissiveFactor\":[1,0,0],\"emissiveTexture\":{\"index\":0},"
                        "\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":10}}"),
               &scene);
    ck_assert_uint_eq(scene.lights.count, 3);
    const Light *light = &ELEMENT(&scene, lights, Light, 1);
    double sum = 0.0;
    for (int i = 0; i < 2; ++i) {
        sum += 0.5 * (double)light[i].emission.x;
        TEST_NEAR(light[i].emission.y, 0, 0);
    }
    /* The mean over the square, by 36 points of each triangle. */
    TEST_NEAR(sum, 10.0 * 0.25 * (1.0 + color_srgb_decode(128 / 255.0)), 0.15);
    scene_destroy(&scene);
}
END_TEST

START_TEST(dark_triangles_do_not_emit)
{
    Scene scene;
    /* The image shrinks to its lower left pixel, which has no red: neither triangle emits. */
    gltf_scene(MATERIAL("\"emissiveFactor\":[1,0,0],\"emissiveTexture\":{" TRANSFORMED(
                   "\"scale\":[0.1,0.1],\"offset\":[0.2,0.7]") "}"),
               &scene);
    ck_assert_uint_eq(scene.lights.count, 1);
    ck_assert_uint_eq(scene.primitives.count, 2);
    scene_destroy(&scene);
}
END_TEST

TCase *gltf_textures_case(void)
{
    TCase *tests = gltf_case("textures");
    tcase_add_test(tests, base_colors_are_srgb);
    tcase_add_test(tests, bases_under_coats_are_brighter);
    tcase_add_test(tests, roughness_is_green_and_metallic_blue);
    tcase_add_test(tests, alpha_is_that_of_the_base_color);
    tcase_add_test(tests, transmission_is_red);
    tcase_add_test(tests, clear_coats_are_red_and_green);
    tcase_add_test(tests, normal_maps_have_their_scale);
    tcase_add_test(tests, transforms_scale_and_move);
    tcase_add_test(tests, turned_textures_turn_coordinates);
    tcase_add_test(tests, normal_maps_and_colors_move_apart);
    tcase_add_test(tests, samplers_wrap_and_filter);
    tcase_add_test(tests, emission_has_a_texture);
    tcase_add_test(tests, dark_triangles_do_not_emit);
    return tests;
}
