/* Meshes, nodes, cameras, lights. */
#include "gltf/test_gltf.h"

#include "base/matrix.h"
#include "layout/scene_view.h"
#include "support/test_files.h"

#include <string.h>

#define ONE_NODE "\"nodes\":[{\"mesh\":0}," GLTF_LIGHT_NODE "]," GLTF_LIGHT
#define CAMERA(members) "\"nodes\":[{\"camera\":0}," GLTF_LIGHT_NODE "],\"cameras\":[" members "]," GLTF_LIGHT

START_TEST(meshes_are_as_stored)
{
    Scene scene;
    gltf_scene(GLTF_SQUARE
               ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}]," GLTF_TEXTURE
               "," ONE_NODE,
               &scene);
    ck_assert_uint_eq(scene.positions.count, 4);
    ck_assert_uint_eq(scene.primitives.count, 2);
    assert_vec3(ELEMENT(&scene, positions, Vec3, 2), 1, 1, 0, 0);
    assert_vec3(ELEMENT(&scene, normals, Vec3, 1), 0, 0, 1, 0);
    ck_assert_uint_eq(ELEMENT(&scene, primitives, Primitive, 1).c, 3);
    /* v = 1 is the top in pbrt, v = 0 in glTF. */
    TEST_NEAR(ELEMENT(&scene, uvs, Vec2, 0).y, 0, 0);
    TEST_NEAR(ELEMENT(&scene, uvs, Vec2, 3).y, 1, 0);
    TEST_NEAR(ELEMENT(&scene, uvs, Vec2, 1).x, 1, 0);
    scene_destroy(&scene);
}
END_TEST

START_TEST(buffers_may_be_data_uris)
{
    /* Three points, (0, 0, 0), (1, 0, 0) and (0, 1, 0.5), and two bytes more, so that the last group is not full. */
    static const char TEXT[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":38,\"uri\":\"data:application/"
        "octet-stream;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAA/AQI=\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":38}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}]}";
    Error error = {{0}, {0}};
    Scene scene;
    test_file_write(gltf_path("data.gltf"), TEXT, strlen(TEXT));
    scene_init(&scene);
    ck_assert_msg(scene_file_load(gltf_path("data.gltf"), false, &scene, &error), "%s", error.message);
    ck_assert_uint_eq(scene.primitive_count, 1);
    TEST_NEAR(scene.bounds_max[0], 1, 0);
    TEST_NEAR(scene.bounds_max[1], 1, 0);
    TEST_NEAR(scene.bounds_max[2], 0.5, 0);
    scene_destroy(&scene);
}
END_TEST

START_TEST(strips_become_triangles)
{
    Scene scene;
    gltf_scene("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":4},\"mode\":5},"
               "{\"attributes\":{\"POSITION\":4},\"mode\":0}]}]," ONE_NODE,
               &scene);
    ck_assert_uint_eq(scene.primitives.count, 2);
    for (unsigned i = 0; i < 2; ++i) {
        const Primitive p = ELEMENT(&scene, primitives, Primitive, i);
        Vec3 a = ELEMENT(&scene, positions, Vec3, p.a), b = ELEMENT(&scene, positions, Vec3, p.b);
        Vec3 c = ELEMENT(&scene, positions, Vec3, p.c);
        ck_assert(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)).z > 0.0f); /* both counterclockwise */
    }
    gltf_says("meshes[0].primitives[1] has points or lines, which are left out");
    scene_destroy(&scene);
}
END_TEST

START_TEST(sparse_accessors_replace_elements)
{
    Error error = {{0}, {0}};
    Scene scene;
    /* Element 0 (the index of that is 0) becomes the first normal, (0, 0, 1). */
    const char *path =
        gltf_write_with("sparse.glb",
                        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":"
                        "\"VEC3\",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":3,"
                        "\"componentType\":5123},\"values\":{\"bufferView\":1}}}]",
                        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":5}]}]," ONE_NODE);
    scene_init(&scene);
    ck_assert_msg(scene_file_load(path, false, &scene, &error), "%s", error.message);
    ck_assert_uint_eq(scene.primitive_count, 2);
    TEST_NEAR(scene.bounds_max[2], 1, 1e-6);
    scene_destroy(&scene);
}
END_TEST

