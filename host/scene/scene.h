/* A scene in the host's memory: what an importer fills, and what the backends upload.
 *
 * Life of a Scene: scene_init; the importer appends to the arrays through the scene_add_* functions and sets camera,
 * film and options; scene_finish derives the light distributions, bounds, feature mask and packs the arrays into the
 * three buffers that the kernels read; scene_destroy. */
#ifndef TWINLIGHT_SCENE_SCENE_H
#define TWINLIGHT_SCENE_SCENE_H

#include "backend/backend.h"
#include "base/array.h"

/* What the scene file says about film, sampling and depth; command-line options override it. */
typedef struct SceneSettings {
    int width, height; /* pixels */
    int crop[4]; /* x0 y0 x1 y1, pixels */
    int max_depth; /* path segments (pbrt's maxdepth + 1) */
    int samples; /* per pixel */
    float film_scale; /* exposure: factor on every pixel (pbrt's iso x exposuretime / 100) */
    char output[1024]; /* file name of the film, "" when the file names none */
} SceneSettings;

/* What was dropped or replaced while reading, for `info`, the log and the statistics. */
typedef struct SceneCounts {
    unsigned long degenerate_triangles;
    unsigned long zero_area_lights;
    unsigned long substitutions; /* --lenient */
} SceneCounts;

/* Camera as the file gives it, before the film's size is final: camera_setup turns it into a Camera. */
typedef struct CameraSettings {
    uint kind; /* CAMERA_* */
    float fov; /* degrees, of the shorter side */
    float frame_aspect; /* 0: width / height */
    float screen_window[4]; /* valid when has_screen_window */
    bool has_screen_window;
    float lens_radius;
    float focal_distance;
    double world_from_camera[16]; /* row-major */
    double camera_from_world[16];
} CameraSettings;

typedef struct FilterSettings {
    uint kind; /* PIXEL_FILTER_* */
    float radius_x, radius_y; /* pixels */
    float sigma; /* gaussian */
    float b, c; /* mitchell */
    float tau; /* sinc */
} FilterSettings;

typedef struct Scene {
    SceneSettings settings;
    CameraSettings camera_settings;
    FilterSettings filter_settings;
    SceneCounts counts;

    /* geometry; element types in comments */
    Array positions; /* Vec3, world space (object space inside an object) */
    Array normals; /* Vec3, unit, already transformed and with ReverseOrientation applied */
    Array uvs; /* Vec2 */
    Array primitives; /* Primitive */
    Array shapes; /* Shape */
    Array patches; /* Patch */
    Array quadrics; /* Quadric */
    Array objects; /* Object; [0] is the world */
    Array instances; /* Instance */
    /* tables */
    Array materials; /* Material */
    Array texture_ops; /* TextureOp */
    Array images; /* TextureImage */
    Array lights; /* Light */
    Array light_alias; /* AliasBucket, made by scene_finish */
    Array infinite_lights; /* uint */
    double light_power; /* luminance of the flux of all lights, made by scene_finish */
    Array distributions2d; /* Distribution2D */
    Array lookup; /* float */
    Array texels; /* uint */

    Vec3 origin; /* of the scene's coordinates in those of the file: what the importer has taken off */
    bool movable; /* nobody keeps coordinates of it: scene_finish may move it (scene/center.h) */
    Array shape_objects; /* uint: the object of every shape */
    uint current_object;

    /* made by scene_finish */
    float bounds_min[3], bounds_max[3]; /* world space of the file, everything; see scene/center.h */
    float
        ray_reach; /* largest coordinate of where rays start on surfaces and at lights; frame.ray_reach: and the camera */
    uint features;
    size_t primitive_count; /* the array itself is freed once packed */
    FrameParams frame; /* layout, camera, filter, lights, bounds; seed, pass and depth are the integrator's */
    Guide guide; /* light guides; importance and visits are the integrator's */
    Array geometry_words; /* uint: the packed buffers */
    Array tables_words; /* uint */
} Scene;

void scene_init(Scene *scene);
void scene_destroy(Scene *scene);

/* One triangle mesh in world space (object space within an object definition). Arrays: positions 3 n floats, normals
 * 3 n or NULL, uvs 2 n or NULL, indices 3 m. The indices must be below n. Degenerate triangles (zero area in float32)
 * are dropped and counted. `shape` gives material, alpha and flags; its other members are set here. With `emission`
 * (one RGB radiance; NULL for none) every remaining triangle becomes an area light with `light_flags`. */
typedef struct MeshData {
    const float *positions;
    const float *normals;
    const float *uvs;
    size_t vertex_count;
    const uint *indices;
    size_t triangle_count;
} MeshData;
bool scene_add_mesh(Scene *scene, const MeshData *mesh, Shape shape, const float *emission, uint light_flags,
                    Error *error);

/* Bilinear patches: as above with four indices a patch (p00 p10 p01 p11). */
bool scene_add_patches(Scene *scene, const MeshData *mesh, Shape shape, const float *emission, uint light_flags,
                       Error *error);

/* Sphere or disk (kind PRIMITIVE_SPHERE or PRIMITIVE_DISK). `world_from_object` and its inverse: 4x4 row-major. The
 * caller fills radius, inner_radius, z_min, z_max, phi_max of `quadric`; the rest is set here. */
bool scene_add_quadric(Scene *scene, uint kind, Quadric quadric, const double world_from_object[16],
                       const double object_from_world[16], Shape shape, const float *emission, uint light_flags,
                       Error *error);

/* Object definitions: the primitives added between begin and end belong to the object. Returns its index in *object. */
bool scene_object_begin(Scene *scene, uint *object, Error *error);
bool scene_object_end(Scene *scene, Error *error);
bool scene_add_instance(Scene *scene, uint object, const double world_from_object[16],
                        const double object_from_world[16], Error *error);

/* Appends and returns the index in *index. */
bool scene_add_material(Scene *scene, const Material *material, uint *index, Error *error);
bool scene_add_light(Scene *scene, const Light *light, Error *error);

/* Surface area of one primitive in world space (double arithmetic). Before scene_finish has ended. */
double scene_primitive_area(const Scene *scene, uint primitive);

/* Derives everything marked "made by scene_finish". Fails when the scene has no light or reaches too far, and when a
 * count does not fit 32 bits. */
bool scene_finish(Scene *scene, Error *error);

/* Sets the film's size and crop again (after options) and recomputes the camera of `frame`. */
bool scene_film_set(Scene *scene, int width, int height, const int crop[4], Error *error);

/* Whether a conductor, dielectric or coat has a microfacet lobe anywhere, and not a delta. */
bool scene_material_is_rough(const Material *m);

/* Words of 32 bits that the packed geometry takes, as the arrays are now. A buffer may have SCENE_WORDS_MAX, 16 GiB. */
size_t scene_geometry_words(const Scene *scene);
#define SCENE_WORDS_MAX 0xfffffff0u

/* What a backend gets of a finished scene, which must outlive it. */
BackendScene scene_backend_view(const Scene *scene);

/* Bytes held by geometry, tables and texels. */
size_t scene_bytes(const Scene *scene);

#endif
