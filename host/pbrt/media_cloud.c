/* pbrt's medium "cloud": a density of noise, whose values are taken once, on a grid. */
#include "base/log.h"
#include "base/parallel.h"
#include "base/processors.h"
#include "math/noise.h"
#include "pbrt/media.h"

#include <math.h>
#include <stdlib.h>

/* Samples per period of the noise's lowest octave, whose highest has 15.7 times its frequency. */
#define CLOUD_DETAIL 32.0

/* With fewer, the two highest octaves are lost. */
#define CLOUD_DETAIL_LEAST 16.0

/* Samples in all, which take 96 MB. */
#define CLOUD_SAMPLES_MAX ((double)(1 << 24))

typedef struct Cloud {
    float density, wispiness, frequency;
    float low[3], spacing[3];
    uint size[3]; /* samples */
    float *values;
} Cloud;

/* Differences of noise over 0.01, as in pbrt. */
static Vec3 noise_gradient_at(Vec3 p)
{
    const float step = 0.01f;
    float here = noise(p);
    return vec3((noise(vec3(p.x + step, p.y, p.z)) - here) / step, (noise(vec3(p.x, p.y + step, p.z)) - here) / step,
                (noise(vec3(p.x, p.y, p.z + step)) - here) / step);
}

/* pbrt's density at p of the medium's space: five octaves at a point that two octaves of gradients have moved, less
 * with height, and a layer below y = 1/2. */
static float cloud_density(const Cloud *cloud, Vec3 p)
{
    Vec3 at = vec3_scale(p, cloud->frequency);
    float weight = 0.05f * cloud->wispiness, frequency = 10.0f;
    for (int i = 0; i < 2 && cloud->wispiness > 0.0f; ++i) {
        at = vec3_mad(at, weight, noise_gradient_at(vec3_scale(at, frequency)));
        weight *= 0.5f;
        frequency *= NOISE_LACUNARITY;
    }
    float d = 0.5f * noise_fbm(at, 0.5f, 5u);
    d = fminf(fmaxf((1.0f - p.y) * 4.5f * cloud->density * d, 0.0f), 1.0f);
    return fminf(d + 2.0f * fmaxf(0.0f, 0.5f - p.y), 1.0f);
}

/* The samples of one z. */
static void cloud_layer(void *context, size_t z)
{
    const Cloud *cloud = context;
    float *out = cloud->values + z * cloud->size[0] * cloud->size[1];
    for (uint y = 0; y < cloud->size[1]; ++y)
        for (uint x = 0; x < cloud->size[0]; ++x)
            *out++ = cloud_density(cloud, vec3(cloud->low[0] + (float)x * cloud->spacing[0],
                                               cloud->low[1] + (float)y * cloud->spacing[1],
                                               cloud->low[2] + (float)z * cloud->spacing[2]));
}

static void cloud_sample(const void *context, const uint index[3], float *out)
{
    const Cloud *cloud = context;
    *out = cloud->values[((size_t)index[2] * cloud->size[1] + index[1]) * cloud->size[0] + index[0]];
}

/* How many cells the box is divided into, and the samples at their corners. */
static void cloud_divide(ParamList *list, const MediumBox *box, Cloud *cloud, GridSource *source)
{
    double per_unit = CLOUD_DETAIL * (double)fmaxf(cloud->frequency, 0.0f), most = 1.0, samples = 1.0;
    for (int i = 0; i < 3; ++i)
        samples *= fmax(1.0, per_unit * box->extent[i]);
    if (samples > CLOUD_SAMPLES_MAX)
        per_unit *= cbrt(CLOUD_SAMPLES_MAX / samples);
    for (int i = 0; i < 3; ++i) {
        double cells = fmin(fmax(4.0, ceil(per_unit * box->extent[i])), 2048.0);
        source->size[i] = (uint)cells;
        cloud->size[i] = source->size[i] + 1u;
        cloud->low[i] = (float)box->low[i];
        cloud->spacing[i] = (float)(box->extent[i] / cells);
        most = fmax(most, (double)(cloud->spacing[i] * cloud->frequency) * CLOUD_DETAIL_LEAST);
    }
    if (most > 1.0)
        log_message_at(LOG_WARNING, list->place, "%s has more detail than the %u x %u x %u samples of its grid",
                       list->owner, cloud->size[0], cloud->size[1], cloud->size[2]);
}

static bool cloud_bake(PbrtImport *im, ParamList *list, Cloud *cloud, GridSource *source, Medium *medium)
{
    size_t samples = (size_t)cloud->size[0] * cloud->size[1] * cloud->size[2];
    cloud->values = malloc(samples * sizeof *cloud->values);
    if (!cloud->values)
        return error_memory(im->error, samples * sizeof *cloud->values, "a cloud");
    parallel_run(cloud->size[2], processors_usable(), cloud_layer, cloud);
    bool good = medium_grid_add(im, list, source, medium);
    free(cloud->values);
    return good;
}

bool medium_cloud_read(PbrtImport *im, ParamList *list, Medium *medium)
{
    Cloud cloud = {.density = param_float(list, "density", 1.0f),
                   .wispiness = param_float(list, "wispiness", 1.0f),
                   .frequency = param_float(list, "frequency", 5.0f)};
    GridSource source = {.words = 1, .low = 1.0f, .ends = 1, .sample = cloud_sample, .context = &cloud};
    MediumBox box;
    Vec3 absorption;
    medium_coefficients_read(im, list, MEDIUM_ONES, medium, &absorption);
    if (list->failed || !medium_box_read(list, &box))
        return false;
    cloud_divide(list, &box, &cloud, &source);
    return medium_box_place(im, list, &box, &source) &&
           (im->options.needs || cloud_bake(im, list, &cloud, &source, medium));
}
