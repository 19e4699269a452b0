/* Warnings about lights and cameras that are declared in other media than the surfaces around them leave there. */
#include "pbrt/test_import.h"
#include "scene/separations.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define MEDIA                                                                                                          \
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" MakeNamedMedium \"ink\" \"string type\" "                 \
    "\"homogeneous\"\n"
#define CAMERA "LookAt 0 0 -9  0 0 0  0 1 0 Camera \"perspective\"\n"
/* A sphere of fog of radius 2 at the origin, in empty space. */
#define BALL                                                                                                           \
    "AttributeBegin MediumInterface \"fog\" \"\" Material \"interface\" Shape \"sphere\" \"float radius\" 2 "          \
    "AttributeEnd\n"
#define POINT "LightSource \"point\"\n"

static void scene_load(const char *text, Scene *scene)
{
    char name[64];
    Error error = {"", ""};
    snprintf(name, sizeof name, "places.%ld.tmp.pbrt", (long)getpid());
    FILE *file = fopen(name, "w");
    ck_assert_ptr_nonnull(file);
    fputs(text, file);
    ck_assert_int_eq(fclose(file), 0);
    scene_init(scene);
    bool good = pbrt_load(name, false, scene, &error);
    ck_assert_msg(good, "%s", error.message);
    remove(name);
}

/* The messages of a scene file, in a static buffer. */
static const char *load_log(const char *text)
{
    Scene scene;
    import_log();
    scene_load(text, &scene);
    scene_destroy(&scene);
    return import_log();
}

static size_t count_of(const char *text, const char *part)
{
    size_t count = 0;
    for (const char *at = strstr(text, part); at; at = strstr(at + 1, part))
        ++count;
    return count;
}

/* The log has `count` warnings, the first of them with `part`. */
static void assert_warned(const char *text, size_t count, const char *part)
{
    const char *log = load_log(text);
    ck_assert_msg(count_of(log, "warning: ") == count && strstr(log, part), "%s\ngives: %s", text, log);
}

#define LIGHT_IN(declared, found)                                                                                      \
    "warning: the light is declared in the medium \"" declared                                                         \
    "\", but the surfaces around it and the camera put it into \"" found "\""

START_TEST(lights_at_a_point)
{
    assert_warned(MEDIA CAMERA "WorldBegin\n" BALL POINT, 1, ".pbrt:5:1: " LIGHT_IN("", "fog"));
    assert_warned(MEDIA CAMERA "WorldBegin\n" BALL "MediumInterface \"fog\"\n" POINT, 0, "");
    assert_warned(MEDIA CAMERA "WorldBegin\n" BALL "MediumInterface \"ink\" Translate 5 0 0\n" POINT, 1,
                  LIGHT_IN("ink", "") ", so that integrators disagree on its brightness; let \"\" be the outside of "
                                      "MediumInterface before its LightSource");
    assert_warned(MEDIA CAMERA "WorldBegin\n" BALL "Translate 5 0 0\n" POINT, 0, "");
    /* no surface at all: the medium of the camera is everywhere */
    assert_warned(MEDIA "MediumInterface \"fog\"\n" CAMERA "WorldBegin\nMediumInterface \"\"\n" POINT, 1,
                  LIGHT_IN("", "fog"));
    /* lights at infinity are put where they are */
    assert_warned(MEDIA CAMERA "WorldBegin\n" BALL "MediumInterface \"ink\" LightSource \"infinite\"", 0, "");
    assert_warned(MEDIA CAMERA "WorldBegin\n" BALL "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ] \"point3 portal\" "
                               "[ -3 3 -3  3 3 -3  3 3 3  -3 3 3 ]\n",
                  0, "");
}
END_TEST

