/* Ends a rendering when its estimated error is small enough (--error).
 *
 * The error is estimated from the picture's halves at looks, each after at least ERROR_LOOK_GROWTH times the work of
 * the one before: so the number of looks is small, and looks depend on the work alone, not on the clock. The goal is
 * reached at the first look at which the estimate and one standard error of it are below the goal. That margin is what
 * corrects for repeated looks: the first of several estimates that is low enough is too low on average, by less than
 * their standard error, since the noise of one look is mostly that of the look before. */
#ifndef TWINLIGHT_RENDER_ERROR_WATCH_H
#define TWINLIGHT_RENDER_ERROR_WATCH_H

#include "render/run.h"

#define ERROR_LOOK_GROWTH 1.15

/* Samples per pixel at the first look; even. */
#define ERROR_LOOK_FIRST 4u

/* Saves the latest estimate, or restores it. */
void error_watch_archive(Archive *archive, ErrorWatch *watch);

/* Whether a look is due after run->done paths. */
bool error_watch_due(const RenderRun *run);

/* Looks: estimates the error of the layers' halves, which must have the same amount of work. */
bool error_watch_look(RenderRun *run, Error *error);

/* Whether the latest look was below the goal. */
bool error_watch_reached(const RenderRun *run);

/* The work, as run->done counts it, after which the next look should be: where the goal will be reached if the square
 * of the error falls with the work, but not before a look is due; infinite before the first look and without a goal. */
double error_watch_target(const RenderRun *run);

/* The number of samples per pixel at the look after that at `samples`, or the first one, for integrators whose work is
 * in whole samples: an even number. */
uint64_t error_watch_next(uint64_t samples);

#endif
