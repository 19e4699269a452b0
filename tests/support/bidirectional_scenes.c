/* Scenes for bidirectional integrators: one for each material, light, camera and kind of geometry. */
#include "support/bidirectional.h"

#include "support/test_files.h"

#define LINE "\n"
#define AT(x, y, z, what) "AttributeBegin Translate " #x " " #y " " #z "\n" what "AttributeEnd\n"
#define CARD                                                                                                           \
    "Shape \"bilinearmesh\" \"point3 P\" [ -0.8 -0.6 0  0.8 -0.6 0.3  -0.8 0.9 0.2  0.8 0.8 -0.1 ] "                   \
    "\"point2 uv\" [ 0 0 1 0 0 1 1 1 ]\n"
#define HOLES "Texture \"holes\" \"float\" \"checkerboard\" \"float tex1\" 1 \"float tex2\" 0.4 \"float uscale\" 3\n"
#define ROUGH(name, parameters) "Material \"" name "\" " parameters " \"bool remaproughness\" false\n"

#define STRAND(type, points)                                                                                           \
    "Shape \"curve\" \"string type\" \"" type "\" \"float width\" 0.12 \"float width1\" 0.06 \"point3 P\" [ " points   \
    " ]\n"
#define STRANDS(type)                                                                                                  \
    STRAND(type, "-1.4 -0.6 0.3  -0.5 0.9 0  0.4 -0.5 -0.2  1.3 0.6 0.2")                                              \
    STRAND(type, "-1.2 0.7 -0.4  -0.4 0.2 0.2  0.3 0.8 0.4  1.2 -0.4 -0.3")                                            \
    STRAND(type, "0 -1 0  0.4 -0.3 0.3  -0.4 0.5 -0.1  0.1 1.4 0.2")