/* Their medium is that on the side that emits; the interface may be their own surface. */
START_TEST(area_lights)
{
    static const char LAMP[] = "AreaLightSource \"diffuse\" Shape \"sphere\" \"float radius\" 0.5\n";
    char text[2048];
    const struct {
        const char *interface, *warning;
    } cases[] = {{"MediumInterface \"\" \"\"", ".pbrt:6:27: " LIGHT_IN("", "fog")},
                 {"MediumInterface \"\" \"fog\"", ""},
                 {"MediumInterface \"fog\"", ""},
                 {"MediumInterface \"fog\" \"ink\"", ".pbrt:6:27: " LIGHT_IN("ink", "fog")}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        snprintf(text, sizeof text, MEDIA CAMERA "WorldBegin\n" BALL "%s\n%s", cases[i].interface, LAMP);
        assert_warned(text, cases[i].warning[0] != '\0', cases[i].warning);
    }
    snprintf(text, sizeof text,
             MEDIA CAMERA "WorldBegin\n" BALL
                          "AttributeBegin MediumInterface \"ink\"\nObjectBegin \"lamp\" %sObjectEnd "
                          "AttributeEnd\nObjectInstance \"lamp\" Translate 5 0 0\nObjectInstance \"lamp\"\n",
             LAMP);
    assert_warned(text, 2, LIGHT_IN("ink", "fog"));
    ck_assert_ptr_nonnull(strstr(load_log(text), "put it into \"\""));
}
END_TEST

/* An interface in an object instance; a mesh of several lights counts once. */
START_TEST(instances_and_meshes)
{
    static const char QUAD[] = "AreaLightSource \"diffuse\" \"bool twosided\" true Shape \"trianglemesh\"\n"
                               "\"point3 P\" [ 0 0 0  1 0 0  1 1 0  0 1 0 ] \"integer indices\" [ 0 1 2  0 2 3 ]\n";
    char text[2048];
    snprintf(text, sizeof text,
             MEDIA CAMERA "WorldBegin\nObjectBegin \"ball\" " BALL
                          "ObjectEnd\nAttributeBegin Translate 20 0 0 ObjectInstance "
                          "\"ball\" AttributeEnd\n%sTranslate 20 0 0 %s",
             QUAD, QUAD);
    assert_warned(text, 1, LIGHT_IN("", "fog"));
}
END_TEST

START_TEST(camera)
{
    assert_warned(
        MEDIA "Camera \"perspective\"\nWorldBegin\n" BALL "MediumInterface \"fog\"\n" POINT, 1,
        ".pbrt:2:1: warning: the camera is declared in the medium \"\", but the surfaces around it enclose \"fog\", ");
    assert_warned(MEDIA "MediumInterface \"fog\" Camera \"perspective\"\nWorldBegin\n" BALL POINT, 0, "");
}
END_TEST

/* Where surfaces are open, rays find several media, and nothing is said. */
START_TEST(open_surfaces)
{
    assert_warned(MEDIA CAMERA "WorldBegin\nMediumInterface \"fog\" \"\" Material \"interface\"\n"
                               "Shape \"disk\" \"float radius\" 9 Translate 0 0 -1 MediumInterface \"\"\n" POINT,
                  0, "");
}
END_TEST

/* A room whose walls separate no media and whose only opening leads from fog into the open: what is behind walls does
 * not count. */
START_TEST(walls)
{
    static const char ROOM[] =
        "AttributeBegin MediumInterface \"\" Material \"diffuse\" Shape \"sphere\" \"float radius\" 4 "
        "\"float zmin\" -2 AttributeEnd\n"
        "AttributeBegin Material \"interface\" MediumInterface \"\" \"fog\" Translate 0 0 -2 Shape "
        "\"disk\" \"float radius\" 4 AttributeEnd\n";
    char text[2048];
    for (int fault = 0; fault < 2; ++fault) {
        snprintf(text, sizeof text, MEDIA CAMERA "WorldBegin\n%sMediumInterface \"%s\"\n" POINT, ROOM,
                 fault ? "" : "fog");
        assert_warned(text, (size_t)fault, fault ? LIGHT_IN("", "fog") : "");
    }
    /* a closed cover */
    strcat(text, "Material \"diffuse\" Shape \"sphere\" \"float radius\" 0.5");
    assert_warned(text, 0, "");
}
END_TEST

