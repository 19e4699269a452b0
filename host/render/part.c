#include "render/part.h"

#include "render/shard.h"

#include <math.h>
#include <string.h>

#define LAYERS_KNOWN ((1u << LAYER_COUNT) - 1u)

/* ---- the head ---------------------------------------------------------------------------------------------------- */

void part_head_film(PartHead *head, const Film *film, const RenderLayers *layers)
{
    PartPicture *picture = &head->picture;
    picture->width = film->width;
    picture->height = film->height;
    memcpy(picture->crop, film->crop, sizeof picture->crop);
    picture->quantum_exponent = film->quantum_exponent;
    picture->reconstruction = film->reconstruction;
    picture->light = film->light_sums != NULL;
    picture->depth_last = film->depth_sums ? film->depth_last : 0;
    picture->layers = layers ? layers->wanted : 0;
}

static void picture_archive(Archive *archive, PartPicture *picture)
{
    ARCHIVE_FIELD(archive, picture->width);
    ARCHIVE_FIELD(archive, picture->height);
    ARCHIVE_FIELD(archive, picture->crop);
    ARCHIVE_FIELD(archive, picture->quantum_exponent);
    ARCHIVE_FIELD(archive, picture->reconstruction);
    ARCHIVE_FIELD(archive, picture->light);
    ARCHIVE_FIELD(archive, picture->depth_last);
    ARCHIVE_FIELD(archive, picture->layers);
    ARCHIVE_FIELD(archive, picture->max_depth);
    ARCHIVE_FIELD(archive, picture->seed);
    ARCHIVE_FIELD(archive, picture->scale);
    ARCHIVE_FIELD(archive, picture->world_to_camera);
    ARCHIVE_FIELD(archive, picture->world_to_ndc);
    ARCHIVE_FIELD(archive, picture->scene);
    ARCHIVE_FIELD(archive, picture->integrator);
}

static void head_archive(Archive *archive, PartHead *head)
{
    ARCHIVE_FIELD(archive, head->shard.number);
    ARCHIVE_FIELD(archive, head->shard.count);
    ARCHIVE_FIELD(archive, head->wanted);
    render_totals_archive(archive, &head->totals);
    picture_archive(archive, &head->picture);
}

/* Whether the head is one that part_write can have written, as far as memory and loops depend on it. */
static bool head_sound(const PartHead *head)
{
    const PartPicture *picture = &head->picture;
    return head->shard.count >= 1 && head->shard.count <= SHARDS_MOST && head->shard.number >= 1 &&
           head->shard.number <= head->shard.count && picture->quantum_exponent >= -2048 &&
           picture->quantum_exponent <= 2048 && picture->reconstruction <= RECONSTRUCTION_SPLAT &&
           picture->light <= 1 && picture->depth_last <= SPLAT_DEPTH_MAX &&
           (picture->depth_last == 0 || picture->light == 1) && (picture->layers & ~LAYERS_KNOWN) == 0 &&
           picture->max_depth >= 1 && isfinite(picture->scale);
}

/* Restores a head. Other versions may have other heads, which therefore are not read. */
static bool head_read(ArchiveReader *reader, const char *path, PartHead *head, Error *error)
{
    Archive *archive = &reader->archive;
    bool other;
    *head = (PartHead){.picture = {.scale = 0.0f}};
    archive_head(archive, "part", &other);
    ARCHIVE_FIELD(archive, head->identity);
    head->identity.text[sizeof head->identity.text - 1] = '\0';
    if (!archive->failed && !identity_of_this_version(&head->identity, path, error))
        return false;
    head_archive(archive, head);
    if (!archive->failed && !head_sound(head))
        archive_fail(archive, "it is damaged in spite of its checksum");
    head->picture.scene[sizeof head->picture.scene - 1] = '\0';
    head->picture.integrator[sizeof head->picture.integrator - 1] = '\0';
    text_make_printable(head->picture.scene);
    text_make_printable(head->picture.integrator);
    if (!archive->failed)
        return true;
    error_set(error, "%s cannot be merged: %s", path, error_text(&archive->error));
    return error_fix(error, other ? "give files that twinlight render --shard has written" : "render this shard again");
}

/* ---- files ------------------------------------------------------------------------------------------------------- */

static void image_archive(Archive *archive, Film *film, RenderLayers *layers)
{
    film_archive(archive, film);
    if (layers && layers->wanted != 0)
        render_layers_archive(archive, layers);
}

bool part_write(const char *path, PartHead *head, Film *film, RenderLayers *layers, int threads, Error *error)
{
    ArchiveWriter writer;
    bool other, good = archive_writer_begin(&writer, path, threads, error);
    if (good) {
        archive_head(&writer.archive, "part", &other);
        ARCHIVE_FIELD(&writer.archive, head->identity);
        head_archive(&writer.archive, head);
        image_archive(&writer.archive, film, layers);
    }
    good = good && archive_writer_finish(&writer, error) && output_file_commit(&writer.file, error);
    archive_writer_destroy(&writer);
    return good;
}

bool part_open(ArchiveReader *reader, const char *path, PartHead *head, Error *error)
{
    Error opening = {0};
    if (!archive_reader_open(reader, path, &opening)) {
        error_set(error, "%s cannot be merged: %s", path, error_text(&opening));
        return error_fix(error, "%s",
                         opening.fix[0] ? opening.fix
                                        : "give whole files that twinlight render --shard has written; render a "
                                          "damaged one again");
    }
    if (head_read(reader, path, head, error))
        return true;
    archive_reader_close(reader);
    return false;
}

bool part_film_init(const PartHead *head, int threads, Film *film, RenderLayers *layers, Error *error)
{
    const PartPicture *picture = &head->picture;
    if (!film_init(film, picture->width, picture->height, picture->crop, error))
        return false;
    film->quantum_exponent = picture->quantum_exponent;
    film->reconstruction = picture->reconstruction;
    film->threads = threads;
    return (picture->light == 0 || film_light_reserve(film, error)) &&
           (picture->depth_last == 0 || film_depths_reserve(film, picture->depth_last, error)) &&
           render_layers_init(layers, picture->layers, false, film, error);
}

bool part_read(ArchiveReader *reader, const char *path, Film *film, RenderLayers *layers, Error *error)
{
    image_archive(&reader->archive, film, layers);
    if (archive_reader_finish(reader, error))
        return true;
    Error first = *error;
    error_set(error, "%s cannot be merged: %s", path, error_text(&first));
    return error_fix(error, "render this shard again");
}
