#include "scene/coat_medium.h"

#include "bsdf/coat.h"
#include "bsdf/phase.h"
#include "math/rng.h"

#define WALKS 32768u
#define STEPS_MAX 4096u /* of one walk, */
#define STEPS_ALL (1u << 22) /* and of all: a fraction of a second */
#define WEIGHT_MIN 1e-4f
#define WALK_STRIDE 20219u /* odd: in its order, the first walks have all cosines, too */
#define WALK_KEY 1u

/* Largest component of a mix's diffuse reflectance, unless the layers need more: what is left of 1 keeps `amount`
 * small, so that light that is not scattered keeps its dependence on direction. */
#define REFLECTANCE_AIM 0.8f

/* A photon between interface and conductor. */
typedef struct Walk {
    Vec3 w; /* where it goes; z is up, towards the interface */
    float depth;
    Vec3 weight;
    bool scattered;
} Walk;

/* Walk number n of WALKS, whose cosines outside are stratified for diffuse light. False where nothing enters. */
static bool walk_start(const CoatLayers *layers, uint n, Walk *walk)
{
    float cosine = float_sqrt(((float)n + 0.5f) / (float)WALKS), cos_t = refraction_cosine(cosine, layers->eta);
    if (!(cos_t > 0.0f))
        return false;
    *walk = (Walk){.w = vec3(float_sqrt(float_max((1.0f - cos_t) * (1.0f + cos_t), 0.0f)), 0.0f, -cos_t),
                   .weight = vec3_splat(1.0f - fresnel_from_cosines(cosine, cos_t, layers->eta))};
    return true;
}

/* Goes to the next collision, at a distance drawn with the first of `u`; returns the light that leaves there. */
static Vec3 walk_step(const CoatLayers *layers, Random4 u, Walk *walk)
{
    float depth = walk->depth + float_log(random_float(u.x[0])) * walk->w.z;
    Vec3 leaves = vec3_splat(0.0f);
    if (depth > 0.0f && depth < layers->thickness) {
        Frame frame = frame_from_normal(vec3_negate(walk->w));
        Vec2 across = vec2(random_float(u.x[1]), random_float(u.x[2]));
        walk->depth = depth;
        walk->scattered = true;
        walk->weight = vec3_mul(walk->weight, layers->albedo);
        walk->w = frame_to_world(frame, phase_sample(layers->g, across).wi);
        return leaves;
    }
    if (walk->w.z < 0.0f) {
        Vec3 f = fresnel_conductor_rgb(-walk->w.z, layers->metal_eta, layers->metal_k);
        walk->depth = layers->thickness;
        walk->weight = vec3_mul(walk->weight, f);
    } else {
        float r = fresnel_dielectric(float_min(walk->w.z, 1.0f), 1.0f / layers->eta);
        walk->depth = 0.0f;
        leaves = vec3_scale(walk->weight, 1.0f - r);
        walk->weight = vec3_scale(walk->weight, r);
    }
    walk->w.z = -walk->w.z;
    return leaves;
}

/* Adds what walk number n lets out after scattering; returns how many steps it took. */
static uint walk_add(const CoatLayers *layers, uint n, Vec3 *sum)
{
    Walk walk;
    uint step = 0;
    bool goes = walk_start(layers, n, &walk);
    for (; goes && step < STEPS_MAX; ++step) {
        Vec3 leaves = walk_step(layers, random_four(n, step, 0, 0, WALK_KEY, 0), &walk);
        if (walk.scattered)
            *sum = vec3_add(*sum, leaves);
        goes = vec3_max_component(walk.weight) > WEIGHT_MIN;
    }
    return step;
}

Vec3 coat_medium_scattered(const CoatLayers *layers)
{
    Vec3 sum = vec3_splat(0.0f);
    uint walks = 0, steps = 0;
    for (; walks < WALKS && steps < STEPS_ALL; ++walks)
        steps += walk_add(layers, walks * WALK_STRIDE % WALKS, &sum);
    return vec3_scale(sum, 1.0f / (float)walks);
}

/* Albedo, in diffuse light, of what a smooth coat without absorption lets out of a diffuse base; and its inverse. */
static float base_albedo(float eta, float reflectance)
{
    float escape = coat_smooth_escape(eta), mean = escape * eta * eta;
    return mean * escape * reflectance / (1.0f - reflectance * (1.0f - escape));
}

static float base_reflectance(float eta, float albedo)
{
    float escape = coat_smooth_escape(eta), mean = escape * eta * eta;
    return float_clamp(albedo / (albedo * (1.0f - escape) + mean * escape), 0.0f, 1.0f);
}

CoatMix coat_medium_mix(const CoatLayers *layers)
{
    CoatMix mix = {.thickness = layers->thickness};
    Vec3 scattered = coat_medium_scattered(layers);
    float most = vec3_max_component(scattered), cosine = refraction_cosine(float_sqrt(0.5f), layers->eta);
    cosine = cosine > 0.0f ? cosine : 1.0f;
    float interacting = 1.0f - float_exp(-2.0f * layers->thickness / cosine);
    if (!(most > 0.0f && interacting > 0.0f))
        return mix;
    mix.amount = float_min(most / base_albedo(layers->eta, REFLECTANCE_AIM), interacting);
    mix.reflectance = vec3(base_reflectance(layers->eta, scattered.x / mix.amount),
                           base_reflectance(layers->eta, scattered.y / mix.amount),
                           base_reflectance(layers->eta, scattered.z / mix.amount));
    if (mix.amount < 1.0f)
        mix.thickness += 0.5f * cosine * float_log(1.0f - mix.amount);
    mix.thickness = float_max(mix.thickness, 0.0f);
    return mix;
}
