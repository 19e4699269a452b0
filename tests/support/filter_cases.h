/* The pixel filters under test, and a fixture with one. */
#ifndef TWINLIGHT_TESTS_SUPPORT_FILTER_CASES_H
#define TWINLIGHT_TESTS_SUPPORT_FILTER_CASES_H

#include "scene/filter_setup.h"
#include "support/light_fixture.h"

typedef struct FilterCase {
    const char *name;
    FilterSettings settings;
} FilterCase;

enum { FILTER_BOX, FILTER_GAUSSIAN = 3, FILTER_MITCHELL = 5, FILTER_SINC = 7, FILTER_CASE_COUNT };

static const FilterCase FILTER_CASES[FILTER_CASE_COUNT] = {
    [FILTER_BOX] = {"box", {.kind = PIXEL_FILTER_BOX, .radius_x = 0.5f, .radius_y = 0.5f}},
    {"other box", {.kind = PIXEL_FILTER_BOX, .radius_x = 1.3f, .radius_y = 0.3f}},
    {"triangle", {.kind = PIXEL_FILTER_TRIANGLE, .radius_x = 2.0f, .radius_y = 1.0f}},
    [FILTER_GAUSSIAN] = {"gaussian",
                         {.kind = PIXEL_FILTER_GAUSSIAN, .radius_x = 1.5f, .radius_y = 1.5f, .sigma = 0.5f}},
    {"narrow gaussian", {.kind = PIXEL_FILTER_GAUSSIAN, .radius_x = 1.0f, .radius_y = 3.0f, .sigma = 0.25f}},
    [FILTER_MITCHELL] =
        {"mitchell",
         {.kind = PIXEL_FILTER_MITCHELL, .radius_x = 2.0f, .radius_y = 2.0f, .b = 1.0f / 3.0f, .c = 1.0f / 3.0f}},
    {"sharp mitchell", {.kind = PIXEL_FILTER_MITCHELL, .radius_x = 2.0f, .radius_y = 3.0f, .b = 0.0f, .c = 0.75f}},
    [FILTER_SINC] = {"sinc", {.kind = PIXEL_FILTER_SINC, .radius_x = 4.0f, .radius_y = 4.0f, .tau = 3.0f}},
};

/* The caller destroys it by fixture_destroy. */
static inline void fixture_init_filter(LightFixture *f, const FilterSettings *settings)
{
    Error error = {0};
    fixture_init(f);
    ck_assert_msg(filter_setup(settings, &f->scene.lookup, &f->scene.frame.film.filter, &error), "%s", error.message);
    f->view = (SceneView){.frame = &f->scene.frame, .lookup = f->scene.lookup.data};
}

#endif