START_TEST(morph_targets_have_default_weights)
{
    Scene scene;
    /* By half the normals, which as positions are (0, 0, 1); the second target does not count. */
    gltf_scene(
        "\"meshes\":[{\"weights\":[0.5,0],\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":3,"
        "\"targets\":[{\"POSITION\":1,\"NORMAL\":0},{\"POSITION\":0}]}]}]," ONE_NODE,
        &scene);
    assert_vec3(ELEMENT(&scene, positions, Vec3, 0), 0, 0, 0.5, 0);
    assert_vec3(ELEMENT(&scene, positions, Vec3, 2), 1, 1, 0.5, 0);
    assert_vec3(ELEMENT(&scene, normals, Vec3, 0), 0, 0, 1, 0);
    assert_vec3(ELEMENT(&scene, normals, Vec3, 1), sqrt(0.2), 0, sqrt(0.8), 1e-6); /* (0, 0, 1) + (1, 0, 0) / 2 */
    scene_destroy(&scene);
}
END_TEST

START_TEST(nodes_are_placed)
{
    Scene scene;
    /* Scaled by 2, turned by 90 degrees about z, moved by (1, 2, 3); then by (10, 0, 0) as the child of another
     * node. */
    gltf_scene("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":3}]}],"
               "\"scene\":0,\"scenes\":[{\"nodes\":[1,2]}],\"nodes\":[{\"mesh\":0,\"translation\":[1,2,3],"
               "\"rotation\":[0,0,0.70710678,0.70710678],\"scale\":[2,2,2]},"
               "{\"children\":[0],\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,10,0,0,1]}," GLTF_LIGHT_NODE
               ",{\"mesh\":0}]," GLTF_LIGHT,
               &scene);
    ck_assert_uint_eq(scene.primitives.count, 2); /* the last node is not in the scene */
    assert_vec3(vec3_add(scene.origin, ELEMENT(&scene, positions, Vec3, 0)), 11, 2, 3, 1e-6);
    assert_vec3(vec3_add(scene.origin, ELEMENT(&scene, positions, Vec3, 1)), 11, 4, 3, 1e-6);
    assert_vec3(vec3_add(scene.origin, ELEMENT(&scene, positions, Vec3, 3)), 9, 2, 3, 1e-6);
    assert_vec3(ELEMENT(&scene, normals, Vec3, 0), 0, 0, 1, 1e-6);
    scene_destroy(&scene);
}
END_TEST

START_TEST(mirrored_nodes_keep_their_front)
{
    Scene scene;
    /* Mirrored in x: the corners go clockwise then, and the normal stays. */
    gltf_scene("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":3}]}],"
               "\"nodes\":[{\"mesh\":0,\"scale\":[-1,1,1]}," GLTF_LIGHT_NODE "]," GLTF_LIGHT,
               &scene);
    ck_assert_uint_eq(ELEMENT(&scene, shapes, Shape, 0).flags & SHAPE_FLIP_NORMAL, SHAPE_FLIP_NORMAL);
    scene_destroy(&scene);
}
END_TEST

START_TEST(shared_meshes_are_instances)
{
    Scene scene;
    gltf_scene(GLTF_SQUARE ",\"materials\":[{}],\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[0,5,0]},"
                           "{\"mesh\":0,\"scale\":[0,0,0]}," GLTF_LIGHT_NODE "]," GLTF_LIGHT,
               &scene);
    ck_assert_uint_eq(scene.primitives.count, 2);
    ck_assert_uint_eq(scene.instances.count, 2);
    assert_vec3(affine_point(ELEMENT(&scene, instances, Instance, 1).world_from_object, vec3(0.0f, 0.0f, 0.0f)), 0, 5,
                0, 0);
    gltf_says("the mesh of nodes[2] is scaled to nothing and is left out");
    scene_destroy(&scene);
}
END_TEST

