/* Objects and their instances against the same shapes written out, and the side on which shapes emit under mirroring
 * transforms. */
#include "support/analytic.h"

#define STAGE                                                                                                          \
    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 24\n"                                             \
    "LookAt 0 -9 5  0 0 1  0 0 1\nCamera \"perspective\" \"float fov\" 45\nWorldBegin\n"                               \
    "LightSource \"infinite\" \"rgb L\" [ .3 .4 .5 ]\nLightSource \"point\" \"rgb I\" [ 30 30 20 ] "                   \
    "\"point3 from\" [ -3 -4 6 ]\n"                                                                                    \
    "Material \"diffuse\" \"rgb reflectance\" [ .6 .6 .6 ] Shape \"disk\" \"float radius\" 20\n"

/* Every kind of shape, with normals and texture coordinates, a bump map, and materials that distinguish inside and
 * outside. */
#define THINGS                                                                                                         \
    "Texture \"squares\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [ .8 .2 .1 ] \"rgb tex2\" [ .1 .3 .8 ] "           \
    "\"float uscale\" 6 \"float vscale\" 4\n"
#define QUADRICS                                                                                                       \
    "AttributeBegin Material \"diffuse\" \"texture reflectance\" \"squares\" Translate 0 0 1 "                         \
    "Shape \"sphere\" \"float radius\" .8 \"float phimax\" 300 AttributeEnd\n"                                         \
    "AttributeBegin Material \"dielectric\" \"float eta\" 1.4 Translate 1.3 .2 .7 Rotate 30 1 0 1 Scale 1 .6 1 "       \
    "Shape \"sphere\" \"float radius\" .5 AttributeEnd\n"                                                              \
    "AttributeBegin Material \"conductor\" \"float uroughness\" .3 \"float vroughness\" .02 \"bool remaproughness\" "  \
    "false Translate -1.2 0 .3 Rotate 60 1 0 0 Shape \"disk\" \"float radius\" .6 AttributeEnd\n"
#define MESHES                                                                                                         \
    "AttributeBegin Material \"coateddiffuse\" \"texture reflectance\" \"squares\"\n"                                  \
    "Shape \"trianglemesh\" \"point3 P\" [ -1 -1 .1  1 -1 .1  .9 -.2 .9  -.8 -.3 1.1 ] "                               \
    "\"normal N\" [ 0 -1 .3  .3 -1 .2  0 -1 .6  -.2 -1 .4 ] \"point2 uv\" [ 0 0 1 0 1 1 0 1 ] "                        \
    "\"integer indices\" [ 0 1 2 0 2 3 ] AttributeEnd\n"                                                               \
    "AttributeBegin ReverseOrientation Material \"diffusetransmission\"\n"                                             \
    "Shape \"bilinearmesh\" \"point3 P\" [ -1 .8 0  1 1 0  -.9 .9 2  1.1 .7 1.7 ] AttributeEnd\n"
#define OBJECT QUADRICS MESHES

/* The same random numbers make the same rays up to rounding. */
static void compare(const char *name, const char *placed, const char *flat)
{
    RenderedImage images[2];
    for (int i = 0; i < 2; ++i)
        analytic_picture(&images[i], 64, 6, STAGE "%s", i ? flat : placed);
    double difference =
        fixture_block_difference((PictureView){images[0].rgb, 32, 24}, (PictureView){images[1].rgb, 32, 24}, 8);
    analytic_check(name, fixture_mean(&images[0]), fixture_mean(&images[1]), ANALYTIC_TOLERANCE);
    fprintf(stderr, "    blocks differ by %.3f %%\n", 100.0 * difference);
    ck_assert_double_le(difference, 0.01);
    fixture_destroy(&images[0]);
    fixture_destroy(&images[1]);
}

/* As in pbrt, a mirroring transform turns a sphere or disk inside out if it applies to the definition, while an
 * instance only transforms normals: the shapes written out need ReverseOrientation to be equal. */
