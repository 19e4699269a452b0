/* Bidirectional integrators against path tracing: scenes, images in independent groups, and the tests that compare
 * them. */
#ifndef TWINLIGHT_TESTS_SUPPORT_BIDIRECTIONAL_H
#define TWINLIGHT_TESTS_SUPPORT_BIDIRECTIONAL_H

#include "support/analytic.h"

/* Which strategies cannot make all paths of a scene, because some density is a delta or zero. */
#define SUPPORT_ALL 0u
#define SUPPORT_NO_HIT 0x1u /* no path hits the light, or hardly ever */
#define SUPPORT_NO_DRAW 0x4u /* s = 1 samples only part of the light: of a sphere the near side */
#define SUPPORT_SUM_ONLY 0x2u /* delta scattering: strategies do not share support */

typedef struct BidirectionalScene {
    const char *name;
    const char *text; /* "$FILES": a folder with sky, sun, bumps and normals.pfm; "$ICOSPHERE": a mesh with normals */
    unsigned support;
    int depth; /* maximum depth for the sum of all strategies */
    int strategy_depth; /* maximum depth for the comparison of individual strategies */
} BidirectionalScene;

extern const BidirectionalScene BIDIRECTIONAL_SCENES[];
extern const int BIDIRECTIONAL_SCENE_COUNT;

/* A pixel filter of every kind, as text of PixelFilter. */
enum { BIDIRECTIONAL_FILTER_COUNT = 6 };
extern const char *const BIDIRECTIONAL_FILTERS[BIDIRECTIONAL_FILTER_COUNT];

/* Make and remove the folder with the files that scenes refer to. */
void bidirectional_files_make(void);
void bidirectional_files_remove(void);

/* The scene's text with file names inserted; valid until the next call. */
const char *bidirectional_text(const BidirectionalScene *scene);

/* Precedes a scene's content: film of 16 x 16 and a camera that looks at the origin from the front. Floor at y = -1; a
 * lamp of 3 x 3 at y = 2.5. No surfaces touch: between touching ones, 1 / distance^2 has no finite variance. */
#define BD_FILM "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nPixelFilter \"box\"\n"
#define BD_VIEW BD_FILM "LookAt 0 1.2 -6  0 -0.2 0  0 1 0\n"
#define BD_BEGIN BD_VIEW "Camera \"perspective\" \"float fov\" 38\nWorldBegin\n"
#define BD_FLOOR "Shape \"bilinearmesh\" \"point3 P\" [ -4 -1 -4  4 -1 -4  -4 -1 4  4 -1 4 ]\n"
#define BD_GREY "Material \"diffuse\" \"rgb reflectance\" [ 0.7 0.6 0.5 ]\n"
#define BD_BALL "Shape \"sphere\" \"float radius\" 0.9\n"
#define BD_LAMP                                                                                                        \
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ 3 3 3 ] Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 " \
    "]\n"                                                                                                              \
    "Shape \"bilinearmesh\" \"point3 P\" [ -1.5 2.5 -1.5  1.5 2.5 -1.5  -1.5 2.5 1.5  1.5 2.5 1.5 ] AttributeEnd\n"
#define BD_ROOM BD_BEGIN BD_LAMP BD_GREY BD_FLOOR

/* ---- images in groups -------------------------------------------------------------------------------------------- */

#define GROUPS_MAX 64

/* One image from independent seeds, a single channel: the mean of three. */
typedef struct PictureGroups {
    int groups, width, height; /* of the crop window */
    double *values; /* [group][y][x] */
    bool sound; /* nothing infinite, NaN or clamped in any group */
} PictureGroups;

typedef struct GroupSetup {
    RenderSetup render; /* its seed is the first group's */
    int groups;
    bool at_depth; /* only paths of exactly max_depth segments: a difference of two path-traced images */
    unsigned layer_depth; /* the layer of this depth instead of the image; 0: the image */
} GroupSetup;

void groups_render(const GroupSetup *setup, PictureGroups *picture);
void groups_destroy(PictureGroups *picture);
double groups_mean(const PictureGroups *picture);

/* Mean over groups of a block of pixels, and its standard error; the variance of one group is taken to be at least 1e-4
 * of the image's mean squared. */
void groups_block(const PictureGroups *picture, int x0, int y0, int x1, int y1, double *mean, double *error);

/* Two-sided p-value of Welch's t-test for equal means of that block. */
double groups_p_value(const PictureGroups *a, const PictureGroups *b, int x0, int y0, int x1, int y1);

/* Fewer than 40,000 values are compared, so that without an error the tests of a run fail with probability 0.01 in
 * total. */
#define P_LIMIT 2.5e-7

/* Variance of the mean of the groups, averaged over pixels. */
double groups_mean_variance(const PictureGroups *picture);

/* Mean square difference between one group's pixels and the mean of another image, minus that mean's variance. */
double groups_square_error(const PictureGroups *picture, const PictureGroups *reference);

/* Compares the mean, a grid of blocks and (pixels = true) every pixel; fails with name and position. Prints a line with
 * the smallest p-value and the ratio of means. */
void groups_compare(const char *name, const PictureGroups *got, const PictureGroups *expected, int grid, bool pixels);

TCase *bidirectional_weights_case(void);
TCase *bidirectional_walks_case(void);
TCase *bidirectional_running_case(void);
TCase *bidirectional_strategies_case(void);
TCase *bidirectional_sums_case(void);
TCase *bidirectional_film_case(void);
TCase *bidirectional_spread_case(void);
TCase *bidirectional_hard_case(void);
TCase *mmlt_shown_case(void);
TCase *mmlt_easy_case(void);

#endif
