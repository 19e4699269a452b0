/* A scattering medium in a coat over a conductor: what it scatters against exact sums, and the mix that stands for it
 * against simulation of the layers. */
#include "support/bsdf_cases.h"

#include "scene/coat_medium.h"

#define PHOTONS 60000

static CoatLayers layers_make(float thickness, float albedo, float g, float k)
{
    return (CoatLayers){.eta = 1.5f,
                        .thickness = thickness,
                        .g = g,
                        .albedo = vec3_splat(albedo),
                        .metal_eta = vec3_splat(0.3f),
                        .metal_k = vec3_splat(k)};
}

/* ---- what is scattered ------------------------------------------------------------------------------------------- */

/* E2 by the midpoint rule in the cosine. */
static double exponential_integral2(double depth)
{
    double sum = 0.0;
    for (int k = 0; k < 4000; ++k)
        sum += exp(-depth / ((k + 0.5) / 4000.0)) / 4000.0;
    return sum;
}

/* Without an interface and over black, a little albedo a scatters a times the integral of E2 squared once: E2 of
 * diffuse light gets to a depth, and of what is scattered there the same part leaves on both sides together. */
START_TEST(test_single_scattering)
{
    const float thicknesses[] = {0.1f, 0.5f, 3.0f};
    for (int n = 0; n < 3; ++n) {
        CoatLayers layers = layers_make(thicknesses[n], 0.01f, 0.0f, 0.0f);
        layers.eta = 1.0f;
        layers.metal_eta = vec3_splat(1.0f);
        double sum = 0.0, step = (double)thicknesses[n] / 200.0;
        for (int k = 0; k < 200; ++k)
            sum += pow(exponential_integral2((k + 0.5) * step), 2.0) * step;
        double scattered = (double)coat_medium_scattered(&layers).x;
        printf("# thickness %g: %.5f scattered, %.5f once\n", (double)thicknesses[n], scattered, 0.01 * sum);
        REQUIRE(fabs(scattered - 0.01 * sum) < 0.05 * 0.01 * sum);
    }
}
END_TEST

/* A thick white medium returns what the interface lets in, which is less than all, and none is made. */
START_TEST(test_energy)
{
    const double entering = 0.908; /* of diffuse light, for an index of 1.5: Walsh 1926 */
    CoatLayers thick = layers_make(12.0f, 1.0f, 0.0f, 1e4f), thin = layers_make(0.5f, 1.0f, 0.0f, 1e4f);
    double of_thick = (double)coat_medium_scattered(&thick).x, of_thin = (double)coat_medium_scattered(&thin).x;
    printf("# white: %.4f of a thick medium, %.4f of a thin one\n", of_thick, of_thin);
    REQUIRE(fabs(of_thick - entering) < 0.02 && of_thin < entering && of_thin > 0.5 * entering);
    CoatLayers black = layers_make(0.5f, 0.0f, 0.0f, 3.0f);
    REQUIRE(coat_medium_scattered(&black).x == 0.0f && coat_medium_mix(&black).amount == 0.0f);
}
END_TEST

/* All light that is scattered forwards goes on to the metal; backwards, less. */
START_TEST(test_asymmetry)
{
    CoatLayers forwards = layers_make(0.3f, 0.8f, 0.9f, 0.0f), backwards = layers_make(0.3f, 0.8f, -0.9f, 0.0f);
    forwards.metal_eta = backwards.metal_eta = vec3_splat(1.0f); /* black */
    double front = (double)coat_medium_scattered(&forwards).x, back = (double)coat_medium_scattered(&backwards).x;
    REQUIRE_MSG(back > 2.5 * front, "%g forwards, %g backwards", front, back);
}
END_TEST

/* Where walks are long, fewer are made: a deep white medium returns all that enters, whatever it takes. */
START_TEST(test_long_walks)
{
    CoatLayers layers = layers_make(1e30f, 1.0f, 0.9f, 1.0f);
    double scattered = (double)coat_medium_scattered(&layers).x;
    printf("# a deep white medium, g 0.9: %.4f\n", scattered);
    REQUIRE(scattered > 0.7 && scattered < 0.92);
}
END_TEST

/* ---- the mix ----------------------------------------------------------------------------------------------------- */

/* Its numbers are fractions, each channel has its own reflectance, and the same layers give the same mix. */
START_TEST(test_mix_numbers)
{
    TestRandom random = {41};
    for (int n = 0; n < (test_effort() == 1 ? 12 : 40); ++n) {
        CoatLayers layers = layers_make(random_float24(&random) * 3.0f, random_float24(&random),
                                        random_float24(&random) - 0.5f, random_float24(&random) * 9.0f);
        layers.eta = n % 4 ? 1.0f + random_float24(&random) : 0.6f;
        layers.albedo.y = 0.0f;
        CoatMix mix = coat_medium_mix(&layers), again = coat_medium_mix(&layers);
        REQUIRE(mix.amount == again.amount && mix.thickness == again.thickness &&
                mix.reflectance.x == again.reflectance.x);
        REQUIRE_MSG(
            mix.amount > 0.0f && mix.amount <= 1.0f && mix.thickness >= 0.0f && mix.thickness < layers.thickness,
            "amount %g, thickness %g of %g", (double)mix.amount, (double)mix.thickness, (double)layers.thickness);
        REQUIRE(mix.reflectance.x > 0.0f && mix.reflectance.x <= 1.0f && mix.reflectance.y == 0.0f);
    }
}
END_TEST