static const struct {
    const char *name, *place;
    bool mirrors;
} PLACES[] = {
    {"instance, moved and turned", "Translate 1 0 0.3 Rotate 40 0 0 1", false},
    {"instance, scaled", "Translate 0 0 0.2 Scale 1.5 1.5 1.5", false},
    {"instance, mirrored", "Rotate 25 0 0 1 Scale -1 1 1", true},
    {"instance, stretched and mirrored", "Rotate -35 0 0 1 Scale 1.3 -0.8 0.9 Rotate 20 1 0 0", true},
};

START_TEST(test_instance)
{
    char placed[6000], flat[6000];
    const char *place = PLACES[_i].place, *turn = PLACES[_i].mirrors ? "ReverseOrientation" : "";
    snprintf(placed, sizeof placed,
             THINGS "ObjectBegin \"o\"\n" OBJECT "ObjectEnd\nAttributeBegin %s\n"
                    "ObjectInstance \"o\" AttributeEnd",
             place);
    snprintf(flat, sizeof flat, THINGS "AttributeBegin %s %s\n" QUADRICS "%s\n" MESHES "AttributeEnd", place, turn,
             turn);
    compare(PLACES[_i].name, placed, flat);
}
END_TEST

/* A transform inside the definition and ReverseOrientation around it count as well. */
START_TEST(test_definition_state)
{
    char placed[6000], flat[6000];
    snprintf(placed, sizeof placed,
             THINGS "AttributeBegin Translate 0 0 0.4 Scale 0.8 -0.8 0.8 ReverseOrientation\nObjectBegin \"o\"\n" OBJECT
                    "ObjectEnd AttributeEnd\nAttributeBegin Rotate 30 0 0 1 ObjectInstance \"o\" AttributeEnd\n"
                    "AttributeBegin Translate -2.5 1 0 Scale .5 .5 .5 ObjectInstance \"o\" AttributeEnd");
    snprintf(flat, sizeof flat,
             THINGS "AttributeBegin Rotate 30 0 0 1 Translate 0 0 0.4 Scale 0.8 -0.8 0.8 ReverseOrientation\n" OBJECT
                    "AttributeEnd\nAttributeBegin Translate -2.5 1 0 Scale .5 .5 .5 Translate 0 0 0.4 "
                    "Scale 0.8 -0.8 0.8 ReverseOrientation\n" OBJECT "AttributeEnd");
    compare("two instances of a mirrored, reversed definition", placed, flat);
}
END_TEST

/* ---- sides ------------------------------------------------------------------------------------------------------- */

/* Each shape faces +z in its own space (the sphere outward). */
static const struct {
    const char *name, *shape;
} SHAPES[] = {
    {"disk", "Shape \"disk\""},
    {"triangle", "Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0  1 -1 0  0 1 0 ]"},
    {"patch", "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0  1 -1 0  -1 1 0  1 1 0 ]"},
    {"triangle with N",
     "Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0  1 -1 0  0 1 0 ] \"normal N\" [ 0 0 1 0 0 1 0 0 1 ]"},
    {"triangle with N against it",
     "Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0  1 -1 0  0 1 0 ] \"normal N\" [ 0 0 -1 0 0 -1 0 0 -1 ]"},
    {"half sphere", "Shape \"sphere\" \"float zmin\" 0"},
};
#define SHAPE_KINDS ((int)(sizeof SHAPES / sizeof *SHAPES))

/* Which side emits; +z is up before and after the transform. Rules of pbrt's ray intersections: ReverseOrientation
 * flips every shape. A mirroring transform does not flip a mesh; it flips a sphere or disk if it applies to the
 * definition, but not if it applies to the instance. With N, the side is that of N. */
