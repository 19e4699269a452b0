/* A glTF file in memory, read and checked: what its JSON describes, and its meshes as Assimp unpacks them. */
#ifndef TWINLIGHT_GLTF_DOCUMENT_H
#define TWINLIGHT_GLTF_DOCUMENT_H

#include "base/matrix.h"
#include "gltf/gltf.h"
#include "gltf/json_value.h"
#include "image/image.h"
#include "pbrt/ply.h"

/* Bytes of a buffer or of an image file. */
typedef struct GltfBytes {
    const unsigned char *data;
    size_t size;
    void *owned; /* freed with the document; NULL: part of another */
} GltfBytes;

/* (u, v) -> (m[0] u + m[1] v + m[2], m[3] u + m[4] v + m[5]) */
typedef struct UvTransform {
    double m[6];
} UvTransform;

/* A texture as a material refers to it. */
typedef struct GltfTexture {
    int image; /* -1: none */
    int uv_set;
    UvTransform transform; /* KHR_texture_transform, of glTF's coordinates: v = 0 is the top */
    bool clamp, nearest;
} GltfTexture;

typedef enum GltfAlpha { GLTF_OPAQUE, GLTF_MASK, GLTF_BLEND } GltfAlpha;

typedef struct GltfMaterial {
    char name[80]; /* printable, without quotes */
    double base[4];
    double metallic, roughness;
    double normal_scale;
    double emission[3]; /* factor times strength */
    double transmission;
    double ior;
    double coat, coat_roughness; /* KHR_materials_clearcoat: factor, and roughness like `roughness` */
    GltfTexture coat_texture, coat_roughness_texture;
    GltfTexture base_texture, metallic_roughness_texture, normal_texture, emissive_texture, transmission_texture;
    GltfAlpha alpha;
    double cutoff;
    bool double_sided;
    bool matte; /* without specular reflection: unlit, or a specular factor of 0 */
    bool volume; /* refracts: KHR_materials_volume with a thickness */
    bool used; /* by a part */
    int uv_set; /* the only one whose textures are used */
    UvTransform bake; /* applied to the vertices' texture coordinates */
} GltfMaterial;

typedef struct GltfPrimitive {
    size_t mesh; /* index of its mesh in `meshes`, and which of its primitives it is */
    size_t number;
    int material; /* the last entry of `materials` if the file names none */
    bool triangles; /* points and lines are left out */
    size_t triangle_count; /* if the scene shows it */
    size_t first_part, part_count; /* in `parts` */
} GltfPrimitive;

typedef struct GltfMesh {
    size_t number; /* in the file */
    size_t first_primitive, primitive_count;
    size_t uses; /* by nodes of the scene */
    int pose; /* the only node that shows it, which has a skin or weights of its own for it; -1: none */
} GltfMesh;

/* Triangles of a primitive that have the same emission. */
typedef struct GltfPart {
    PlyMesh mesh; /* texture coordinates as pbrt has them, v = 1 on top, with the material's `bake` applied */
    double emission[3]; /* radiance; 0: none */
} GltfPart;

typedef struct GltfNode {
    Matrix world; /* from the node's space */
    int parent; /* -1: a root */
    bool used; /* in the scene */
    int mesh, camera, light; /* -1: none */
    int skin; /* of `mesh`, whose vertices it moves to the world (gltf_mesh_world); -1: none */
} GltfNode;

typedef struct GltfCamera {
    bool orthographic;
    double yfov; /* radians */
    double aspect; /* width / height; 0: not given */
    double xmag, ymag; /* half the sides of the window of an orthographic camera */
} GltfCamera;

typedef enum GltfLightKind { GLTF_DIRECTIONAL, GLTF_POINT, GLTF_SPOT } GltfLightKind;

typedef struct GltfLight {
    GltfLightKind kind;
    double emission[3]; /* color times intensity: candela; lux of a directional light */
    double inner, outer; /* cone angles of a spot, radians */
} GltfLight;

typedef enum DerivedKind {
    DERIVED_COLOR, /* RGB times `factor`, and the reflectance under a coat if `coat` is not 0 */
    DERIVED_CHANNEL, /* one channel */
    DERIVED_ALPHA, /* alpha times factor[0] */
    DERIVED_MASK, /* 1 where alpha times factor[0] is at least factor[1], else 0 */
    DERIVED_NORMAL /* x and y of the normal times factor[0] */
} DerivedKind;

/* An image that the scene uses, made of one of the file. */
typedef struct DerivedImage {
    DerivedKind kind;
    int image;
    int channel;
    double factor[3];
    double coat; /* the part of diffuse light that a coat reflects back inside (gltf_coat_base); 0: none */
    bool is_float; /* 16 bits per channel: an EXR, else a PNG */
} DerivedImage;

struct Gltf {
    const char *path;
    json_t *root;
    GltfBytes file, binary; /* the whole file; the binary chunk of a .glb */
    GltfBytes *buffers;
    GltfMaterial *materials;
    GltfMesh *meshes;
    GltfPrimitive *primitives;
    GltfNode *nodes;
    GltfCamera *cameras;
    GltfLight *lights;
    size_t buffer_count, material_count, mesh_count, primitive_count, node_count, camera_count, light_count;
    Array parts; /* GltfPart */
    Array derived; /* DerivedImage */
};

/* Reads the file's container and JSON, and the buffers (container.c). */
bool gltf_container_read(Gltf *gltf, GltfReader *reader);
bool gltf_buffers_read(Gltf *gltf, GltfReader *reader);

/* The bytes at `uri`: a data URI or a file beside the glTF. `what` names the place in messages. */
bool gltf_uri_read(Gltf *gltf, GltfReader *reader, const char *uri, const char *what, GltfBytes *bytes);

/* The bytes of a buffer view. */
GltfBytes gltf_view(const Gltf *gltf, GltfReader *reader, size_t view);

/* Reads materials, nodes, cameras, lights, and primitives without their vertices. */
bool gltf_materials_read(Gltf *gltf, GltfReader *reader);
bool gltf_nodes_read(Gltf *gltf, GltfReader *reader);
bool gltf_primitives_read(Gltf *gltf, GltfReader *reader);

/* Gives each node that poses its mesh, by a skin or by weights of morph targets, a mesh of its own in `meshes`, behind
 * the file's (poses.c). */
bool gltf_poses_make(Gltf *gltf, GltfReader *reader);

/* From the space of a node's mesh to the world. */
Matrix gltf_mesh_world(const GltfNode *node);

/* Primitive `number` of the file's mesh `mesh`, as an object of the JSON. */
GltfObject gltf_primitive_object(GltfReader *reader, size_t mesh, size_t number);

/* Says what is left out, and fails for what the file requires and is not supported (extensions.c). */
bool gltf_extensions_check(const Gltf *gltf, GltfReader *reader);

/* Allocates an array of `count` zeroed elements; false when out of memory. */
bool gltf_allocate(GltfReader *reader, void **array, size_t count, size_t size);

#endif
