/* State shared by the parts of the pbrt importer while a file is read. */
#ifndef TWINLIGHT_PBRT_CONTEXT_H
#define TWINLIGHT_PBRT_CONTEXT_H

#include "base/matrix.h"
#include "base/name_table.h"
#include "geometry/box.h"
#include "pbrt/import_options.h"
#include "pbrt/params.h"
#include "scene/scene.h"
#include "scene/texture_image.h"

#include <sys/types.h>

/* Limits that keep hostile files from exhausting memory or stack; no known scene comes near them. */
#define IMPORT_NESTING_MAX 65536 /* open scopes: AttributeBegin, ObjectBegin, Import */
#define IMPORT_INCLUDE_MAX 64 /* depth of Include and Import */
#define IMPORT_FILES_MAX 65536 /* number of Include and Import */
#define IMPORT_FILE_BYTES_MAX 0x7ffffffe /* per file: lines and columns are ints */
#define IMPORT_ATTRIBUTES_MAX 1024 /* parameters of Attribute directives in force; each directive searches all */
#define IMPORT_COORDINATE_SYSTEMS_MAX 65536
#define IMPORT_LIGHTS_MAX (1u << 24) /* area lights created by instances of emissive objects */
#define IMPORT_COPIES_MAX (1u << 26) /* vertices of these instances, which each have their own copy */
#define IMPORT_DEPTH_MAX 65536 /* maxdepth is clamped to this */
#define IMPORT_COORDINATE_MAX 1e12 /* of a point in world space: products of three must fit a float */
#define IMPORT_ERRORS_MAX 20 /* errors of a scene shown in one run */
#define IMPORT_FILM_MAX 65535 /* width and height of the film, pixels */

/* Used instead of a material index. */
#define MATERIAL_INTERFACE 0xfffffffeu /* no material: the shape is invisible, but may separate media */

/* Targets of the Attribute directive. */
enum { ATTRIBUTE_SHAPE, ATTRIBUTE_LIGHT, ATTRIBUTE_MATERIAL, ATTRIBUTE_MEDIUM, ATTRIBUTE_TEXTURE, ATTRIBUTE_COUNT };

/* An AreaLightSource directive. */
typedef struct AreaLightSource {
    const char *kind;
    SourcePlace place;
    const ParamSet *params; /* of AreaLightSource itself */
    const ParamSet *attributes; /* of Attribute "light" */
} AreaLightSource;

/* What AttributeBegin saves. Pointers refer to the importer's arena. */
typedef struct GraphicsState {
    Matrix ctm[2]; /* at the start and end of the shutter interval */
    unsigned active_transforms; /* bit i: transform directives apply to ctm[i] */
    bool reverse_orientation;
    uint material; /* index in the scene, MATERIAL_INTERFACE, or NONE: pbrt's default */
    const char *material_name; /* of NamedMaterial, resolved when a shape uses it; NULL: `material` is valid */
    SourcePlace material_place;
    const AreaLightSource *area_light;
    uint inside, outside; /* media of MediumInterface: index in the scene */
    const ParamSet *attributes[ATTRIBUTE_COUNT];
} GraphicsState;

typedef struct StateSave {
    GraphicsState state;
    SourcePlace place;
    const char *opened_by; /* "AttributeBegin", ... */
} StateSave;

/* A medium's name in a scene file. MediumInterface may mention a medium that is defined later. */
typedef struct MediumSeen {
    const char *name;
    SourcePlace place; /* of the first mention */
    bool defined;
} MediumSeen;

/* A named texture: a postfix program without its TEXTURE_END. */
typedef struct ImportTexture {
    TextureOp *ops;
    uint count;
    uint program; /* index in the scene once used, else NONE */
} ImportTexture;

/* A material that is used before it is defined, and one whose definition names what is not defined yet
 * (pbrt/late.h). */
typedef struct LateUse {
    const char *name;
    SourcePlace place; /* of its first use */
    uint material; /* index in the scene */
    bool defined;
} LateUse;

typedef struct LateMaterial {
    const char *kind, *owner;
    SourcePlace place, kind_place;
    const ParamSet *params, *attributes;
    uint material; /* index in the scene */
} LateMaterial;