START_TEST(test_sides)
{
    bool against = strstr(SHAPES[_i].name, "against") != NULL;
    bool quadric = strstr(SHAPES[_i].shape, "disk") != NULL || strstr(SHAPES[_i].shape, "sphere") != NULL;
    for (int reversed = 0; reversed < 2; ++reversed)
        for (int mirrored = 0; mirrored < 2; ++mirrored)
            for (int instance = 0; instance < 2; ++instance)
                for (int below = 0; below < 2; ++below) {
                    bool turned = ((reversed + mirrored * (quadric && !instance)) % 2 != 0) != against;
                    bool shines = (below != 0) == turned;
                    double got = analytic_mean(
                        16, 1,
                        ANALYTIC_FILM
                        "LookAt 0.1 0.2 %d  0.1 0.2 0  0 1 0\nCamera \"perspective\" \"float fov\" 1\n"
                        "WorldBegin LightSource \"point\"\n%s%s\nAttributeBegin AreaLightSource \"diffuse\" %s "
                        "%s\nAttributeEnd\n%s%s",
                        below ? -5 : 5, instance ? "ObjectBegin \"o\"\n" : "",
                        mirrored && !instance ? "Scale -1 1 1" : "", reversed ? "ReverseOrientation" : "",
                        SHAPES[_i].shape, instance ? "ObjectEnd " : "",
                        instance ? mirrored ? "Scale -1 1 1 ObjectInstance \"o\"" : "ObjectInstance \"o\"" : "");
                    ck_assert_msg(fabs(got - (shines ? 1.0 : 0.0)) < 1e-6, "%s%s%s%s seen from %s: radiance %g",
                                  SHAPES[_i].name, reversed ? ", reversed" : "", mirrored ? ", mirrored" : "",
                                  instance ? ", instance" : "", below ? "below" : "above", got);
                }
}
END_TEST

/* Mirrored lamps illuminate from the side that is seen to emit: the plane receives irradiance from the side facing
 * it. */
START_TEST(test_light_of_mirrored)
{
    static const struct {
        const char *name, *lamp;
        double irradiance;
    } LAMPS[] = {
        {"mirrored disk that shines down", "Translate 0 0 1 Scale -1 1 1 Shape \"disk\" \"float radius\" 0.5", 0.2},
        {"mirrored disk that shines up",
         "Translate 0 0 1 Scale -1 1 1 ReverseOrientation Shape \"disk\" \"float radius\" 0.5", 0.0},
        {"mirrored sphere, turned back",
         "Translate 0 0 1 Scale 1 1 -1 ReverseOrientation Shape \"sphere\" \"float radius\" .5", 0.25},
        {"mirrored sphere that shines inwards", "Translate 0 0 1 Scale 1 1 -1 Shape \"sphere\" \"float radius\" .5",
         0.0},
    };
    for (int i = 0; i < 4; ++i) {
        double got = analytic_mean(
            4096, 2, ANALYTIC_LOOK_AT_ORIGIN ANALYTIC_DIFFUSE_PLANE "AreaLightSource \"diffuse\" %s", LAMPS[i].lamp);
        analytic_check(LAMPS[i].name, got, 0.5 * LAMPS[i].irradiance, ANALYTIC_TOLERANCE);
    }
}
END_TEST

/* An object's lamp emits in every instance with its own radiance, whatever the instance's size. */
START_TEST(test_lamps_of_instances)
{
    double got =
        analytic_mean(4096, 2,
                      ANALYTIC_LOOK_AT_ORIGIN ANALYTIC_DIFFUSE_PLANE
                      "ObjectBegin \"lamp\" AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ 2 2 2 ] Rotate "
                      "180 1 0 0 Shape \"disk\" \"float radius\" 0.5 AttributeEnd ObjectEnd\n"
                      "AttributeBegin Translate 0 0 1 Scale -1 1 1 ObjectInstance \"lamp\" AttributeEnd\n"
                      "AttributeBegin Translate 0 0 4 Scale 4 4 4 ObjectInstance \"lamp\" AttributeEnd\n");
    /* The second has radius 2 at height 4: the first, of radius 0.5 at height 1, hides it exactly. */
    analytic_check("instances of a lamp, one behind the other", got, 2.0 * 0.25 / 1.25 * 0.5, ANALYTIC_TOLERANCE);
}
END_TEST

TCase *analytic_instances_case(void)
{
    TCase *tcase = tcase_create("instances");
    tcase_set_timeout(tcase, 120);
    tcase_add_loop_test(tcase, test_instance, 0, (int)(sizeof PLACES / sizeof *PLACES));
    tcase_add_test(tcase, test_definition_state);
    tcase_add_loop_test(tcase, test_sides, 0, SHAPE_KINDS);
    tcase_add_test(tcase, test_light_of_mirrored);
    tcase_add_test(tcase, test_lamps_of_instances);
    return tcase;
}
