/* What the parts of the pbrt importer share while a file is read. */
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

/* Limits that keep hostile files from exhausting memory or stack; no scene met so far comes near them. */
#define IMPORT_NESTING_MAX 65536 /* AttributeBegin and ObjectBegin */
#define IMPORT_INCLUDE_MAX 64 /* Include and Import inside each other */
#define IMPORT_FILES_MAX 65536 /* Include and Import in all */
#define IMPORT_FILE_BYTES_MAX 0x7ffffffe /* of one file: lines and columns are ints */
#define IMPORT_ATTRIBUTES_MAX                                                                                          \
    1024 /* parameters of Attribute directives in force at once: every directive looks at all */
#define IMPORT_COORDINATE_SYSTEMS_MAX 65536
#define IMPORT_LIGHTS_MAX (1u << 24) /* area lights by instances of emissive objects */
#define IMPORT_COPIES_MAX (1u << 26) /* vertices of these instances, of which each has its own */
#define IMPORT_DEPTH_MAX 65536 /* maxdepth, clamped */
#define IMPORT_COORDINATE_MAX 1e12 /* of a point in world space: products of three must fit a float */
#define IMPORT_ERRORS_MAX 20 /* of a scene, shown in one run */
#define IMPORT_FILM_MAX 65535 /* pixels of a film's side */

/* Instead of an index of a material. */
#define MATERIAL_INTERFACE 0xfffffffeu /* no material: the shape is invisible */

/* Targets of the Attribute directive. */
enum { ATTRIBUTE_SHAPE, ATTRIBUTE_LIGHT, ATTRIBUTE_MATERIAL, ATTRIBUTE_MEDIUM, ATTRIBUTE_TEXTURE, ATTRIBUTE_COUNT };

/* An AreaLightSource directive. */
typedef struct AreaLightSource {
    const char *kind;
    SourcePlace place;
    const ParamSet *params; /* its own */
    const ParamSet *attributes; /* of Attribute "light" */
} AreaLightSource;

/* What AttributeBegin saves. Pointers lead into the importer's arena. */
typedef struct GraphicsState {
    Matrix ctm[2]; /* at the start and the end of the shutter's time */
    unsigned active_transforms; /* bit i: ctm[i] takes part in transform directives */
    bool reverse_orientation;
    uint material; /* of the scene, MATERIAL_INTERFACE, or NONE: pbrt's default */
    const char *material_name; /* of NamedMaterial, looked up when a shape uses it; NULL: `material` holds */
    SourcePlace material_place;
    const AreaLightSource *area_light;
    const ParamSet *attributes[ATTRIBUTE_COUNT];
} GraphicsState;

typedef struct StateSave {
    GraphicsState state;
    SourcePlace place;
    const char *opened_by; /* "AttributeBegin", ... */
} StateSave;

/* A named texture: a postfix program without its TEXTURE_END. */
typedef struct ImportTexture {
    TextureOp *ops;
    uint count;
    uint program; /* in the scene once used, else NONE */
} ImportTexture;

/* Radiance of an area light, or the power that gives it. */
typedef struct AreaEmission {
    float radiance[3]; /* at unit power when by_power */
    bool by_power; /* radiance of each primitive is divided by pi area (2 pi area when two-sided) */
    uint flags; /* LIGHT_TWO_SIDED */
} AreaEmission;

/* A shape of an object definition that emits light: it joins the world at every instance. */
typedef struct EmissiveShape {
    uint kind; /* PRIMITIVE_* */
    MeshData mesh; /* copies in the arena, in the space of the definition */
    Quadric quadric;
    Matrix matrix; /* of a quadric */
    Shape shape;
    AreaEmission emission;
    SourcePlace place;
    struct EmissiveShape *next;
} EmissiveShape;

typedef struct ImportObject {
    uint object; /* of the scene */
    bool empty; /* nothing but emissive shapes */
    EmissiveShape *emissive, *last_emissive; /* in the order of the file */
    Box box; /* of the others */
} ImportObject;

/* A file being read, or the text that pbrt_import_text was given. */
typedef struct SourceFile {
    Lexer lexer;
    bool is_file; /* and not text in memory */
    dev_t device;
    ino_t inode;
    bool is_import; /* ends a scope of its own */
    size_t nesting; /* open AttributeBegin when it began */
} SourceFile;

/* What has gone wrong so far (pbrt/errors.h). */
typedef struct ImportErrors {
    Error latest; /* not printed yet */
    int count;
    bool definition_failed; /* so that what is missing may be a consequence */
    bool missing; /* the error on its way is about something that is missing */
    bool world_order; /* a directive stood on the wrong side of WorldBegin: said once */
} ImportErrors;

typedef struct PbrtImport {
    Scene *scene;
    ImportOptions options;
    Error *error;
    ImportErrors errors;
    Vec3 offset; /* taken off all places in the world before they are rounded (scene/center.h); first 0 */
    Box world; /* of all shapes there, less the offset */
    Arena arena; /* names, textures, area lights: until the import ends */
    const char *directory;

    /* tokens */
    SourceFile files[IMPORT_INCLUDE_MAX];
    int file_count;
    unsigned files_opened;
    Token pending; /* put back */
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
    int open_object; /* index into object_definitions, -1 outside */
    size_t object_first_primitive;
    size_t copied_vertices; /* by instances of emissive objects */

    /* named things */
    NameTable materials; /* scene's material or MATERIAL_INTERFACE */
    NameTable float_textures, spectrum_textures; /* index into textures */
    Array textures; /* ImportTexture */
    TextureCache images;
    uint default_material; /* NONE until used */

    /* film and camera, until WorldBegin */
    float iso;
    float exposure_time; /* of the film, 0: the camera's shutter */
    float shutter_open, shutter_close;
} PbrtImport;

/* A file name of the scene as a path: as it is when absolute, else inside the scene's directory. NULL on no memory. */
const char *import_path(PbrtImport *im, const char *name);

/* The list of the current directive: its parameters, then the attributes of `target` (-1: none). */
void import_list(PbrtImport *im, ParamList *list, const char *owner, int target);

#endif