START_TEST(cameras_have_their_field_of_view)
{
    Scene scene;
    gltf_scene(CAMERA("{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"aspectRatio\":2,\"znear\":0.1}}"),
               &scene);
    TEST_NEAR(scene.camera_settings.fov, 0.8 * 180.0 / M_PI, 1e-5);
    ck_assert_int_eq(scene.settings.width, 1440);
    ck_assert_int_eq(scene.settings.height, 720);
    scene_destroy(&scene);
    /* pbrt's angle is that of the shorter side, glTF's is vertical. */
    gltf_scene(CAMERA("{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"aspectRatio\":0.5,\"znear\":0.1}}"),
               &scene);
    TEST_NEAR(scene.camera_settings.fov, 2.0 * atan(0.5 * tan(0.4)) * 180.0 / M_PI, 1e-5);
    ck_assert_int_eq(scene.settings.width, 720);
    ck_assert_int_eq(scene.settings.height, 1440);
    scene_destroy(&scene);
    gltf_scene(CAMERA("{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":3,\"ymag\":2,\"znear\":0,\"zfar\":9}}"),
               &scene);
    ck_assert_uint_eq(scene.camera_settings.kind, CAMERA_ORTHOGRAPHIC);
    TEST_NEAR(scene.camera_settings.screen_window[1], 3, 0);
    TEST_NEAR(scene.camera_settings.screen_window[2], -2, 0);
    ck_assert_int_eq(scene.settings.width, 1080);
    scene_destroy(&scene);
}
END_TEST

/* Where a point of the world is in camera space: x right, y up, z into the scene. */
static Vec3 seen(const Scene *scene, double x, double y, double z)
{
    const Matrix *matrix = (const Matrix *)(const void *)scene->camera_settings.camera_from_world;
    double p[3] = {x, y, z};
    matrix_point(matrix, p, p);
    return vec3((float)p[0], (float)p[1], (float)p[2]);
}

START_TEST(cameras_look_along_minus_z)
{
    Scene scene;
    /* At (0, 0, 5) and of a scale that does not matter. */
    gltf_scene("\"nodes\":[{\"camera\":0,\"translation\":[0,0,5],\"scale\":[2,3,4]}," GLTF_LIGHT_NODE "],\"cameras\":["
               "{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"znear\":0.1}}]," GLTF_LIGHT,
               &scene);
    assert_vec3(seen(&scene, 1, 2, 0), 1, 2, 5, 1e-6);
    scene_destroy(&scene);
    /* Turned by 90 degrees about y: along -x, with -z to the right. */
    gltf_scene("\"nodes\":[{\"camera\":0,\"rotation\":[0,0.70710678,0,0.70710678]}," GLTF_LIGHT_NODE "],\"cameras\":["
               "{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"znear\":0.1}}]," GLTF_LIGHT,
               &scene);
    assert_vec3(seen(&scene, -7, 0, -1), 1, 0, 7, 1e-5);
    scene_destroy(&scene);
}
END_TEST

START_TEST(a_camera_and_a_sky_are_added)
{
    Scene scene;
    Error error = {{0}, {0}};
    gltf_scene("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":3}]}],"
               "\"nodes\":[{\"mesh\":0,\"translation\":[100,0,0]}]",
               &scene);
    gltf_says("has no camera: one is added that sees everything");
    gltf_says("has no light: a white sky of radiance 1 is added");
    ck_assert_uint_eq(scene.lights.count, 1);
    assert_vec3(ELEMENT(&scene, lights, Light, 0).emission, 1, 1, 1, 0);
    ck_assert_msg(scene_finish(&scene, &error), "%s", error.message);
    for (int corner = 0; corner < 4; ++corner) {
        Vec3 p = seen(&scene, 100.0 + corner % 2 - (double)scene.origin.x, corner / 2 - (double)scene.origin.y,
                      -(double)scene.origin.z);
        double edge = tan(20.0 * M_PI / 180.0) * (double)p.z;
        ck_assert(p.z > 0.0f && fabs((double)p.x) < edge && fabs((double)p.y) < edge);
        ck_assert(fabs((double)p.x) + fabs((double)p.y) > 0.2 * edge);
    }
    scene_destroy(&scene);
}
END_TEST

