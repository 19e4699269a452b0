#include "render/film_pilot.h"

#include "backend/step_recorder.h"
#include "film/pixel_order.h"
#include "layout/state.h"
#include "math/vec.h"

#include <math.h>
#include <pthread.h>
#include <string.h>

#define PILOT_ITEMS 4096u

/* An order-independent sum of non-negative floats: 24-bit mantissas summed per exponent. */
#define FLOAT_EXPONENTS 255u

typedef struct Pilot {
    pthread_mutex_t mutex;
    uint64_t mantissas[FLOAT_EXPONENTS];
} Pilot;

static void pilot_add(Pilot *pilot, float value)
{
    uint bits = float_bits(value), exponent = bits >> 23 & 0xffu, mantissa = bits & 0x7fffffu;
    if (exponent < FLOAT_EXPONENTS) /* neither infinite nor NaN */
        pilot->mantissas[exponent] += exponent > 0 ? mantissa | 0x800000u : mantissa;
}

static double pilot_sum(const Pilot *pilot)
{
    double sum = 0.0;
    for (uint exponent = 0; exponent < FLOAT_EXPONENTS; ++exponent)
        sum += ldexp((double)pilot->mantissas[exponent], (exponent > 0 ? (int)exponent : 1) - 150);
    return sum;
}

static void pilot_splats(void *context, const uint *splats, uint count, uint stride)
{
    Pilot *pilot = context;
    pthread_mutex_lock(&pilot->mutex);
    for (uint t = 0; t < count; ++t)
        if (state_load(splats, stride, SPLAT_PIXEL, t) != NONE)
            pilot_add(pilot, rgb_luminance(state_load_vec3(splats, stride, SPLAT_COLOR, t)));
    pthread_mutex_unlock(&pilot->mutex);
}

/* An integrator that renders the same picture in independent samples. */
static const Integrator *pilot_integrator(const Integrator *integrator)
{
    return integrator->list ? integrator : integrator_bdpt();
}

FrameParams pilot_frame(const RenderRun *run, const Integrator *integrator, uint items)
{
    FrameParams frame = run->frame;
    frame.path.strategies = integrator->strategies;
    frame.path.only_s = frame.path.only_t = NONE;
    frame.path.unweighted = 0;
    frame.film.crop_x0 = frame.film.crop_y0 = 0;
    frame.film.crop_x1 = frame.film.width;
    frame.film.crop_y1 = frame.film.height;
    frame.pass.first_item = 0;
    frame.pass.item_count = items;
    frame.pass.sample_index = PILOT_SAMPLE;
    frame.pass.pixel_stride = pixel_order_stride(frame.film.width, frame.film.height);
    return frame;
}

bool pilot_run(const RenderRun *run, const Integrator *integrator, FrameParams *frame, const SplatSink *sink,
               Error *error)
{
    StepList list;
    if (!integrator->list(frame, &list, error))
        return false;
    list.guide = run->guide;
    list.photons = frame->photons.count > 0 ? &run->photons : NULL;
    bool done = run->interface->run(run->backend, frame, &list, sink, render_run_stop(run), NULL, error);
    step_list_destroy(&list);
    return done;
}

/* Mean radiance if the lights' flux were spread over the scene's bounding sphere and left it evenly in all
 * directions. */
static double radiance_of_power(const Scene *scene)
{
    double radius = scene->frame.scene.world_radius > 0.0f ? (double)scene->frame.scene.world_radius : 1.0;
    return scene->light_power / (4.0 * M_PI * radius * radius) / M_PI;
}

bool film_pilot_run(const RenderRun *run, const Integrator *integrator, const Scene *scene, Error *error)
{
    const Integrator *shown = pilot_integrator(integrator);
    FrameParams frame = pilot_frame(run, shown, PILOT_ITEMS);
    Pilot pilot;
    memset(pilot.mantissas, 0, sizeof pilot.mantissas);
    pthread_mutex_init(&pilot.mutex, NULL);
    const SplatSink sink = {.splats = pilot_splats, .context = &pilot, .whole = true};
    bool done = pilot_run(run, shown, &frame, &sink, error);
    pthread_mutex_destroy(&pilot.mutex);
    double mean = pilot_sum(&pilot) / PILOT_ITEMS;
    film_quantum_set(run->film, mean > 0.0 ? mean : radiance_of_power(scene));
    return done;
}
