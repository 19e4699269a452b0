/* A film as the receiver of a pass's splats. */
#ifndef TWINLIGHT_BACKEND_FILM_SINK_H
#define TWINLIGHT_BACKEND_FILM_SINK_H

#include "backend/backend.h"
#include "film/film.h"

/* A sink that adds splats to the film. Passes that use it must set frame.film.exponent to the film's
 * quantum_exponent. */
SplatSink film_sink(Film *film);

#endif