START_TEST(lights_have_their_units)
{
    Scene scene;
    gltf_scene("\"extensions\":{\"KHR_lights_punctual\":{\"lights\":["
               "{\"type\":\"point\",\"color\":[1,0.5,0.25],\"intensity\":8,\"range\":3},"
               "{\"type\":\"directional\",\"intensity\":100},"
               "{\"type\":\"spot\",\"intensity\":5,\"spot\":{\"innerConeAngle\":0.2,\"outerConeAngle\":0.6}}]}},"
               "\"nodes\":[{\"translation\":[1,2,3],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}},"
               "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}}},"
               "{\"rotation\":[0.70710678,0,0,0.70710678],\"extensions\":{\"KHR_lights_punctual\":{\"light\":2}}},"
               "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}]",
               &scene);
    ck_assert_uint_eq(scene.lights.count, 4); /* one of them by two nodes */
    const Light *light = &ELEMENT(&scene, lights, Light, 0);
    const LightDetail *detail = scene.light_details.data;
    ck_assert_uint_eq(light_kind(&light[0]), LIGHT_POINT);
    assert_vec3(light[0].emission, 8, 4, 2, 0);
    assert_vec3(detail[0].position, 1, 2, 3, 0);
    ck_assert_uint_eq(light_kind(&light[1]), LIGHT_DISTANT);
    assert_vec3(light[1].emission, 100, 100, 100, 0);
    assert_vec3(detail[1].direction, 0, 0, -1, 0);
    ck_assert_uint_eq(light_kind(&light[2]), LIGHT_SPOT);
    assert_vec3(detail[2].direction, 0, 1, 0, 1e-6);
    TEST_NEAR(detail[2].cos_total, cos(0.6), 1e-6);
    TEST_NEAR(detail[2].cos_falloff, cos(0.2), 1e-6);
    assert_vec3(detail[3].position, 0, 0, 0, 0);
    gltf_says("the range of KHR_lights_punctual.lights[0] is ignored");
    scene_destroy(&scene);
}
END_TEST

START_TEST(what_is_not_shown_is_said)
{
    Scene scene;
    gltf_scene("\"extensionsUsed\":[\"KHR_materials_sheen\",\"KHR_lights_punctual\"],"
               "\"animations\":[{\"channels\":[],\"samplers\":[]}],"
               "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"COLOR_0\":0},\"indices\":3,"
               "\"targets\":[{\"POSITION\":0}]}]}],"
               "\"cameras\":[{\"perspective\":{\"yfov\":1}}],"
               "\"nodes\":[{\"mesh\":0},{\"camera\":0},{\"camera\":0}," GLTF_LIGHT_NODE "]," GLTF_LIGHT,
               &scene);
    gltf_says("the extension KHR_materials_sheen is not supported and is ignored");
    gltf_says("animations are not played");
    gltf_says("morph targets have the default weights of their nodes and meshes");
    gltf_says("the vertex colours of meshes[0].primitives[0] are ignored");
    gltf_says("has 2 cameras: that of nodes[1] is used");
    ck_assert_ptr_null(strstr(gltf_log(), "KHR_lights_punctual is not supported"));
    scene_destroy(&scene);
}
END_TEST

TCase *gltf_scene_case(void)
{
    TCase *tests = gltf_case("scene");
    tcase_add_test(tests, meshes_are_as_stored);
    tcase_add_test(tests, buffers_may_be_data_uris);
    tcase_add_test(tests, strips_become_triangles);
    tcase_add_test(tests, sparse_accessors_replace_elements);
    tcase_add_test(tests, morph_targets_have_default_weights);
    tcase_add_test(tests, nodes_are_placed);
    tcase_add_test(tests, mirrored_nodes_keep_their_front);
    tcase_add_test(tests, shared_meshes_are_instances);
    tcase_add_test(tests, cameras_have_their_field_of_view);
    tcase_add_test(tests, cameras_look_along_minus_z);
    tcase_add_test(tests, a_camera_and_a_sky_are_added);
    tcase_add_test(tests, lights_have_their_units);
    tcase_add_test(tests, what_is_not_shown_is_said);
    return tests;
}
