/* Every array of the scene, with a double where the host has a float. The numbers are the host's, so that builds with
 * and without --enable-double differ in their arithmetic and nothing else. */
#ifndef TWINLIGHT_DOUBLE
#define TWINLIGHT_DOUBLE
#endif
#include "kernel_scene.h"

#include "layout/scene_view.h"
#include "layout/struct_members.h"

#include <stdlib.h>

/* ---- the members of every struct --------------------------------------------------------------------------------- */

/* What a member is made of: floats, words that stay words, or a struct. */
enum {
    MEMBER_FLOATS,
    MEMBER_WORDS,
#define STRUCT(type) STRUCT_##type,
#define MEMBER(type, member)
    STRUCT_MEMBERS(STRUCT, MEMBER)
#undef STRUCT
#undef MEMBER
};

#define MEMBER_KIND(value)                                                                                             \
    _Generic((value),                                                                                                  \
        float: MEMBER_FLOATS,                                                                                          \
        float *: MEMBER_FLOATS,                                                                                        \
        uint: MEMBER_WORDS,                                                                                            \
        uint *: MEMBER_WORDS,                                                                                          \
        int: MEMBER_WORDS,                                                                                             \
        Vec3: STRUCT_Vec3,                                                                                             \
        Vec3 *: STRUCT_Vec3,                                                                                           \
        Affine: STRUCT_Affine,                                                                                         \
        Frame: STRUCT_Frame,                                                                                           \
        ColorParam: STRUCT_ColorParam,                                                                                 \
        FloatParam: STRUCT_FloatParam,                                                                                 \
        Camera: STRUCT_Camera,                                                                                         \
        PixelFilter: STRUCT_PixelFilter,                                                                               \
        SceneLayout: STRUCT_SceneLayout,                                                                               \
        SceneParams: STRUCT_SceneParams,                                                                               \
        FilmParams: STRUCT_FilmParams,                                                                                 \
        PathParams: STRUCT_PathParams,                                                                                 \
        PhotonParams: STRUCT_PhotonParams,                                                                                 \
        Opening *: STRUCT_Opening,                                                                                     \
        OpeningParams: STRUCT_OpeningParams,                                                                           \
        PartitionParams: STRUCT_PartitionParams,                                                                       \
        PoolParams: STRUCT_PoolParams,                                                                                 \
        ChainParams: STRUCT_ChainParams,                                                                               \
        PassParams: STRUCT_PassParams)

typedef struct Member {
    int owner, kind; /* -1: the entry begins the struct `owner` */
    size_t offset, size;
} Member;

