#include "ranks/scene_copy.h"

#include "ranks/communicator.h"

#include <stdlib.h>

/* What comes before the arrays. */
typedef struct SceneHead {
    FrameParams frame;
    uint64_t geometry_words, tables_words, texel_words;
    uint64_t primitive_count, object_count, instance_count;
} SceneHead;

static void words_send(Archive *broadcast, const uint *words, size_t count)
{
    /* An archive that saves only reads. */
    archive_bytes(broadcast, (void *)(uintptr_t)words, count * sizeof *words);
}

void scene_send(const BackendScene *scene)
{
    Archive broadcast = communicator_broadcast();
    SceneHead head = {.frame = *scene->frame,
                      .geometry_words = scene->geometry_words,
                      .tables_words = scene->tables_words,
                      .texel_words = scene->texel_words,
                      .primitive_count = scene->primitive_count,
                      .object_count = scene->object_count,
                      .instance_count = scene->instance_count};
    ARCHIVE_FIELD(&broadcast, head);
    words_send(&broadcast, scene->geometry, scene->geometry_words);
    words_send(&broadcast, scene->tables, scene->tables_words);
    words_send(&broadcast, scene->texels, scene->texel_words);
}

static bool words_receive(Archive *broadcast, uint **words, size_t count, Error *error)
{
    *words = malloc(count * sizeof **words + 1);
    if (!*words)
        return error_memory(error, count * sizeof **words, "the scene");
    archive_bytes(broadcast, *words, count * sizeof **words);
    return true;
}

bool scene_receive(SceneCopy *copy, Error *error)
{
    Archive broadcast = communicator_broadcast();
    SceneHead head;
    ARCHIVE_FIELD(&broadcast, head);
    *copy = (SceneCopy){.frame = head.frame};
    if (!words_receive(&broadcast, &copy->geometry, (size_t)head.geometry_words, error) ||
        !words_receive(&broadcast, &copy->tables, (size_t)head.tables_words, error) ||
        !words_receive(&broadcast, &copy->texels, (size_t)head.texel_words, error))
        return false;
    copy->scene = (BackendScene){.frame = &copy->frame,
                                 .geometry = copy->geometry,
                                 .geometry_words = (size_t)head.geometry_words,
                                 .tables = copy->tables,
                                 .tables_words = (size_t)head.tables_words,
                                 .texels = copy->texels,
                                 .texel_words = (size_t)head.texel_words,
                                 .primitive_count = (size_t)head.primitive_count,
                                 .object_count = (size_t)head.object_count,
                                 .instance_count = (size_t)head.instance_count};
    return true;
}

void scene_copy_destroy(SceneCopy *copy)
{
    free(copy->geometry);
    free(copy->tables);
    free(copy->texels);
    *copy = (SceneCopy){.geometry = NULL};
}
