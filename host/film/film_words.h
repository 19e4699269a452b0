/* A film whose sums lie in one buffer of words, as a device's do (film_words in camera/film_sum.h), so that they can be
 * sent elsewhere and added to a film there (film_add_sums). */
#ifndef TWINLIGHT_FILM_FILM_WORDS_H
#define TWINLIGHT_FILM_FILM_WORDS_H

#include "film/film.h"

/* A buffer of `count` words has two kinds of words: sums, which saturate (film_words_add), and between them plain
 * counters, words[plain] ... words[plain_end - 1], which are added as numbers of 64 bits. */
typedef struct FilmWords {
    Film film; /* its arrays are in the buffer: never to be destroyed */
    ulong *words;
    size_t count, plain, plain_end;
} FilmWords;

/* `words` are zero, and borrowed. The film is that of the passes that `frame` describes; `count` is film_sum_words of
 * the film to which the words will be added. lookup: the scene's. */
void film_words_begin(FilmWords *film, const FrameParams *frame, const float *lookup, ulong *words, size_t count);

/* Completes the words once all splats have been added. */
void film_words_end(FilmWords *film);

#endif
