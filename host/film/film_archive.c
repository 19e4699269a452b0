#include "film/film.h"

#include "camera/film_sum.h"

static void sums_archive(Archive *archive, int64_t *sums, size_t values, const char *what)
{
    archive_same(archive, sums ? values : 0, what);
    if (sums)
        archive_bytes(archive, sums, values * sizeof *sums);
}

/* What a film must have in common with the saved one. */
static void frame_archive(Archive *archive, const Film *film)
{
    archive_same(archive, (uint64_t)film->width, "the film's width");
    archive_same(archive, (uint64_t)film->height, "the film's height");
    for (int i = 0; i < 4; ++i)
        archive_same(archive, (uint64_t)film->crop[i], "the film's crop");
    archive_same(archive, (uint64_t)(int64_t)film->quantum_exponent, "the film's quantum");
    archive_same(archive, film->reconstruction, "the film's reconstruction");
}

void film_archive(Archive *archive, Film *film)
{
    size_t values = 3 * film_pixels(film);
    frame_archive(archive, film);
    sums_archive(archive, film->sums, values, "the film's sums");
    sums_archive(archive, film->light_sums, values, "the film's sums of the light's paths");
    sums_archive(archive, film->rare_sums, values, "the film's sums of rare paths");
    size_t words = film_depth_words((uint)film_pixels(film), film->depth_kinds, film->depth_last);
    sums_archive(archive, film->depth_sums, film->depth_sums ? words : 0, "the film's sums by depth");
    archive_bytes(archive, film->counts, film_pixels(film) * sizeof *film->counts);
    ARCHIVE_FIELD(archive, film->every_count);
    ARCHIVE_FIELD(archive, film->light_samples);
    ARCHIVE_FIELD(archive, film->complete_samples);
    ARCHIVE_FIELD(archive, film->saturated);
    ARCHIVE_FIELD(archive, film->vanished);
    ARCHIVE_FIELD(archive, film->not_finite);
}