const BidirectionalScene BIDIRECTIONAL_SCENES[] = {
    {"diffuse", BD_ROOM BD_BALL, SUPPORT_ALL, 5, 4},
    {"glossy",
     BD_BEGIN BD_LAMP ROUGH("conductor", "\"rgb reflectance\" [ 0.9 0.8 0.7 ] \"float roughness\" 0.4") BD_FLOOR ROUGH(
         "conductor", "\"rgb reflectance\" [ 0.7 0.8 0.9 ] \"float uroughness\" 0.6 \"float vroughness\" 0.3") BD_BALL,
     SUPPORT_ALL, 5, 3},
    {"glass", BD_ROOM "Material \"dielectric\" \"float eta\" 1.5\n" BD_BALL, SUPPORT_SUM_ONLY, 6, 2},
    {"rough glass", BD_ROOM ROUGH("dielectric", "\"float eta\" 1.5 \"float roughness\" 0.5") BD_BALL, SUPPORT_ALL, 6,
     3},
    {"thin glass",
     BD_ROOM "Material \"thindielectric\" \"float eta\" 1.5\n" AT(0, 0.3, -2, CARD) "Material \"diffuse\"\n" BD_BALL,
     SUPPORT_SUM_ONLY, 5, 2},
    {"mirror", BD_ROOM "Material \"conductor\" \"rgb reflectance\" [ 0.9 0.9 0.9 ] \"float roughness\" 0\n" BD_BALL,
     SUPPORT_SUM_ONLY, 5, 2},
    {"coated", BD_ROOM ROUGH("coateddiffuse", "\"rgb reflectance\" [ 0.8 0.5 0.3 ] \"float roughness\" 0.4") BD_BALL,
     SUPPORT_ALL, 5, 3},
    {"coated smooth",
     BD_ROOM "Material \"coateddiffuse\" \"rgb reflectance\" [ 0.8 0.5 0.3 ] \"float roughness\" 0\n" BD_BALL,
     SUPPORT_SUM_ONLY, 5, 2},
    {"transmission",
     BD_ROOM "Material \"diffusetransmission\" \"rgb reflectance\" [ 0.2 0.3 0.4 ] \"rgb transmittance\" [ 0.5 0.4 0.3 "
             "]\n" BD_BALL,
     SUPPORT_ALL, 5, 3},
    {"bump",
     BD_BEGIN BD_LAMP
     "Texture \"bumps\" \"float\" \"imagemap\" \"string filename\" \"$FILES/bumps.pfm\" \"float scale\" 0.3\n"
     "Material \"diffuse\" \"rgb reflectance\" [ 0.7 0.6 0.5 ] \"texture displacement\" \"bumps\"\n"
     "Shape \"bilinearmesh\" \"point3 P\" [ -4 -1 -4  4 -1 -4  -4 -1 4  4 -1 4 ] \"point2 uv\" [ 0 0 2 0 0 2 2 2 ]\n"
     "Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.6 0.5 ] \"texture displacement\" \"bumps\"\n" BD_BALL,
     SUPPORT_ALL, 4, 3},
    {"shading normals", BD_ROOM "$ICOSPHERE", SUPPORT_ALL, 5, 3},
    /* Shading and geometric normals differ everywhere on the floor: without the adjoint's correction factor, (2,1) is a
     * few times too bright. */
    {"tilted normals",
     BD_BEGIN BD_LAMP BD_GREY "Shape \"bilinearmesh\" \"point3 P\" [ -4 -1 -4  4 -1 -4  -4 -1 4  4 -1 4 ] \"normal N\" "
                              "[ 0 0.8 -0.6  0 0.8 -0.6  0 0.8 -0.6  0 0.8 -0.6 ]\n" BD_BALL,
     SUPPORT_ALL, 4, 3},
    {"shading normals, glossy",
     BD_ROOM ROUGH("conductor", "\"rgb reflectance\" [ 0.9 0.8 0.7 ] \"float roughness\" 0.5") "$ICOSPHERE",
     SUPPORT_ALL, 5, 3},
    {"shading normals, glass", BD_ROOM ROUGH("dielectric", "\"float eta\" 1.5 \"float roughness\" 0.5") "$ICOSPHERE",
     SUPPORT_ALL, 5, 3},
    {"mix",
     BD_BEGIN BD_LAMP BD_GREY BD_FLOOR
     "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 0.9 0.1 0.1 ]\n"
     "MakeNamedMaterial \"b\" \"string type\" \"conductor\" \"rgb reflectance\" [ 1 1 1 ] \"float roughness\" 0.5\n"
     "Material \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" 0.3\n" BD_BALL,
     SUPPORT_ALL, 4, 3},
    {"environment",
     BD_BEGIN "LightSource \"infinite\" \"string filename\" \"$FILES/sky.pfm\"\n" BD_GREY BD_FLOOR BD_BALL, SUPPORT_ALL,
     4, 3},
    {"sky and lamp",
     BD_ROOM "LightSource \"infinite\" \"rgb L\" [ 0.3 0.4 0.5 ]\nLightSource \"infinite\" \"string filename\" "
             "\"$FILES/sky.pfm\"\n" BD_BALL,
     SUPPORT_ALL, 4, 3},
    /* A card in front of the second portal hides part of its light, and is not lit by it itself. */
    {"portals",
     BD_BEGIN
     "LightSource \"infinite\" \"string filename\" \"$FILES/sky.pfm\" \"point3 portal\" "
     "[ -1.5 2 1  -1.5 2 -1  0.5 2 -1  0.5 2 1 ]\n"
     "LightSource \"infinite\" \"rgb L\" [ 1 2 3 ] \"point3 portal\" [ 2 2 0  2 -0.5 0  2 -0.5 2  2 2 2 ]\n" BD_GREY
         BD_FLOOR BD_BALL
     "Shape \"bilinearmesh\" \"point3 P\" [ 2.02 -0.4 1.5  2.4 -0.4 1.5  2.02 1.2 1.5  2.4 1.2 1.5 ]\n",
     SUPPORT_ALL, 4, 3},
    {"sun in the sky",
     BD_BEGIN "AttributeBegin Rotate -90 1 0 0 LightSource \"infinite\" \"string filename\" \"$FILES/sun.pfm\" "
              "AttributeEnd\n" BD_GREY BD_FLOOR BD_BALL,
     SUPPORT_NO_HIT, 4, 3},
    {"sun",
     BD_BEGIN
     "LightSource \"distant\" \"rgb L\" [ 3 3 2 ] \"point3 from\" [ 1 2 -1 ] \"point3 to\" [ 0 0 0 ]\n" BD_GREY BD_FLOOR
         BD_BALL,
     SUPPORT_NO_HIT, 4, 3},
    {"spot and point",
     BD_BEGIN "LightSource \"spot\" \"rgb I\" [ 30 30 30 ] \"point3 from\" [ 1 3 -2 ] \"point3 to\" [ 0 0 0 ] "
              "\"float coneangle\" 30 \"float conedeltaangle\" 12\n"
              "LightSource \"point\" \"rgb I\" [ 3 3 6 ] \"point3 from\" [ -1 2 -2 ]\n" BD_GREY BD_FLOOR BD_BALL,
     SUPPORT_NO_HIT, 4, 3},
    {"goniometric and projection",
     BD_BEGIN
     "AttributeBegin Translate -1 2 -2 Rotate 50 1 2 0 LightSource \"goniometric\" \"rgb I\" [ 3 4 6 ] "
     "\"string filename\" \"$FILES/sky.pfm\" AttributeEnd\n"
     "AttributeBegin Translate 1 3 -2 Rotate 50 1 0 0 Rotate -20 0 1 0 LightSource \"projection\" "
     "\"float scale\" 20 \"float fov\" 60 \"string filename\" \"$FILES/sky.pfm\" AttributeEnd\n" BD_GREY BD_FLOOR
         BD_BALL,
     SUPPORT_NO_HIT, 4, 3},
    {"instances",
     BD_ROOM "ObjectBegin \"o\" " BD_BALL "Translate 0 1.5 0 " CARD
             "ObjectEnd\nAttributeBegin Translate -1.2 -0.4 0.5 Scale 0.5 0.3 0.5 ObjectInstance \"o\" AttributeEnd\n"
             "AttributeBegin Translate 0.9 0 0 Rotate 40 1 1 0 Scale -0.7 0.7 0.7 ObjectInstance \"o\" AttributeEnd\n",
     SUPPORT_ALL, 4, 3},
    {"lens",
     BD_FILM "LookAt 0 1.2 -6  0 -0.2 0  0 1 0\nCamera \"perspective\" \"float fov\" 38 \"float lensradius\" 0.3 "
             "\"float focaldistance\" 4\nWorldBegin\n" BD_LAMP BD_GREY BD_FLOOR BD_BALL,
     SUPPORT_ALL, 4, 3},
    {"orthographic",
     BD_FILM "Scale -1 1 1 LookAt 0 1.2 -6  0 -0.2 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" "
             "[ -2 2 -1.5 2 ] \"float lensradius\" 0.2 \"float focaldistance\" 5\nWorldBegin\n" BD_LAMP BD_GREY BD_FLOOR
                 BD_BALL,
     SUPPORT_ALL, 4, 3},
    {"equal-area camera",
     BD_FILM "PixelFilter \"triangle\"\nLookAt 0 1.2 -3  0 -0.2 0  0 1 0\nCamera "
             "\"spherical\"\nWorldBegin\n" BD_LAMP BD_GREY BD_FLOOR BD_BALL "Shape \"sphere\" \"float radius\" 6\n",
     SUPPORT_ALL, 4, 3},
    {"equirectangular camera",
     BD_FILM
     "PixelFilter \"triangle\"\nLookAt 0 1.2 -3  0 -0.2 0  0 1 0\n"
     "Camera \"spherical\" \"string mapping\" \"equirectangular\"\nWorldBegin\n" BD_LAMP BD_GREY BD_FLOOR BD_BALL
     "Shape \"sphere\" \"float radius\" 6\n",
     SUPPORT_ALL, 4, 3},
    {"sphere light",
     BD_BEGIN BD_GREY BD_FLOOR BD_BALL "AttributeBegin Translate 0.4 2.3 -0.8 AreaLightSource \"diffuse\" \"rgb L\" "
                                       "[ 6 6 6 ] Shape \"sphere\" \"float radius\" 0.8 AttributeEnd\n",
     SUPPORT_ALL, 4, 3},
    {"two-sided lights",
     BD_BEGIN BD_GREY BD_FLOOR AT(
         0, -0.2, 0.8, BD_BALL) "AreaLightSource \"diffuse\" \"rgb L\" [ 4 4 4 ] \"bool twosided\" true\n"
                                "Shape \"trianglemesh\" \"point3 P\" [ -1 2 0  1 2.2 0  0 1.8 1 ]\n" AT(
                                    -1, 0.6, -1,
                                    "Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.7 \"float innerradius\" 0.2\n"),
     SUPPORT_ALL, 4, 3},
    {"alpha",
     BD_ROOM HOLES "Shape \"bilinearmesh\" \"point3 P\" [ -1 1 -1  1 1.2 -1  -1 1 1  1 1.4 1 ] \"texture alpha\" "
                   "\"holes\"\n" BD_BALL "AreaLightSource \"diffuse\" \"rgb L\" [ 5 5 5 ]\n"
                   "Shape \"disk\" \"float radius\" 0.7 \"float height\" 2 \"texture alpha\" \"holes\"\n",
     SUPPORT_ALL, 4, 3},
    {"two-sided sphere with holes",
     BD_BEGIN BD_GREY BD_FLOOR HOLES AT(
         0, -0.3, 0.8, BD_BALL) "AttributeBegin Translate 0 2 -0.6 AreaLightSource \"diffuse\" \"rgb L\" [ 5 5 5 ] "
                                "\"bool twosided\" true\n"
                                "Shape \"sphere\" \"float radius\" 0.9 \"texture alpha\" \"holes\" AttributeEnd\n",
     SUPPORT_NO_DRAW, 4, 3},
    {"invisible lights",
     BD_BEGIN BD_GREY BD_FLOOR AT(
         0, -0.2, 0.8,
         BD_BALL) "AreaLightSource \"diffuse\" \"rgb L\" [ 4 4 4 ] \"bool twosided\" true\n"
                  "Shape \"trianglemesh\" \"point3 P\" [ -1 2 0  1 2.2 0  0 1.8 1 ] \"float alpha\" 0\n" AT(
                      0.9, 0.4, -1, "Shape \"sphere\" \"float radius\" 0.4 \"float alpha\" 0\n")
                      AT(-1, 0.6, -1,
                         "AreaLightSource \"diffuse\" \"rgb L\" [ 3 6 3 ]\n"
                         "Rotate 60 1 0 0 Shape \"disk\" \"float radius\" 0.5 \"float alpha\" 0\n"
                         "Translate 0 -0.9 0.4 Shape \"sphere\" \"float radius\" 0.2 \"float alpha\" 0\n"),
     SUPPORT_NO_HIT, 4, 3},
    {"normal map",
     BD_BEGIN BD_LAMP
     "Material \"diffuse\" \"rgb reflectance\" [ 0.7 0.6 0.5 ] \"string normalmap\" \"$FILES/normals.pfm\"\n"
     "Shape \"bilinearmesh\" \"point3 P\" [ -4 -1 -4  4 -1 -4  -4 -1 4  4 -1 4 ] \"point2 uv\" [ 0 0 2 0 0 2 2 2 "
     "]\n" ROUGH("conductor", "\"rgb reflectance\" [ 0.9 0.8 0.7 ] \"float roughness\" 0.4 \"string normalmap\" "
                              "\"$FILES/normals.pfm\"") BD_BALL,
     SUPPORT_ALL, 4, 3},
    /* Rays from the sky are aimed at the glass (light/aim.h). */
    {"glass under a sky",
     BD_BEGIN "LightSource \"infinite\" \"rgb L\" [ 0.3 0.4 0.5 ]\n" BD_GREY BD_FLOOR
              "Material \"dielectric\" \"float eta\" 1.5\n" BD_BALL,
     SUPPORT_SUM_ONLY, 5, 2},
    {"hair", BD_ROOM "Material \"hair\" \"rgb sigma_a\" [ 0.1 0.2 0.4 ] \"float beta_n\" 0.6\n" STRANDS("flat"),
     SUPPORT_ALL, 4, 3},
    {"curves",
     BD_ROOM ROUGH("coateddiffuse", "\"rgb reflectance\" [ 0.8 0.5 0.3 ] \"float roughness\" 0.4") STRANDS("cylinder")
         AT(0.2, 0.3, -1,
            "Material \"diffusetransmission\" \"rgb reflectance\" [ 0.2 0.3 0.4 ] \"rgb transmittance\" [ 0.5 0.4 0.3 "
            "]\n" STRANDS("flat")),
     SUPPORT_ALL, 4, 3},
    {"hair on a sphere",
     BD_ROOM
     "Material \"hair\" \"float beta_m\" 0.6 \"float beta_n\" 0.8 \"rgb reflectance\" [ 0.7 0.5 0.3 ]\n" BD_BALL,
     SUPPORT_ALL, 4, 3},
    /* Between vertices in a medium 1 / distance^2 has no finite variance, so only the sums of strategies are
     * compared. */
    {"ink in glass and behind an interface",
     "MakeNamedMedium \"ink\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.4 0.8 1.6 ] \"float sigma_s\" 0\n"
     "MakeNamedMedium \"smoke\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.1 0.05 0.02 ] \"float sigma_s\" 0\n"
     "MediumInterface \"smoke\"\n" BD_ROOM "MediumInterface \"ink\" \"smoke\"\n"
     "AttributeBegin Translate -1 0 0 Material \"dielectric\"\n" BD_BALL "AttributeEnd\n"
     "AttributeBegin Translate 1 0 0 Material \"interface\"\n" BD_BALL "AttributeEnd\n"
     "AttributeBegin MediumInterface \"\" \"smoke\" Translate 0 -0.5 -1 Scale 0.5 0.5 0.5\n"
     "Material \"coatedconductor\" \"float conductor.roughness\" 0.3\n" BD_BALL "AttributeEnd\n",
     SUPPORT_SUM_ONLY, 5, 2},
    {"fog around glass, and a denser one behind an interface",
     "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.02 0.03 0.05 ]\n"
     "\"rgb sigma_s\" [ 0.25 0.3 0.4 ] \"float g\" 0.5\n"
     "MakeNamedMedium \"milk\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.1 0.2 0.4 ]\n"
     "\"rgb sigma_s\" [ 2 1.5 1 ] \"float g\" -0.3\n"
     "MediumInterface \"fog\"\n" BD_ROOM "AttributeBegin MediumInterface \"\" \"fog\" Translate -1 0 0\n"
     "Material \"dielectric\"\n" BD_BALL "AttributeEnd\n"
     "AttributeBegin MediumInterface \"milk\" \"fog\" Translate 1 0 0 Material \"interface\"\n" BD_BALL
     "AttributeEnd\n",
     SUPPORT_SUM_ONLY, 4, 2},
    {"a closed room full of fog",
     "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.02 0.01 0.005 ]\n"
     "\"rgb sigma_s\" [ 0.2 0.3 0.4 ] \"float g\" 0.5\nMediumInterface \"fog\"\n" BD_FILM
     "LookAt 0 1 -3.9  0 1 0  0 1 0 Camera \"perspective\" \"float fov\" 40\nWorldBegin\n"
     "AttributeBegin Translate 0 1.98 0 AreaLightSource \"diffuse\" \"rgb L\" [ 8 8 8 ]\n"
     "Shape \"bilinearmesh\" \"point3 P\" [ -.5 0 -.5  .5 0 -.5  -.5 0 .5  .5 0 .5 ] AttributeEnd\n"
     "Material \"diffuse\" \"rgb reflectance\" [ 0.7 0.7 0.7 ]\n"
     "Shape \"trianglemesh\" \"point3 P\" [ -1 0 -4  1 0 -4  1 0 1  -1 0 1  -1 2 -4  1 2 -4  1 2 1  -1 2 1 ]\n"
     "\"integer indices\" [ 0 1 2 0 2 3 4 6 5 4 7 6 3 2 6 3 6 7 0 3 7 0 7 4 1 5 6 1 6 2 0 4 5 0 5 1 ]",
     SUPPORT_SUM_ONLY, 5, 2},
    /* Distances far from 1: a direction that is not a unit vector, or a missing power of a distance, changes much. */
    {"a large closed room full of fog",
     "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.001 0.001 0.001 ]\n"
     "\"rgb sigma_s\" [ 0.03 0.04 0.05 ]\nMediumInterface \"fog\"\n" BD_FILM
     "LookAt 0 10 -39  0 10 0  0 1 0 Camera \"perspective\" \"float fov\" 40\nWorldBegin\nScale 10 10 10\n"
     "AttributeBegin Translate 0 1.98 0 AreaLightSource \"diffuse\" \"rgb L\" [ 8 8 8 ]\n"
     "Shape \"bilinearmesh\" \"point3 P\" [ -.5 0 -.5  .5 0 -.5  -.5 0 .5  .5 0 .5 ] AttributeEnd\n"
     "Material \"diffuse\" \"rgb reflectance\" [ 0.7 0.7 0.7 ]\n"
     "Shape \"trianglemesh\" \"point3 P\" [ -1 0 -4  1 0 -4  1 0 1  -1 0 1  -1 2 -4  1 2 -4  1 2 1  -1 2 1 ]\n"
     "\"integer indices\" [ 0 1 2 0 2 3 4 6 5 4 7 6 3 2 6 3 6 7 0 3 7 0 7 4 1 5 6 1 6 2 0 4 5 0 5 1 ]",
     SUPPORT_SUM_ONLY, 5, 2},
    {"fog in a sphere under a sky, lit by a point",
     "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.1 0.2 0.3 ]\n"
     "\"rgb sigma_s\" [ 1 2 1.5 ] \"float g\" 0.7\n" BD_BEGIN "LightSource \"infinite\" \"rgb L\" [ 0.3 0.4 0.5 ]\n"
     "LightSource \"point\" \"rgb I\" [ 4 3 2 ] \"point3 from\" [ 2 2 -1 ]\n" BD_GREY BD_FLOOR
     "MediumInterface \"fog\" \"\" Material \"interface\"\n" BD_BALL,
     SUPPORT_SUM_ONLY, 4, 2},
    {"smoke of grids around everything and behind an interface",
     "MakeNamedMedium \"smoke\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \"integer ny\" 3 \"integer nz\" 2\n"
     "\"point3 p0\" [ -2 -1 -6 ] \"point3 p1\" [ 2 2.5 1 ] \"float density\" [ 1 0 0.2 3 0 1 2 0.1 0 0 1 0.5 ]\n"
     "\"rgb sigma_a\" [ 0.02 0.03 0.05 ] \"rgb sigma_s\" [ 0.4 0.3 0.5 ] \"float g\" 0.4\n"
     "MakeNamedMedium \"dye\" \"string type\" \"rgbgrid\" \"integer nz\" 3 \"point3 p0\" [ 0 -1 -1 ] \"point3 p1\" [ 2 "
     "1 1 ]\n"
     "\"rgb sigma_a\" [ 0.1 0.2 0.4 0 0.5 0 0.7 0 0.1 ] \"rgb sigma_s\" [ 2 1 0 0 0.5 3 1.5 4 1 ] \"float g\" -0.3\n"
     "MediumInterface \"smoke\"\n" BD_ROOM "AttributeBegin MediumInterface \"\" \"smoke\" Translate -1 0 0\n"
     "Material \"dielectric\"\n" BD_BALL "AttributeEnd\n"
     "AttributeBegin MediumInterface \"dye\" \"smoke\" Translate 1 0 0 Material \"interface\"\n" BD_BALL
     "AttributeEnd\n",
     SUPPORT_SUM_ONLY, 4, 2},
};

