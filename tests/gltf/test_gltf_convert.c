/* Conversions: the scene that is written is the scene that is read. */
#include "gltf/test_gltf.h"
#include "pbrt/import.h"

#include <string.h>

/* Whether the packed scenes are the same, word by word. */
static void assert_same_scene(const Scene *a, const Scene *b)
{
    const Array *const words[2][3] = {{&a->geometry_words, &a->tables_words, &a->texels},
                                      {&b->geometry_words, &b->tables_words, &b->texels}};
    for (int i = 0; i < 3; ++i) {
        ck_assert_uint_eq(words[0][i]->count, words[1][i]->count);
        if (words[0][i]->count > 0)
            ck_assert_mem_eq(words[0][i]->data, words[1][i]->data, words[0][i]->count * sizeof(uint));
    }
    ck_assert_mem_eq(&a->frame, &b->frame, sizeof a->frame);
}

/* Loads a glTF file, and the conversion of it that is written to `converted`. */
static void both_load(const char *path, const char *converted, Scene *read, Scene *written)
{
    Error error = {{0}, {0}};
    scene_init(read);
    scene_init(written);
    ck_assert_msg(scene_file_load(path, false, read, &error), "%s", error.message);
    Gltf *gltf = gltf_open(path, &error);
    ck_assert_msg(gltf && gltf_convert(gltf, converted, &error), "%s", error.message);
    gltf_close(gltf);
    ck_assert_msg(pbrt_load(converted, false, written, &error), "%s", error.message);
}

/* Of everything: textures of both kinds of material, alpha, emission with a texture, instances, lights. */
#define EVERYTHING                                                                                                     \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},\"indices\":3,"       \
    "\"material\":0}]},{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":2},\"indices\":3,"              \
    "\"material\":1},{\"attributes\":{\"POSITION\":4},\"mode\":5}]}]," GLTF_TEXTURE ",\"materials\":["                 \
    "{\"name\":\"a \\\"b\\\\\",\"alphaMode\":\"BLEND\",\"normalTexture\":{\"index\":0,\"scale\":0.7},"                 \
    "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},\"metallicRoughnessTexture\":{\"index\":0},"         \
    "\"baseColorFactor\":[0.3,0.7,0.9,0.8],\"metallicFactor\":0.3}},"                                                  \
    "{\"emissiveFactor\":[0.3,1,0.7],\"emissiveTexture\":{\"index\":0},\"pbrMetallicRoughness\":{"                     \
    "\"metallicFactor\":0},\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":0.3}}}],"            \
    "\"nodes\":[{\"mesh\":0,\"translation\":[0.1,0.2,0.3],\"rotation\":[0.1,0.2,0.3,0.9]},{\"mesh\":0},"               \
    "{\"mesh\":1,\"scale\":[1,-0.7,3]},{\"mesh\":1,\"translation\":[0,0,7.7]}," GLTF_LIGHT_NODE "]," GLTF_LIGHT

START_TEST(conversions_are_the_same_scene)
{
    Scene read, written;
    const char *path = gltf_write("all.glb", EVERYTHING), *converted = gltf_path("all.pbrt");
    both_load(path, converted, &read, &written);
    ck_assert_uint_gt(read.lights.count, 2);
    ck_assert_uint_gt(read.instances.count, 0);
    assert_same_scene(&read, &written);
    scene_destroy(&read);
    scene_destroy(&written);
    gltf_folder_remove(gltf_path("all-meshes"));
    gltf_folder_remove(gltf_path("all-textures"));
}
END_TEST

/* A PNG of 2 x 1 pixels with 16 bits per channel: (0x1234, 0x8000, 0xffff), (0x101, 0x4000, 0xc000). */
static const char DEEP[] =
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABEAIAAAAr0DSeAAAAFUlEQVR42mMQMmlg+P+fkdGB4QADABmdA8fj0rMgAAAAAElFTkSu"
    "QmCC";

