#include "backend/film_sink.h"

static void film_splats(void *context, const uint *splats, uint count, uint stride)
{
    film_add_splats(context, splats, count, stride);
}

static void film_sums(void *context, ulong *words)
{
    film_add_sums(context, words);
}

SplatSink film_sink(Film *film)
{
    return (SplatSink){.splats = film_splats, .sums = film_sums, .sum_words = film_sum_words(film), .context = film};
}