/* The weight that leaves, of one random walk through a dielectric interface, the medium and a conductor. */
static double layers_walk(const TestScene *scene, const Bsdf *coat, const Bsdf *base, const CoatLayers *layers, Vec3 wo,
                          TestRandom *random)
{
    Vec3 up = wo; /* points back to where the photon came from, at the interface */
    double weight = 1.0, depth = 0.0;
    BsdfSample sample;
    for (int n = 0; n < 2000; ++n) {
        float u_lobe = random_float24(random);
        if (!bsdf_sample(&scene->view, coat, up, u_lobe, random_vec2(random), TRANSPORT_IMPORTANCE, &sample))
            return 0.0;
        weight *= (double)sample.weight.x;
        if (sample.wi.z > 0.0f)
            return weight;
        Vec3 w = sample.wi;
        for (depth = 0.0; n < 2000; ++n) {
            depth += log(random_double(random)) * (double)w.z;
            if (w.z > 0.0f && depth <= 0.0)
                break;
            if (depth >= (double)layers->thickness) {
                depth = (double)layers->thickness;
                u_lobe = random_float24(random);
                if (!bsdf_sample(&scene->view, base, vec3_negate(w), u_lobe, random_vec2(random), TRANSPORT_IMPORTANCE,
                                 &sample))
                    return 0.0;
                weight *= (double)sample.weight.x;
                w = sample.wi;
            } else {
                weight *= (double)layers->albedo.x;
                w = random_direction(random, 2.0 * random_double(random) - 1.0);
            }
        }
        up = vec3_negate(w);
    }
    return 0.0;
}

static double albedo_of(const TestScene *scene, const Bsdf *bsdf, Vec3 wo, TestRandom *random)
{
    double sum = 0.0;
    for (int n = 0; n < PHOTONS; ++n) {
        BsdfSample sample;
        float u_lobe = random_float24(random);
        if (bsdf_sample(&scene->view, bsdf, wo, u_lobe, random_vec2(random), TRANSPORT_IMPORTANCE, &sample))
            sum += (double)sample.weight.x / PHOTONS;
    }
    return sum;
}

/* Alphas of coat and conductor, the medium, and how far the albedo of the mix is off. Bounds are what was measured,
 * rounded up. */
static const struct MixCase {
    float alpha, base, thickness, albedo, k, off;
} MIXES[] = {{0.0f, 0.1f, 0.2f, 0.5f, 4.0f, 0.035f}, {0.3f, 0.15f, 0.2f, 0.5f, 4.0f, 0.025f},
             {0.45f, 0.1f, 0.4f, 0.4f, 4.0f, 0.02f}, {0.1f, 0.1f, 1.0f, 0.1f, 1.5f, 0.005f},
             {0.1f, 0.1f, 3.0f, 0.8f, 4.0f, 0.012f}, {0.0f, 0.05f, 0.5f, 1.0f, 100.0f, 0.022f}};

START_TEST(test_mix_albedo)
{
    const struct MixCase *c = &MIXES[_i];
    const double degrees[] = {0.0, 45.0, 75.0};
    CoatLayers layers = layers_make(c->thickness, c->albedo, 0.0f, c->k);
    CoatMix mix = coat_medium_mix(&layers);
    TestScene scene;
    test_scene_init(&scene);
    TestRandom random = {42};
    Bsdf coat = test_bsdf(&scene, MATERIAL_DIELECTRIC, c->alpha, c->alpha, 1.5f, 0.0f, 0.0f);
    Bsdf metal = test_bsdf(&scene, MATERIAL_CONDUCTOR, c->base, c->base, 1.0f, 0.3f, c->k);
    Bsdf diffuse = test_bsdf(&scene, MATERIAL_COATED_DIFFUSE, c->alpha, c->alpha, 1.5f, mix.reflectance.x, 0.0f);
    Bsdf coated = {.kind = MATERIAL_COATED_CONDUCTOR, .eta = 1.5f, .alpha_x = c->alpha, .alpha_y = c->alpha};
    coated.color0 = layers.metal_eta;
    coated.color1 = layers.metal_k;
    coated.flags = bsdf_base_pack(c->base, c->base);
    bsdf_flags_set(&coated);
    test_record_make(&scene, &coated, mix.thickness);
    double worst = 0.0;
    for (int n = 0; n < 3; ++n) {
        Vec3 wo = test_direction(degrees[n], 0.0);
        double walked = 0.0, amount = (double)mix.amount;
        for (int k = 0; k < PHOTONS; ++k)
            walked += layers_walk(&scene, &coat, &metal, &layers, wo, &random) / PHOTONS;
        double mixed = amount * albedo_of(&scene, &diffuse, wo, &random) +
                       (1.0 - amount) * albedo_of(&scene, &coated, wo, &random);
        printf("# alphas %g and %g, thickness %g, albedo %g, k %g, %g degrees: mix %.4f, layers %.4f (amount %.3f)\n",
               (double)c->alpha, (double)c->base, (double)c->thickness, (double)c->albedo, (double)c->k, degrees[n],
               mixed, walked, amount);
        worst = fmax(worst, fabs(mixed - walked));
    }
    test_scene_destroy(&scene);
    REQUIRE_MSG(worst < (double)c->off, "albedo off by %g", worst);
}
END_TEST

TCase *bsdf_coat_medium_tests(void)
{
    TCase *tcase = tcase_create("coat medium");
    tcase_set_timeout(tcase, 120);
    tcase_add_test(tcase, test_single_scattering);
    tcase_add_test(tcase, test_energy);
    tcase_add_test(tcase, test_asymmetry);
    tcase_add_test(tcase, test_long_walks);
    tcase_add_test(tcase, test_mix_numbers);
    tcase_add_loop_test(tcase, test_mix_albedo, 0, (int)(sizeof MIXES / sizeof MIXES[0]));
    return tcase;
}
