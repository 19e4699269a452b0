#include "mmlt/test_combination_estimators.h"

#include "math/rng.h"

void estimators_init(Estimators *estimators)
{
    const int crop[4] = {0, 0, SIDE, SIDE};
    Error error = {0};
    *estimators = (Estimators){0};
    for (int s = 0; s < ESTIMATOR_COUNT; ++s) {
        ck_assert(film_init(&estimators->films[s], SIDE, SIDE, crop, &error));
        ck_assert(film_light_reserve(&estimators->films[s], &error));
    }
    ck_assert(film_rare_reserve(&estimators->films[ESTIMATOR_CHAINS], &error));
    ck_assert(film_rare_reserve(&estimators->films[ESTIMATOR_PATHS], &error));
    ck_assert(combination_init(&estimators->combination, &estimators->films[0], &error));
}

void estimators_destroy(Estimators *estimators)
{
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        film_destroy(&estimators->films[s]);
    combination_destroy(&estimators->combination);
}

double noise(Estimators *estimators)
{
    Random4 random = random_four(estimators->draws++, 1, 2, 3, 4, 5);
    return (((double)random.x[0] + 0.5) / 4294967296.0 - 0.5) * sqrt(12.0);
}

void estimator_set(Estimators *estimators, int s, double samples, double mean, double deviation)
{
    Film *film = &estimators->films[s];
    film_clear(film);
    film->light_samples = (uint64_t)(samples * (double)PIXELS);
    for (size_t i = 0; i < PIXELS; ++i) {
        double value = mean + deviation * noise(estimators) / sqrt(samples);
        for (size_t c = 0; c < 3; ++c)
            film->light_sums[3 * i + c] = llrint(value * samples * 0x1p30);
    }
}

void rare_set(Estimators *estimators, size_t pixel, double by_chains, double by_paths)
{
    Film *chains = &estimators->films[ESTIMATOR_CHAINS], *paths = &estimators->films[ESTIMATOR_PATHS];
    for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
        chains->rare_sums[i] = llrint(4.0 * by_chains * 0x1p30);
        paths->rare_sums[i] = llrint(2.0 * by_paths * 0x1p30);
        paths->light_sums[i] += paths->rare_sums[i];
    }
}

void films_combine(Combination *learner, Combination *teacher, Film *const films[ESTIMATOR_COUNT])
{
    CombinedImage image;
    Error error = {0};
    double samples[ESTIMATOR_COUNT];
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        samples[s] = films[s] ? (double)films[s]->light_samples : 0.0;
    ck_assert(combined_image_init(&image, films[ESTIMATOR_CHAINS], &error));
    combined_image_begin(&image, learner, teacher, samples);
    for (int s = ESTIMATOR_COUNT - 1; s >= 0; --s)
        if (films[s])
            combined_image_add(&image, (EstimatorKind)s, films[s]);
    combined_image_finish(&image, films[ESTIMATOR_CHAINS]);
    combination_variances_update(learner, teacher);
    combined_image_destroy(&image);
}

double generation(Estimators *estimators)
{
    Film *films[ESTIMATOR_COUNT];
    for (int s = 0; s < ESTIMATOR_COUNT; ++s)
        films[s] = &estimators->films[s];
    double sum = 0.0;
    films_combine(&estimators->combination, &estimators->combination, films);
    for (size_t i = 0; i < 3 * PIXELS; ++i)
        sum += (double)films[ESTIMATOR_CHAINS]->light_sums[i];
    return sum * 0x1p-30 / 3.0 / (double)films[ESTIMATOR_CHAINS]->light_samples;
}
