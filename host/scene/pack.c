/* Packs a scene into three buffers, and presents them to a backend. */
#include "scene/pack.h"

#include <string.h>

/* Appends `array` to `words`, aligned to four words; *first: index of its first word. */
static bool words_append(Array *words, const Array *array, uint *first, Error *error)
{
    size_t bytes = array->count * array->element_size, start = (words->count + 3) / 4 * 4;
    size_t count = start - words->count + bytes / 4;
    if (start + bytes / 4 > SCENE_WORDS_MAX) {
        error_set(error, "the scene needs more than 16 GiB in one buffer");
        return error_fix(error, "use object instances or smaller textures");
    }
    uint *out = array_grow(words, count, error);
    if (!out)
        return false;
    *first = (uint)start;
    if (bytes > 0)
        memcpy((uint *)words->data + start, array->data, bytes);
    return true;
}

static bool tables_pack(Scene *scene, Error *error)
{
    SceneLayout *layout = &scene->frame.scene.layout;
    Array *words = &scene->tables_words;
    words->count = 0;
    return words_append(words, &scene->materials, &layout->materials, error) &&
           words_append(words, &scene->texture_ops, &layout->texture_ops, error) &&
           words_append(words, &scene->images, &layout->images, error) &&
           words_append(words, &scene->lights, &layout->lights, error) &&
           words_append(words, &scene->light_details, &layout->light_details, error) &&
           words_append(words, &scene->light_alias, &layout->light_alias, error) &&
           words_append(words, &scene->light_tree, &layout->light_tree, error) &&
           words_append(words, &scene->light_nodes, &layout->light_nodes, error) &&
           words_append(words, &scene->light_leaves, &layout->light_leaves, error) &&
           words_append(words, &scene->infinite_lights, &layout->infinite_lights, error) &&
           words_append(words, &scene->portals, &layout->portals, error) &&
           words_append(words, &scene->aims, &layout->aims, error) &&
           words_append(words, &scene->distributions2d, &layout->distributions2d, error) &&
           words_append(words, &scene->lookup, &layout->lookup, error) &&
           words_append(words, &scene->media, &layout->media, error) &&
           words_append(words, &scene->grids, &layout->grids, error);
}

size_t scene_geometry_words(const Scene *scene)
{
    const Array *const arrays[] = {&scene->positions, &scene->normals,  &scene->uvs,    &scene->primitives,
                                   &scene->shapes,    &scene->patches,  &scene->curves, &scene->quadrics,
                                   &scene->objects,   &scene->instances};
    size_t words = 64;
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; ++i)
        words += arrays[i]->count * arrays[i]->element_size / 4 + 4;
    return words;
}

/* Frees the unpacked vertex and primitive arrays on the way, so that a large scene is in memory only once. */
static bool geometry_pack(Scene *scene, Error *error)
{
    SceneLayout *layout = &scene->frame.scene.layout;
    struct {
        Array *array;
        uint *first;
    } parts[] = {{&scene->positions, &layout->positions},
                 {&scene->normals, &layout->normals},
                 {&scene->uvs, &layout->uvs},
                 {&scene->primitives, &layout->primitives},
                 {&scene->curves, &layout->curves},
                 {&scene->shapes, &layout->shapes},
                 {&scene->patches, &layout->patches},
                 {&scene->quadrics, &layout->quadrics},
                 {&scene->objects, &layout->objects},
                 {&scene->instances, &layout->instances}};
    if (!array_reserve(&scene->geometry_words, scene_geometry_words(scene), error))
        return false;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; ++i) {
        if (!words_append(&scene->geometry_words, parts[i].array, parts[i].first, error))
            return false;
        if (i < 5)
            array_destroy(parts[i].array);
    }
    return true;
}

bool scene_pack(Scene *scene, Error *error)
{
    return tables_pack(scene, error) && geometry_pack(scene, error);
}

BackendScene scene_backend_view(const Scene *scene)
{
    return (BackendScene){.frame = &scene->frame,
                          .geometry = scene->geometry_words.data,
                          .geometry_words = scene->geometry_words.count,
                          .tables = scene->tables_words.data,
                          .tables_words = scene->tables_words.count,
                          .texels = scene->texels.data,
                          .texel_words = scene->texels.count,
                          .primitive_count = scene->primitive_count,
                          .object_count = scene->objects.count,
                          .instance_count = scene->instances.count};
}

size_t scene_bytes(const Scene *scene)
{
    return 4 * (scene->geometry_words.count + scene->tables_words.count + scene->texels.count);
}
