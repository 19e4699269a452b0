/* The parts of the glTF tests, and what they share: small files, written for each test. */
#ifndef TWINLIGHT_TESTS_GLTF_TEST_GLTF_H
#define TWINLIGHT_TESTS_GLTF_TEST_GLTF_H

#include "gltf/gltf.h"
#include "gltf/load.h"
#include "support/test_util.h"

TCase *gltf_scene_case(void); /* nodes, meshes, cameras, lights */
TCase *gltf_skins_case(void); /* skins, weights of morph targets */
TCase *gltf_materials_case(void);
TCase *gltf_textures_case(void);
TCase *gltf_bad_case(void); /* damaged and hostile files */
TCase *gltf_convert_case(void);

/* A case with a scratch folder of its own. */
TCase *gltf_case(const char *name);

/* The buffer of the tests' files, whose accessors are
 *   0 positions of a square from (0, 0) to (1, 1) in the plane z = 0, counterclockwise from the origin, seen from +z
 *   1 its normals, (0, 0, 1)     2 its texture coordinates, (x, 1 - y): the image is upright
 *   3 its two triangles, 16-bit indices    4 positions of the same square as a strip, without indices
 * Buffer view 4 is a PNG of 2 x 2 pixels (r, g, b, a):
 *   (255, 0, 0, 255) (0, 255, 0, 128)
 *   (0, 0, 255, 64)  (128, 64, 32, 0) */
#define GLTF_ACCESSORS                                                                                                 \
    "\"accessors\":["                                                                                                  \
    "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"                                         \
    "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"                                         \
    "{\"bufferView\":2,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"                                         \
    "{\"bufferView\":3,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"                                       \
    "{\"bufferView\":5,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"}]"

/* The mesh of the square with all attributes and `material` 0. */
#define GLTF_SQUARE                                                                                                    \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},\"indices\":3,"       \
    "\"material\":0}]}]"

/* The image as texture 0. */
#define GLTF_TEXTURE "\"images\":[{\"bufferView\":4,\"mimeType\":\"image/png\"}],\"textures\":[{\"source\":0}]"

/* A light that illuminates nothing in particular, so that scenes are not given a sky. */
#define GLTF_LIGHT "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\"}]}}"
#define GLTF_LIGHT_NODE "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}"

/* Writes NAME.glb: the members of the JSON's root but asset, accessors, buffers and bufferViews, which are added.
 * Returns its path, in one of a few buffers used in rotation. */
const char *gltf_write(const char *name, const char *members);

/* NAME in the tests' scratch folder, in one of a few buffers used in rotation. */
const char *gltf_path(const char *name);

/* The same with these accessors instead. */
const char *gltf_write_with(const char *name, const char *accessors, const char *members);

/* Removes a folder of files. */
void gltf_folder_remove(const char *path);

/* Reads a file with these members, which must succeed. */
void gltf_scene(const char *members, Scene *scene);

/* The error of a file, which must fail, without the path in front, in a static buffer. */
const char *gltf_error(const char *path);

/* Log messages since the last call, in a static buffer. */
const char *gltf_log(void);

/* Whether the messages of the last file have this text; fails the test if not. */
void gltf_says(const char *text);

/* What shapes[i] is made of: its material. */
const Material *gltf_material(const Scene *scene, size_t shape);

#define ELEMENT(scene, member, T, i) ARRAY_AT(&(scene)->member, T, i)

/* |a - b| <= tolerance for all three components. */
void assert_vec3(Vec3 a, double x, double y, double z, double tolerance);

#endif
