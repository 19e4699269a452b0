/* What the parts of film.h have in common: a film as kernels see it, and its rows in parallel. */
#ifndef TWINLIGHT_FILM_FILM_ROWS_H
#define TWINLIGHT_FILM_FILM_ROWS_H

#include "base/parallel.h"
#include "camera/film_spread.h"
#include "film/film.h"

/* A film's view, also for reading a const film. */
FilmView film_view(const Film *film);

/* Calls part(context, row) for every row of pixels, several at a time in large films. */
void film_rows_run(const Film *film, ParallelPart *part, void *context);

#endif