/* Radiance of an area light, or the power that determines it. */
typedef struct AreaEmission {
    float radiance[3]; /* at unit power if by_power */
    bool by_power; /* the radiance of each primitive is divided by pi area (2 pi area if two-sided) */
    uint flags; /* LIGHT_TWO_SIDED */
} AreaEmission;

/* An emissive shape of an object definition: every instance adds a copy of it to the world. */
typedef struct EmissiveShape {
    uint kind; /* PRIMITIVE_* */
    MeshData mesh; /* copies in the arena, in the definition's space */
    Quadric quadric;
    Matrix matrix; /* for a quadric */
    Shape shape;
    AreaEmission emission;
    SourcePlace place;
    struct EmissiveShape *next;
} EmissiveShape;

typedef struct ImportObject {
    uint object; /* index in the scene */
    bool empty; /* has only emissive shapes */
    EmissiveShape *emissive, *last_emissive; /* in file order */
    Box box; /* bounds of the shapes that do not emit */
} ImportObject;

/* An open file, or the text given to pbrt_import_text. */
typedef struct SourceFile {
    Lexer lexer;
    bool is_file; /* false for a text in memory */
    dev_t device;
    ino_t inode;
    bool is_import; /* has a scope of its own */
    size_t nesting; /* number of open AttributeBegin at its start */
} SourceFile;

/* Errors so far (pbrt/errors.h). */
typedef struct ImportErrors {
    Error latest; /* not printed yet */
    int count;
    bool definition_failed; /* a later error may be a consequence */
    bool missing; /* the current error is about something missing */
    bool other_version; /* the scene is pbrt-v3's: reading ends */
    bool world_order; /* a directive was on the wrong side of WorldBegin; reported once */
} ImportErrors;

typedef struct PbrtImport {
    Scene *scene;
    ImportOptions options;
    Error *error;
    ImportErrors errors;
    Vec3 offset; /* subtracted from world positions before they are rounded (scene/center.h); 0 on the first reading */
    Box world; /* bounds of the world's shapes, after subtracting the offset */
    Arena arena; /* names, textures, area lights; lives until the import ends */
    const char *directory;

    /* tokens */
    SourceFile files[IMPORT_INCLUDE_MAX];
    int file_count;
    unsigned files_opened;
    Token pending; /* put back by parser_put_back */
    bool has_pending;
    ParamBuffer params; /* of the current directive */
    SourcePlace place; /* of the current directive */

    /* graphics state */
    GraphicsState state;
    Array saved; /* StateSave */
    bool in_world;
    bool warned_transform_begin;
    NameTable coordinate_systems; /* index into coordinate_matrices */
    Array coordinate_matrices; /* Matrix[2] */
    NameTable objects; /* index into object_definitions */
    Array object_definitions; /* ImportObject */
    int open_object; /* index into object_definitions, -1 outside a definition */
    size_t object_first_primitive;
    size_t copied_vertices; /* by instances of emissive objects */

    /* named things */
    NameTable materials; /* index in the scene, or MATERIAL_INTERFACE */
    NameTable late_names; /* index into late_uses */
    Array late_uses; /* LateUse */
    Array late_materials; /* LateMaterial */
    NameTable float_textures, spectrum_textures; /* index into textures */
    Array textures; /* ImportTexture */
    NameTable media; /* index into the scene's media, also of those that are only mentioned so far */
    Array media_seen; /* MediumSeen of each, beginning with number 1 */
    TextureCache images;
    uint default_material; /* NONE until first used */

    /* film and camera, until WorldBegin */
    float iso;
    Vec3 balance; /* white balance: factors of red, green and blue */
    float exposure_time; /* of the film; 0: the camera's shutter time */
    float shutter_open, shutter_close;
} PbrtImport;

/* Path of a file named in the scene: unchanged if absolute, else relative to the scene's folder. NULL when out of
 * memory. */
const char *import_path(PbrtImport *im, const char *name);

/* Sets up the parameter list of the current directive: its own parameters, then the attributes of `target` (-1:
 * none). */
void import_list(PbrtImport *im, ParamList *list, const char *owner, int target);

#endif