const int BIDIRECTIONAL_SCENE_COUNT = (int)(sizeof BIDIRECTIONAL_SCENES / sizeof BIDIRECTIONAL_SCENES[0]);

const char *const BIDIRECTIONAL_FILTERS[BIDIRECTIONAL_FILTER_COUNT] = {
    "\"box\" \"float xradius\" 0.5 \"float yradius\" 0.5",
    "\"box\" \"float xradius\" 1.3 \"float yradius\" 0.8",
    "\"triangle\"",
    "\"gaussian\"",
    "\"mitchell\"",
    "\"sinc\" \"float xradius\" 2.5 \"float yradius\" 3"};

/* ---- files ------------------------------------------------------------------------------------------------------- */

/* Writes the red, green and blue of an n x n image; values are in low ... high. */
static void image_write(const char *name, int n, double low, double high, int sun)
{
    unsigned state = 5;
    float *rgb = calloc((size_t)(3 * n * n), sizeof *rgb);
    ck_assert_ptr_nonnull(rgb);
    for (int i = 0; i < 3 * n * n; ++i)
        rgb[i] = (float)(low + (high - low) * test_random_unit(&state));
    for (int c = 0; sun >= 0 && c < 3; ++c)
        rgb[3 * sun + c] = 2000.0f;
    analytic_write_pfm(test_path(name), n, n, rgb);
    free(rgb);
}