START_TEST(deep_images_are_floats)
{
    char members[4096];
    Scene read, written;
    snprintf(members, sizeof members,
             GLTF_SQUARE ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},"
                         "\"metallicRoughnessTexture\":{\"index\":0},\"metallicFactor\":0}}],"
                         "\"images\":[{\"uri\":\"data:image/png;base64,%s\"}],\"textures\":[{\"source\":0}],"
                         "\"nodes\":[{\"mesh\":0}]",
             DEEP);
    const char *path = gltf_write("deep.glb", members), *converted = gltf_path("deep.pbrt");
    both_load(path, converted, &read, &written);
    ck_assert_int_eq(access(gltf_path("deep-textures/0.exr"), R_OK), 0);
    assert_same_scene(&read, &written);
    /* Image 0 is the roughness: the green channel, as it is. */
    const float *green = (const float *)read.texels.data;
    TEST_NEAR(green[0], 0x8000 / 65535.0, 1e-7);
    TEST_NEAR(green[1], 0x4000 / 65535.0, 1e-7);
    scene_destroy(&read);
    scene_destroy(&written);
    gltf_folder_remove(gltf_path("deep-meshes"));
    gltf_folder_remove(gltf_path("deep-textures"));
}
END_TEST

/* The same content by hand. */
START_TEST(scenes_are_those_of_pbrt)
{
    static const char PBRT[] = "Integrator \"volpath\" \"integer maxdepth\" 10 Scale 1 1 -1 Translate 0 0 -5 "
                               "Camera \"perspective\" \"float fov\" 45.8366236 "
                               "Film \"rgb\" \"integer xresolution\" 720 \"integer yresolution\" 720 WorldBegin "
                               "AttributeBegin Translate 0 2 0 LightSource \"point\" \"rgb I\" [ 6 6 6 ] AttributeEnd "
                               "Material \"conductor\" \"rgb reflectance\" [ 0.5 0.25 1 ] \"float roughness\" 0.25 "
                               "\"bool remaproughness\" false "
                               "Translate 1 0 0 Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ] "
                               "\"normal N\" [ 0 0 1 0 0 1 0 0 1 0 0 1 ] \"integer indices\" [ 0 1 2 0 2 3 ]";
    Error error = {{0}, {0}};
    const ImportOptions options = {0};
    Scene ours, theirs;
    gltf_scene(
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":3,\"material\":0}]}],"
        "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,1,1],\"roughnessFactor\":0.5}}],"
        "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"aspectRatio\":1,\"znear\":1}}],"
        "\"nodes\":[{\"mesh\":0,\"translation\":[1,0,0]},{\"camera\":0,\"translation\":[0,0,5]},"
        "{\"translation\":[0,2,0],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}],\"extensions\":{"
        "\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\",\"intensity\":6}]}}",
        &ours);
    scene_init(&theirs);
    ck_assert_msg(pbrt_import_text(PBRT, strlen(PBRT), "hand.pbrt", ".", &options, &theirs, &error), "%s",
                  error.message);
    ck_assert_msg(scene_finish(&ours, &error) && scene_finish(&theirs, &error), "%s", error.message);
    assert_same_scene(&ours, &theirs);
    scene_destroy(&ours);
    scene_destroy(&theirs);
}
END_TEST

START_TEST(conversions_keep_their_inputs)
{
    Error error = {{0}, {0}};
    const char *path = gltf_write("keep.glb", EVERYTHING);
    Gltf *gltf = gltf_open(path, &error);
    ck_assert_ptr_nonnull(gltf);
    ck_assert_int_eq(symlink("keep.glb", gltf_path("keep.pbrt")), 0);
    ck_assert(!gltf_convert(gltf, gltf_path("keep.pbrt"), &error));
    ck_assert_ptr_nonnull(strstr(error.message, "the conversion would overwrite a file that the scene reads"));
    gltf_close(gltf);
}
END_TEST

TCase *gltf_convert_case(void)
{
    TCase *tests = gltf_case("convert");
    tcase_add_test(tests, conversions_are_the_same_scene);
    tcase_add_test(tests, deep_images_are_floats);
    tcase_add_test(tests, scenes_are_those_of_pbrt);
    tcase_add_test(tests, conversions_keep_their_inputs);
    return tests;
}
