/* A scene in host memory: filled by an importer, uploaded by the backends.
 *
 * Life cycle: scene_init; the importer appends to the arrays through the scene_add_* functions and sets camera, film
 * and options; scene_finish derives light distributions, bounds and feature mask, and packs the arrays into the three
 * buffers that the kernels read; scene_destroy. */
#ifndef TWINLIGHT_SCENE_SCENE_H
#define TWINLIGHT_SCENE_SCENE_H

#include "backend/backend.h"
#include "base/array.h"

/* Settings of film, sampling and depth in the scene file; command-line options override them. */
typedef struct SceneSettings {
    int width, height; /* pixels */
    int crop[4]; /* x0 y0 x1 y1, pixels */
    int max_depth; /* path segments (pbrt's maxdepth + 1) */
    int samples; /* per pixel */
    float film_scale; /* exposure: factor on every pixel (pbrt's iso x exposuretime / 100) */
    char output[1024]; /* file name of the film, "" if the scene names none */
} SceneSettings;

/* What was dropped or replaced while reading; for `info`, the log and the statistics. */
typedef struct SceneCounts {
    unsigned long degenerate_triangles; /* and patches, quadrics and curves */
    unsigned long zero_area_lights;
    unsigned long substitutions; /* replacements made by --lenient */
} SceneCounts;

/* Camera as given in the file, before the film's size is final; camera_setup turns it into a Camera. */
typedef struct CameraSettings {
    uint kind; /* CAMERA_* */
    float fov; /* degrees, along the film's shorter side */
    float frame_aspect; /* 0: width / height */
    float screen_window[4]; /* valid if has_screen_window */
    bool has_screen_window;
    float lens_radius;
    float focal_distance;
    double world_from_camera[16]; /* row-major */
    double camera_from_world[16];
    uint medium; /* around the camera: index into `media` */
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
    Array positions; /* Vec3, world space (or object space in an object definition) */
    Array normals; /* Vec3, unit length, transformed, with ReverseOrientation applied */
    Array uvs; /* Vec2 */
    Array primitives; /* Primitive */
    Array shapes; /* Shape */
    Array patches; /* Patch */
    Array quadrics; /* Quadric */
    Array curves; /* Curve */
    Array objects; /* Object; [0] is the world */
    Array instances; /* Instance */
    /* tables */
    Array materials; /* Material */
    Array texture_ops; /* TextureOp */
    Array images; /* TextureImage */
    Array lights; /* Light */
    Array light_details; /* LightDetail */
    Array light_alias; /* AliasBucket, set by scene_finish */
    Array light_tree; /* LightTree, set by scene_finish: one */
    Array light_nodes; /* LightNode, set by scene_finish; none for a single light */
    Array light_leaves; /* uint, set by scene_finish */
    Array infinite_lights; /* uint */
    Array portals; /* Portal; scene_finish sets its sums */
    Array aims; /* Aim, set by scene_finish */
    Array media; /* Medium; [0] is empty space; none in scenes that name no medium */
    Array grids; /* MediumGrid */
    double light_power; /* luminance of the flux of all lights, set by scene_finish */
    Array distributions2d; /* Distribution2D */
    Array lookup; /* float */
    Array texels; /* uint */

    Vec3 origin; /* origin of the scene's coordinates in those of the file, subtracted by the importer */
    bool movable; /* scene_finish may move the scene to the origin (scene/center.h) */
    Array shape_objects; /* uint: object of each shape */
    uint current_object;

    /* set by scene_finish */
    float bounds_min[3], bounds_max[3]; /* bounds of everything in the file's world space, see scene/center.h */
    float ray_reach; /* largest coordinate of ray origins on surfaces and lights; SceneParams: also on the camera */
    ulong features;
    uint medium_around; /* that fills the space around the scene: index into `media` */
    size_t primitive_count; /* the array itself is freed by packing */
    FrameParams frame; /* layout, camera, filter, lights, bounds; seed, pass and depth are set by the integrator */
    Guide guide; /* light guides; importance and visits are set by the integrator */
    Array geometry_words; /* uint: packed buffer */
    Array tables_words; /* uint */
} Scene;

/* An empty scene with default settings. */
void scene_init(Scene *scene);
void scene_destroy(Scene *scene);