/* The first ten are shown, the rest counted; a world far from the origin is read twice and warned of once. */
START_TEST(many_lights)
{
    char text[8192];
    int used = snprintf(text, sizeof text,
                        MEDIA "Translate 1e6 0 0 MediumInterface \"fog\"\n" CAMERA
                              "WorldBegin Translate 1e6 0 0 MediumInterface \"fog\" \"\"\n"
                              "Material \"interface\" Shape \"sphere\" MediumInterface \"\"\n");
    for (int i = 0; i < 13; ++i)
        used += snprintf(text + used, sizeof text - (size_t)used, "Translate 0 0.001 0\n" POINT);
    assert_warned(text, 11, LIGHT_IN("", "fog"));
    ck_assert_ptr_nonnull(strstr(load_log(text), "warning: 3 other lights are declared in other media"));
}
END_TEST

static void separations_open(const char *text, Scene *scene, Separations *separations)
{
    Error error = {"", ""};
    scene_load(text, scene);
    const BackendScene packed = scene_backend_view(scene);
    const SceneView view = scene_view(packed.frame, packed.geometry, packed.tables, packed.texels);
    ck_assert(separations_init(separations, &view, packed.object_count, packed.instance_count, &error));
}

/* The tests against primitives that a place at the origin costs, on a surface with this normal. */
static size_t tests_spent(Separations *separations, Vec3 ng)
{
    SurroundedPoint point = {vec3_splat(0.0f), ng, 1u, 0u};
    size_t before = separations->left;
    uint medium;
    ck_assert(separations_medium_at(separations, &point, &medium));
    ck_assert_uint_eq(medium, 1u);
    return before - separations->left;
}

/* No ray is sent twice: to one side of a surface go half as many as to both. */
START_TEST(rays_of_a_place)
{
    Scene scene;
    Separations separations;
    separations_open(MEDIA CAMERA "WorldBegin\n" BALL "MediumInterface \"fog\"\n" POINT, &scene, &separations);
    size_t all = tests_spent(&separations, vec3_splat(0.0f));
    ck_assert_uint_gt(all, 0);
    ck_assert_uint_eq(tests_spent(&separations, vec3(0.0f, 1.0f, 0.0f)), all / 2);
    separations_destroy(&separations);
    scene_destroy(&scene);
}
END_TEST

/* Pieces of curves, which take longer than other primitives, count for more where they may hide what a place sees. */
START_TEST(rays_among_curves)
{
    static const char CURVE[] =
        "Shape \"curve\" \"point3 P\" [ 5 5 5  6 5 5  6 6 5  6 6 6 ] \"integer splitdepth\" 0\n";
    size_t left[2];
    for (int curves = 0; curves < 2; ++curves) {
        Scene scene;
        Separations separations;
        uint medium;
        char text[1024];
        snprintf(text, sizeof text, MEDIA CAMERA "WorldBegin\n%s" BALL POINT, curves ? CURVE : "");
        separations_open(text, &scene, &separations);
        SurroundedPoint point = {vec3_splat(0.0f), vec3_splat(0.0f), 0u, 0u};
        ck_assert(separations_medium_at(&separations, &point, &medium));
        ck_assert_uint_eq(medium, 1u);
        left[curves] = separations.left;
        separations_destroy(&separations);
        scene_destroy(&scene);
    }
    /* eight rays, for each of which the curve counts as eight triangles */
    ck_assert_uint_eq(left[0] - left[1], 64);
}
END_TEST

TCase *import_places_case(void)
{
    TCase *tcase = tcase_create("places");
    tcase_add_test(tcase, lights_at_a_point);
    tcase_add_test(tcase, area_lights);
    tcase_add_test(tcase, instances_and_meshes);
    tcase_add_test(tcase, camera);
    tcase_add_test(tcase, open_surfaces);
    tcase_add_test(tcase, walls);
    tcase_add_test(tcase, many_lights);
    tcase_add_test(tcase, rays_of_a_place);
    tcase_add_test(tcase, rays_among_curves);
    return tcase;
}