/* Directions around +z as texels of a normal map. */
static void normals_write(void)
{
    float rgb[3 * 8 * 8];
    unsigned state = 5;
    for (int i = 0; i < 3 * 8 * 8; ++i)
        rgb[i] = i % 3 == 2 ? 0.95f : (float)(0.25 + 0.5 * test_random_unit(&state));
    analytic_write_pfm(test_path("normals.pfm"), 8, 8, rgb);
}

void bidirectional_files_make(void)
{
    test_folder_make();
    image_write("sky.pfm", 8, 0.1, 2.0, -1);
    image_write("sun.pfm", 32, 0.05, 0.2, 32 * 14 + 13);
    image_write("wide_sun.pfm", 16, 0.05, 0.2, 16 * 7 + 6);
    image_write("bumps.pfm", 8, 0.0, 0.9, -1);
    image_write("signs.pfm", 8, -3.0, 1.0, -1);
    normals_write();
}

void bidirectional_files_remove(void)
{
    test_folder_remove();
}

/* An icosahedron of radius 0.9 with the normals of the sphere around it: 20 faces, so that shading and geometric
 * normals differ by up to 37 degrees. */
static const char *const ICOSPHERE =
    "Shape \"trianglemesh\" \"integer indices\" [ 0 11 5 0 5 1 0 1 7 0 7 10 0 10 11 1 5 9 5 11 4 11 10 2 10 7 6 7 1 8 "
    "3 9 4 3 4 2 3 2 6 3 6 8 3 8 9 4 9 5 2 4 11 6 2 10 8 6 7 9 8 1 ]\n"
    "\"point3 P\" [ -.473 .766 0  .473 .766 0  -.473 -.766 0  .473 -.766 0  0 -.473 .766  0 .473 .766  0 -.473 -.766  "
    "0 "
    ".473 -.766  .766 0 -.473  .766 0 .473  -.766 0 -.473  -.766 0 .473 ]\n"
    "\"normal N\" [ -.473 .766 0  .473 .766 0  -.473 -.766 0  .473 -.766 0  0 -.473 .766  0 .473 .766  0 -.473 -.766  "
    "0 "
    ".473 -.766  .766 0 -.473  .766 0 .473  -.766 0 -.473  -.766 0 .473 ]\n";

const char *bidirectional_text(const BidirectionalScene *scene)
{
    static char text[8192];
    size_t used = 0;
    for (const char *from = scene->text; *from; ++from) {
        bool files = strncmp(from, "$FILES", 6) == 0, sphere = strncmp(from, "$ICOSPHERE", 10) == 0;
        const char *what = files ? test_folder : ICOSPHERE;
        if (!files && !sphere) {
            text[used++] = *from;
            continue;
        }
        ck_assert_uint_lt(used + strlen(what) + 1, sizeof text);
        strcpy(text + used, what);
        used += strlen(what);
        from += files ? 5 : 9;
    }
    ck_assert_uint_lt(used, sizeof text);
    text[used] = 0;
    return text;
}