/* A triangle mesh in world space (object space in an object definition): positions 3 n floats, normals 3 n or NULL, uvs
 * 2 n or NULL, indices 3 m, which must be below n. Degenerate triangles (zero area in float) are dropped and counted.
 * `shape` gives material, alpha and flags; its other members are set here. With `emission` (an RGB radiance; NULL for
 * none) every remaining triangle becomes an area light with `light_flags`. */
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

/* Bilinear patches: as above with four indices per patch (p00 p10 p01 p11). */
bool scene_add_patches(Scene *scene, const MeshData *mesh, Shape shape, const float *emission, uint light_flags,
                       Error *error);

/* A sphere, disk or cylinder; shape, emission and light_flags as above. */
typedef struct QuadricData {
    uint kind; /* PRIMITIVE_SPHERE, PRIMITIVE_DISK or PRIMITIVE_CYLINDER */
    Quadric quadric; /* radius, inner_radius, z_min, z_max and phi_max; the rest is set by scene_add_quadric */
    const double *world_from_object, *object_from_world; /* 4x4, row-major; inverse to each other */
} QuadricData;
bool scene_add_quadric(Scene *scene, const QuadricData *data, Shape shape, const float *emission, uint light_flags,
                       Error *error);

/* Curves in world space (object space in an object definition); each becomes 2^levels primitives, levels <=
 * CURVE_LEVELS_MAX. type: CURVE_FLAT or CURVE_ROUND. Curves without width or length are dropped and counted. They emit
 * nothing. */
typedef struct CurveData {
    const Curve *curves;
    size_t count;
    uint levels, type;
} CurveData;
bool scene_add_curves(Scene *scene, const CurveData *data, Shape shape, Error *error);

/* Object definitions: shapes added between begin and end belong to the object. *object: its index. */
bool scene_object_begin(Scene *scene, uint *object, Error *error);
bool scene_object_end(Scene *scene, Error *error);
bool scene_add_instance(Scene *scene, uint object, const double world_from_object[16],
                        const double object_from_world[16], Error *error);

/* Appends a material; *index: its index. */
bool scene_add_material(Scene *scene, const Material *material, uint *index, Error *error);

/* Appends a light that is no area light. */
typedef struct LightData {
    uint kind; /* LIGHT_* */
    uint flags;
    Vec3 emission;
    LightDetail detail;
} LightData;
bool scene_add_light(Scene *scene, const LightData *light, Error *error);
LightDetail *scene_light_detail(const Scene *scene, const Light *light);

/* Appends the portal of an infinite light (scene/portal_setup.h makes it); *index: LightDetail.portal. */
bool scene_add_portal(Scene *scene, const Portal *portal, uint *index, Error *error);

/* Appends a medium; *number: its index, at least 1. */
bool scene_add_medium(Scene *scene, const Medium *medium, uint *number, Error *error);

/* Surface area of a primitive in world space, computed in double. Only before scene_finish has ended. */
double scene_primitive_area(const Scene *scene, uint primitive);

/* Derives everything marked "set by scene_finish". Fails if the scene has no light or extends too far, or if a count
 * exceeds 32 bits. */
bool scene_finish(Scene *scene, Error *error);

/* Sets the film's size and crop again (after options) and updates the camera and ray_reach of `frame`. */
bool scene_film_set(Scene *scene, int width, int height, const int crop[4], Error *error);

/* Whether a conductor, dielectric or coat may have a microfacet lobe: a textured roughness counts as rough. */
bool scene_material_is_rough(const Material *m);

/* Whether a material, or one that it mixes, may have a delta lobe: a mirror, glass or coat that is not rough; whether
 * any of the scene may. */
bool scene_material_has_delta(const Scene *scene, uint material);
bool scene_has_delta(const Scene *scene);

/* Whether it has area lights of alpha 0. */
bool scene_has_invisible_light(const Scene *scene);

/* Whether there may be light that path tracing by itself cannot find, without photons: of lights that no ray hits, by
 * way of smooth specular surfaces. */
bool scene_hides_light(const Scene *scene);

/* Sets the feature mask, of the kernels' frame too. */
void scene_features_set(Scene *scene, ulong features);

/* Number of 32-bit words that the geometry would take when packed now. A buffer may have SCENE_WORDS_MAX, 16 GiB. */
size_t scene_geometry_words(const Scene *scene);
#define SCENE_WORDS_MAX 0xfffffff0u

/* View of a finished scene for a backend. The scene must outlive it. */
BackendScene scene_backend_view(const Scene *scene);

/* Bytes of geometry, tables and texels. */
size_t scene_bytes(const Scene *scene);

#endif
