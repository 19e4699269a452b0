/* Damaged and hostile files: one sentence that names the file, and nothing else happens. */
#include "gltf/test_gltf.h"

#include "support/test_files.h"

#include <string.h>

#define NODES "\"nodes\":[{\"mesh\":0}]"

/* Members, or accessors in front of them, and the message. */
static const struct {
    const char *accessors; /* NULL: the usual ones */
    const char *members;
    const char *message;
} BAD[] = {
    {NULL, "\"nodes\":[{\"children\":[1]},{\"children\":[0]}]", "the nodes have a cycle: some are their own ancestors"},
    {NULL, "\"nodes\":[{\"children\":[1]},{\"children\":[1]}]", "nodes[1] has two parents"},
    {NULL, "\"scenes\":[{\"nodes\":[1]}],\"nodes\":[{\"children\":[1]},{}]",
     "scenes[0] lists nodes[1], which is a child of nodes[0]"},
    {NULL, "\"nodes\":[{\"children\":[7]}]", "nodes[0].children[0] is 7, but there are 1 nodes"},
    {NULL, "\"nodes\":[{\"mesh\":-1}]", "nodes[0].mesh is -1, but there are 0 meshes"},
    {NULL, "\"nodes\":[{\"mesh\":\"x\"}]", "nodes[0].mesh must be an index into meshes"},
    {NULL, "\"nodes\":5", "nodes must be an array"},
    {NULL, "\"nodes\":[5]", "nodes[0] must be an object"},
    {NULL, "\"nodes\":[{\"translation\":[1,2]}]", "nodes[0].translation must be an array of 3 numbers"},
    {NULL, "\"nodes\":[{\"translation\":[1,2,1e300]}]", "nodes[0].translation must be an array of 3 numbers"},
    {NULL, "\"nodes\":[{\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2]}]", "nodes[0].matrix is not affine"},
    {NULL, "\"nodes\":[{\"scale\":[1e30,1,1],\"children\":[1]},{\"scale\":[1e30,1,1]}]",
     "the transform of nodes[1] overflows"},
    {NULL, "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]",
     "the file requires the extension KHR_draco_mesh_compression, which is not supported"},
    {NULL, "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0}}]",
     "cameras[0].perspective.yfov must be a number from 0.0001 to 3.14"},
    {NULL, "\"cameras\":[{}]", "cameras[0] is neither perspective nor orthographic"},
    {NULL, "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"area\"}]}}",
     "KHR_lights_punctual.lights[0].type is \"area\" instead of point, spot or directional"},
    {NULL, "\"nodes\":[{\"extensions\":{\"KHR_lights_punctual\":{\"light\":2}}}]",
     "nodes[0].extensions.KHR_lights_punctual.light is 2, but there are 0 lights"},
    {NULL, "\"materials\":[{\"alphaMode\":\"GLASS\"}]",
     "materials[0].alphaMode is \"GLASS\" instead of OPAQUE, MASK or BLEND"},
    {NULL, "\"materials\":[{\"pbrMetallicRoughness\":{\"roughnessFactor\":2}}]",
     "materials[0].pbrMetallicRoughness.roughnessFactor must be a number from 0 to 1"},
    {NULL, "\"materials\":[{\"normalTexture\":{\"index\":0}}]",
     "materials[0].normalTexture.index is 0, but there are 0 textures"},
    {NULL, "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":9}}]}]," NODES,
     "meshes[0].primitives[0].attributes.POSITION is 9, but there are 5 accessors"},
    {NULL, "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":2}}]}]," NODES,
     "accessors[2] is of type \"VEC2\" instead of VEC3"},
    {NULL, "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":0}]}]," NODES,
     "accessors[0] is of type \"VEC3\" instead of SCALAR"},
    {NULL, "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":7}]}]," NODES,
     "meshes[0].primitives[0].mode is 7, above 6"},
    {"\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":5,\"type\":\"VEC3\"}]",
     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]," NODES,
     "accessors[0] reaches beyond its bufferView of 48 bytes"},
    {"\"accessors\":[{\"bufferView\":0,\"byteOffset\":9007199254740992,\"componentType\":5126,\"count\":1,\"type\":"
     "\"VEC3\"}]",
     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]," NODES,
     "accessors[0] reaches beyond its bufferView of 48 bytes"},
    {"\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":2000000000,\"type\":\"VEC3\"}]",
     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]," NODES,
     "accessors[0] reaches beyond its bufferView of 48 bytes"},
    {"\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\","
     "\"sparse\":{\"count\":4,\"indices\":{\"bufferView\":3,\"componentType\":5125},\"values\":{\"bufferView\":0}}}]",
     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]," NODES,
     "accessors[0].sparse.indices reaches beyond its bufferView of 12 bytes"},
    {"\"accessors\":[{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}]",
     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]," NODES, "accessors[0] names no bufferView"},
    {"\"accessors\":[{\"bufferView\":0,\"componentType\":5123,\"count\":3,\"type\":\"VEC3\"}]",
     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]," NODES,
     "accessors[0] has the component type 5123, which is not supported here"},
    {"\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
     "{\"bufferView\":3,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}]",
     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}]," NODES,
     "accessors[1] has the vertex index 3, but there are 3 vertices"},
    {"\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
     "{\"bufferView\":2,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"}]",
     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1}}]}]," NODES,
     "accessors[1] reaches beyond its bufferView of 32 bytes"},
    {NULL,
     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":3,\"material\":0}]}],"
     "\"materials\":[{\"normalTexture\":{\"index\":0}}],\"images\":[{\"bufferView\":0}],\"textures\":[{\"source\":0}]"
     "," NODES,
     "normal map: cannot read the image images[0]: it is neither PNG nor JPEG, or truncated"},
    {NULL,
     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":3,\"material\":0}]}],"
     "\"materials\":[{\"normalTexture\":{\"index\":0}}],\"images\":[{}],\"textures\":[{\"source\":0}]," NODES,
     "images[0] has neither uri nor bufferView"},
};

