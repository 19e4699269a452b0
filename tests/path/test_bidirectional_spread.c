/* Splats that are spread over pixels carry where they are on the film: the edge of a lamp has the same profile as if
 * each went to a pixel drawn by the filter. Spread around the centers of pixels, the edge would be wider. */
#include "support/bidirectional.h"

#include "mmlt/combination.h"

#include <math.h>

#define FILM                                                                                                           \
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6\nPixelFilter \"gaussian\" \"float xradius\" "    \
    "1.5 "                                                                                                             \
    "\"float yradius\" 2 \"float sigma\" 0.6\n"
#define EDGE_FILM                                                                                                      \
    FILM "LookAt 0 0 -6  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [ -4 4 -3 3 ]\nWorldBegin\n"

/* A lamp that begins in the middle of a pixel column and a third into a row, behind `panes`. */
#define EDGE(panes)                                                                                                    \
    EDGE_FILM panes "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ 2 2 2 ] \"bool twosided\" true\n"          \
                    "Shape \"bilinearmesh\" \"point3 P\" [ -9 -9 0  0.5 -9 0  -9 0.33 0  0.5 0.33 0 ] AttributeEnd\n"
#define PANE(z) "Shape \"bilinearmesh\" \"point3 P\" [ -9 -9 " z "  9 -9 " z "  -9 9 " z "  9 9 " z " ]\n"
#define PANES "Material \"thindielectric\" \"float eta\" 1.02\n" PANE("-1") PANE("-2") "Material \"diffuse\"\n"

/* A sheet in the sun, whose light is traced to a lens. */
#define SHEET                                                                                                          \
    FILM "LookAt 0 0 -40  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 9\nWorldBegin\n"                          \
         "LightSource \"distant\" \"point3 from\" [ 0 0 -1 ] \"point3 to\" [ 0 0 0 ] \"rgb L\" [ 2 2 2 ]\n"            \
         "Material \"diffuse\"\n"                                                                                      \
         "Shape \"bilinearmesh\" \"point3 P\" [ -5 -5 0  0.5 -5 0  -5 0.33 0  0.5 0.33 0 ]\n"

/* Inside a ball with a lamp beside the camera: everything is lit, also what the film's borders have in common. */
#define INSIDE(parameters)                                                                                             \
    FILM "Rotate 40 1 2 3 Camera \"spherical\" " parameters "\nWorldBegin\n"                                           \
         "LightSource \"point\" \"point3 from\" [ 0.2 0.1 -0.3 ] \"rgb I\" [ 2 2 2 ]\n"                                \
         "Material \"diffuse\"\nShape \"sphere\"\n"

typedef struct EdgeCase {
    const char *name, *text;
    const Integrator *(*integrator)(void);
    int depth;
    unsigned samples;
    int shown; /* of mmlt */
    bool from_light;
    double most; /* difference that noise explains, relative to the lit part */
} EdgeCase;

static const EdgeCase EDGES[] = {
    {"path tracing", EDGE(""), integrator_pt, 1, 1024, 0, false, 0.004},
    {"bidirectional", EDGE(""), integrator_bdpt, 1, 1024, 0, false, 0.004},
    {"three strategies", EDGE(""), integrator_ibpt, 1, 1024, 0, false, 0.004},
    {"light tracing", SHEET, integrator_bdpt, 2, 4096, 0, true, 0.004},
    {"light tracing, equal-area", INSIDE(""), integrator_bdpt, 2, 16384, 0, true, 0.008},
    {"light tracing, equirectangular", INSIDE("\"string mapping\" \"equirectangular\""), integrator_bdpt, 2, 16384, 0,
     true, 0.008},
    {"mmlt's path tracing", EDGE(PANES), integrator_mmlt, 3, 8192, 1 + ESTIMATOR_PATHS, false, 0.004},
    {"pools", EDGE(PANES), integrator_mmlt, 3, 65536, 1 + ESTIMATOR_POOL, false, 0.02},
};

START_TEST(test_edges)
{
    const EdgeCase *edge = &EDGES[_i];
    RenderedImage expected, got;
    RenderSetup setup = {.text = edge->text, .samples = 4096, .max_depth = edge->depth};
    double square = 0.0, largest = 0.0;
    fixture_render(&setup, &expected);
    setup.integrator = edge->integrator();
    setup.samples = edge->samples;
    setup.reconstruction = RECONSTRUCTION_SPLAT;
    setup.chains.shown = edge->shown;
    setup.only_strategy = setup.unweighted = edge->from_light;
    setup.strategy[0] = 2;
    setup.strategy[1] = 1;
    fixture_render(&setup, &got);
    const int pixels = got.width * got.height;
    for (int i = 0; i < 3 * pixels; ++i) {
        double difference = (double)got.rgb[i] - (double)expected.rgb[i];
        square += difference * difference / (3.0 * pixels);
        largest = fmax(largest, (double)expected.rgb[i]);
    }
    printf("edge, %s: difference %.2g of the lit part\n", edge->name, sqrt(square) / largest);
    ck_assert_double_gt(largest, 0.0);
    ck_assert_msg(sqrt(square) < edge->most * largest, "%s: %g", edge->name, sqrt(square) / largest);
    fixture_destroy(&got);
    fixture_destroy(&expected);
}
END_TEST

/* A lamp that fills the view, seen through panes that reflect nothing: mmlt's path tracing shows it as indirect light,
 * of few samples, each pixel divided by those that lie near it. */
START_TEST(test_constant_indirect)
{
    static const char *const LAMP = EDGE_FILM "Material \"thindielectric\" \"float eta\" 1.0001\n" PANE("-1")
        PANE("-2") "Material \"diffuse\"\n"
                   "AreaLightSource \"diffuse\" \"rgb L\" [ 2 2 2 ] \"bool twosided\" true\n" PANE("0");
    RenderedImage image;
    const RenderSetup setup = {.text = LAMP,
                               .samples = 4,
                               .max_depth = 3,
                               .integrator = integrator_mmlt(),
                               .chains = {.shown = 1 + ESTIMATOR_PATHS},
                               .reconstruction = RECONSTRUCTION_SPLAT};
    fixture_render(&setup, &image);
    for (int i = 0; i < 3 * image.width * image.height; ++i)
        TEST_NEAR((double)image.rgb[i], 2.0, 1e-4);
    fixture_destroy(&image);
}
END_TEST

TCase *bidirectional_spread_case(void)
{
    TCase *tcase = tcase_create("spread");
    tcase_set_timeout(tcase, 120);
    tcase_add_loop_test(tcase, test_edges, 0, (int)(sizeof EDGES / sizeof *EDGES));
    tcase_add_test(tcase, test_constant_indirect);
    return tcase;
}