static const Member MEMBERS[] = {
#define STRUCT(type) {STRUCT_##type, -1, 0, sizeof(type)},
#define MEMBER(type, member)                                                                                           \
    {STRUCT_##type, MEMBER_KIND(((type *)0)->member), offsetof(type, member), sizeof(((type *)0)->member)},
    STRUCT_MEMBERS(STRUCT, MEMBER)
#undef STRUCT
#undef MEMBER
};
#define MEMBER_COUNT (sizeof MEMBERS / sizeof MEMBERS[0])

static const Member *struct_begin(int type)
{
    const Member *member = MEMBERS;
    while (member->owner != type || member->kind != -1)
        ++member;
    return member;
}

/* How many numbers, words or structs a member holds. */
static size_t member_count(const Member *member)
{
    if (member->kind > MEMBER_WORDS)
        return member->size / struct_begin(member->kind)->size;
    return member->size / (member->kind == MEMBER_FLOATS ? sizeof(float) : sizeof(uint));
}

/* Words of the host's struct. Structs hold structs three deep. */
static size_t struct_words(int type) // NOLINT(misc-no-recursion)
{
    size_t words = 0;
    for (const Member *m = struct_begin(type) + 1; m < MEMBERS + MEMBER_COUNT && m->kind != -1; ++m)
        words += member_count(m) * (m->kind > MEMBER_WORDS ? struct_words(m->kind) : 1);
    return words;
}

/* Fills the kernels' struct from the words of the host's. */
static void struct_widen(int type, const uint *words, char *out) // NOLINT(misc-no-recursion)
{
    for (const Member *m = struct_begin(type) + 1; m < MEMBERS + MEMBER_COUNT && m->kind != -1; ++m) {
        char *to = out + m->offset;
        size_t step = m->kind > MEMBER_WORDS ? struct_words(m->kind) : 1;
        for (size_t i = 0; i < member_count(m); ++i, words += step) {
            if (m->kind > MEMBER_WORDS)
                struct_widen(m->kind, words, to + i * struct_begin(m->kind)->size);
            else if (m->kind == MEMBER_FLOATS)
                ((float *)(void *)to)[i] = bits_float(*words);
            else
                ((uint *)(void *)to)[i] = *words;
        }
    }
}

/* ---- arrays ------------------------------------------------------------------------------------------------------ */

typedef struct WideArray {
    int type; /* STRUCT_*, MEMBER_FLOATS or MEMBER_WORDS */
    uint from; /* first word of the host's array */
    uint *first; /* where the first word of the kernels' array goes */
} WideArray;

static size_t element_words(int type)
{
    return type <= MEMBER_WORDS ? 1 : struct_words(type);
}

static size_t element_bytes(int type)
{
    return type == MEMBER_FLOATS ? sizeof(float) : type == MEMBER_WORDS ? sizeof(uint) : struct_begin(type)->size;
}

/* Upper bound of the elements of array i: up to where the next one begins. */
static size_t array_count(const WideArray *arrays, size_t i, size_t count, size_t words)
{
    size_t end = i + 1 < count ? arrays[i + 1].from : words;
    return (end - arrays[i].from) / element_words(arrays[i].type);
}

static void array_widen(const WideArray *array, size_t count, const uint *words, char *out)
{
    size_t step = element_words(array->type), bytes = element_bytes(array->type);
    for (size_t i = 0; i < count; ++i) {
        const uint *from = words + array->from + i * step;
        if (array->type == MEMBER_FLOATS)
            ((float *)(void *)out)[i] = bits_float(*from);
        else if (array->type == MEMBER_WORDS)
            ((uint *)(void *)out)[i] = *from;
        else
            struct_widen(array->type, from, out + i * bytes);
    }
}

/* A buffer with all arrays, each at a multiple of 16 bytes. */
static uint *arrays_widen(const WideArray *arrays, size_t count, const uint *words, size_t word_count,
                          size_t *out_words, Error *error)
{
    size_t bytes = 64;
    for (size_t i = 0; i < count; ++i) {
        *arrays[i].first = (uint)(bytes / sizeof(uint));
        bytes += (array_count(arrays, i, count, word_count) * element_bytes(arrays[i].type) + 15) / 16 * 16;
    }
    char *out = aligned_alloc(64, (bytes + 63) / 64 * 64);
    if (!out) {
        error_memory(error, bytes, "a scene of doubles");
        return NULL;
    }
    for (size_t i = 0; i < count; ++i)
        array_widen(&arrays[i], array_count(arrays, i, count, word_count), words,
                    out + *arrays[i].first * sizeof(uint));
    *out_words = bytes / sizeof(uint);
    return (uint *)(void *)out;
}

/* ---- the scene --------------------------------------------------------------------------------------------------- */

struct KernelScene {
    BackendScene view;
    FrameParams frame;
    uint *geometry, *tables;
};

/* The host's layout: the first member of its frame, made of words in both formats. */
static SceneLayout layout_of(const void *frame)
{
    return *(const SceneLayout *)frame;
}

static bool scene_widen(KernelScene *out, const BackendScene *scene, Error *error)
{
    const SceneLayout from = layout_of(scene->frame);
    SceneLayout *to = &out->frame.scene.layout;
    const WideArray geometry[] = {{STRUCT_Vec3, from.positions, &to->positions},
                                  {STRUCT_Vec3, from.normals, &to->normals},
                                  {STRUCT_Vec2, from.uvs, &to->uvs},
                                  {STRUCT_Primitive, from.primitives, &to->primitives},
                                  {STRUCT_Curve, from.curves, &to->curves},
                                  {STRUCT_Shape, from.shapes, &to->shapes},
                                  {STRUCT_Patch, from.patches, &to->patches},
                                  {STRUCT_Quadric, from.quadrics, &to->quadrics},
                                  {STRUCT_Object, from.objects, &to->objects},
                                  {STRUCT_Instance, from.instances, &to->instances}};
    const WideArray tables[] = {{STRUCT_Material, from.materials, &to->materials},
                                {STRUCT_TextureOp, from.texture_ops, &to->texture_ops},
                                {STRUCT_TextureImage, from.images, &to->images},
                                {STRUCT_Light, from.lights, &to->lights},
                                {STRUCT_LightDetail, from.light_details, &to->light_details},
                                {STRUCT_AliasBucket, from.light_alias, &to->light_alias},
                                {STRUCT_LightTree, from.light_tree, &to->light_tree},
                                {STRUCT_LightNode, from.light_nodes, &to->light_nodes},
                                {MEMBER_WORDS, from.light_leaves, &to->light_leaves},
                                {MEMBER_WORDS, from.infinite_lights, &to->infinite_lights},
                                {STRUCT_Portal, from.portals, &to->portals},
                                {STRUCT_Aim, from.aims, &to->aims},
                                {STRUCT_Distribution2D, from.distributions2d, &to->distributions2d},
                                {MEMBER_FLOATS, from.lookup, &to->lookup},
                                {STRUCT_Medium, from.media, &to->media},
                                {STRUCT_MediumGrid, from.grids, &to->grids}};
    struct_widen(STRUCT_FrameParams, (const uint *)(const void *)scene->frame, (char *)&out->frame);
    out->geometry = arrays_widen(geometry, sizeof geometry / sizeof *geometry, scene->geometry, scene->geometry_words,
                                 &out->view.geometry_words, error);
    out->tables = arrays_widen(tables, sizeof tables / sizeof *tables, scene->tables, scene->tables_words,
                               &out->view.tables_words, error);
    out->view.frame = &out->frame;
    out->view.geometry = out->geometry;
    out->view.tables = out->tables;
    return out->geometry && out->tables;
}

KernelScene *kernel_scene_create(const BackendScene *scene, Error *error)
{
    KernelScene *out = calloc(1, sizeof *out);
    if (!out) {
        error_memory(error, sizeof *out, "the CPU backend");
        return NULL;
    }
    out->view = *scene;
    if (scene_widen(out, scene, error))
        return out;
    kernel_scene_destroy(out);
    return NULL;
}

void kernel_scene_destroy(KernelScene *scene)
{
    if (!scene)
        return;
    free(scene->geometry);
    free(scene->tables);
    free(scene);
}

const BackendScene *kernel_scene_view(const KernelScene *scene)
{
    return &scene->view;
}

size_t kernel_frame_bytes(void)
{
    return sizeof(FrameParams);
}

void *kernel_frame(const KernelScene *scene, FrameParams *frame, void *storage)
{
    FrameParams *out = storage;
    struct_widen(STRUCT_FrameParams, (const uint *)(const void *)frame, storage);
    out->scene.layout = scene->frame.scene.layout;
    return out;
}

size_t kernel_guide_bytes(void)
{
    return sizeof(Guide);
}

void *kernel_guide(const Guide *guide, void *storage)
{
    if (guide)
        struct_widen(STRUCT_Guide, (const uint *)(const void *)guide, storage);
    return storage;
}

uint *kernel_state_create(size_t words)
{
    /* Untouched pages of the block are never allocated, and those that are touched start with zeros. */
    return words * sizeof(uint) <= STATE_BLOCK / 4 ? aligned_alloc(STATE_BLOCK, STATE_BLOCK) : NULL;
}