START_TEST(bad_files_get_one_sentence)
{
    const char *path = BAD[_i].accessors ? gltf_write_with("bad.glb", BAD[_i].accessors, BAD[_i].members)
                                         : gltf_write("bad.glb", BAD[_i].members);
    char expected[256];
    snprintf(expected, sizeof expected, "error: %s", BAD[_i].message);
    ck_assert_str_eq(gltf_error(path), expected);
}
END_TEST

/* Texts of .gltf files. */
static const struct {
    const char *text;
    const char *message; /* begin of it */
} TEXTS[] = {
    {"", "error: the JSON is not valid: "},
    {"{\"asset\":{\"version\":\"2.0\"}", "error: the JSON is not valid: "},
    {"[]", "error: the JSON is not an object"},
    {"{}", "error: the file has version \"\" of glTF instead of 2.0"},
    {"{\"asset\":{\"version\":\"1.0\"}}", "error: the file has version \"1.0\" of glTF instead of 2.0"},
    {"{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"scale\":[1e999,1,1]}]}", "error: the JSON is not valid: "},
    {"{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"scale\":[NaN,1,1]}]}", "error: the JSON is not valid: "},
    {"{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":8}]}",
     "error: buffers[0] has no uri, and the file has no binary chunk for it"},
    {"{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":8,\"uri\":\"data:;base64,AAAA\"}]}",
     "error: buffers[0] is truncated: it has 3 of 8 bytes"},
    {"{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":3,\"uri\":\"data:;base64,A*AA\"}]}",
     "error: the data URI of buffers[0] has a character that is not base64"},
    {"{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":3,\"uri\":\"data:text/plain,AAA\"}]}",
     "error: the data URI of buffers[0] is not base64"},
    {"{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":3,\"uri\":\"missing%20file.bin\"}]}",
     "error: cannot read "},
    {"{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":3,\"uri\":\"https://example.org/a.bin\"}]}",
     "error: buffers[0] is not a file: "},
};

START_TEST(bad_texts_get_one_sentence)
{
    const char *path = gltf_path("bad.gltf");
    test_file_write(path, TEXTS[_i].text, strlen(TEXTS[_i].text));
    const char *message = gltf_error(path);
    ck_assert_msg(strncmp(message, TEXTS[_i].message, strlen(TEXTS[_i].message)) == 0, "%s", message);
}
END_TEST

/* Every shorter file is refused. */
START_TEST(truncated_files_are_refused)
{
    size_t size;
    unsigned char *file = test_file_read(gltf_write("whole.glb", GLTF_SQUARE ",\"materials\":[{}]," NODES), &size);
    for (size_t length = 0; length < size; length += length < 64 ? 1 : 37) {
        test_file_write(gltf_path("bad.glb"), file, length);
        gltf_error(gltf_path("bad.glb"));
    }
    free(file);
}
END_TEST

/* Deeper than any stack. */
START_TEST(deep_nesting_is_no_danger)
{
    enum { DEEP = 200000 };
    Error error = {{0}, {0}};
    Scene scene;
    char *text = malloc(64 * (size_t)DEEP);
    size_t n = (size_t)sprintf(text, "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[");
    for (int i = 0; i < DEEP; ++i)
        n += (size_t)sprintf(text + n, "{\"children\":[%d]},", i + 1);
    n += (size_t)sprintf(text + n, "{}]}");
    test_file_write(gltf_path("deep.gltf"), text, n);
    scene_init(&scene);
    ck_assert_msg(scene_file_load(gltf_path("deep.gltf"), false, &scene, &error), "%s", error.message);
    scene_destroy(&scene);
    memset(text, '[', DEEP);
    test_file_write(gltf_path("bad.gltf"), text, DEEP);
    ck_assert_ptr_nonnull(strstr(gltf_error(gltf_path("bad.gltf")), "the JSON is not valid: "));
    free(text);
}
END_TEST

TCase *gltf_bad_case(void)
{
    TCase *tests = gltf_case("bad");
    tcase_add_loop_test(tests, bad_files_get_one_sentence, 0, (int)(sizeof BAD / sizeof BAD[0]));
    tcase_add_loop_test(tests, bad_texts_get_one_sentence, 0, (int)(sizeof TEXTS / sizeof TEXTS[0]));
    tcase_add_test(tests, truncated_files_are_refused);
    tcase_add_test(tests, deep_nesting_is_no_danger);
    return tests;
}
