#include "scene/portal_setup.h"

#include "base/matrix.h"
#include "base/parallel.h"
#include "base/processors.h"
#include "light/infinite.h"
#include "scene/distribution_build.h"

#include <math.h>
#include <stdlib.h>

/* Cells per side for a constant environment: the light of a cell then varies as its solid angle does. */
#define CONSTANT_SIDE 128u
#define SIDE_MIN 16u

/* The light is evaluated at this many points of a cell per side: closer together than the texels that it is
 * interpolated between, so that none is missed. */
#define CELL_POINTS 2u

/* Part of light subpaths that comes from all directions alike, however dark the points seem that were evaluated. */
#define EVEN_PART 1e-6

/* ---- the rectangle ----------------------------------------------------------------------------------------------- */

/* Largest cosine between neighbouring sides, and the largest difference of opposite ones relative to their length;
 * pbrt's bounds. */
#define SKEW_MAX 1e-3

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static Vec3 to_vec3(const double v[3], double scale)
{
    return vec3((float)(v[0] * scale), (float)(v[1] * scale), (float)(v[2] * scale));
}

bool portal_make(const double corners[4][3], Portal *portal, Error *error)
{
    double x[3], y[3], n[3], skew[3];
    for (int k = 0; k < 3; ++k) {
        x[k] = corners[3][k] - corners[0][k];
        y[k] = corners[1][k] - corners[0][k];
        skew[k] = corners[2][k] - corners[1][k] - x[k];
    }
    double width = sqrt(dot3(x, x)), height = sqrt(dot3(y, y)), across = dot3(x, y);
    double least = fmin(width, height);
    if (!(least > 0.0) || !isfinite(width * height) || !(fabs(across) <= SKEW_MAX * width * height) ||
        !(sqrt(dot3(skew, skew)) <= SKEW_MAX * least)) {
        error_set(error, "the four points of a portal are not the corners of a rectangle");
        return error_fix(error, "give them in order around it, with right angles");
    }
    for (int k = 0; k < 3; ++k)
        y[k] -= across / (width * width) * x[k];
    vector_cross(x, y, n);
    *portal = (Portal){.corner = to_vec3(corners[0], 1.0), .width = (float)width, .height = (float)height};
    portal->axes.t = to_vec3(x, 1.0 / width);
    portal->axes.b = to_vec3(y, 1.0 / sqrt(dot3(y, y)));
    portal->axes.n = to_vec3(n, 1.0 / sqrt(dot3(n, n)));
    return true;
}

Vec3 portal_corner(const Portal *portal, int index)
{
    Vec3 p = portal->corner;
    if (index == 2 || index == 3)
        p = vec3_mad(p, portal->width, portal->axes.t);
    return index == 1 || index == 2 ? vec3_mad(p, portal->height, portal->axes.b) : p;
}

/* ---- the environment's light ------------------------------------------------------------------------------------- */

/* Rows are filled on several threads. */
typedef struct Rectified {
    SceneView view;
    uint light, side;
    Portal portal;
    float *radiant; /* of each cell: luminance times solid angle, times the number of cells */
    float *flux; /* the same times the cosine with the portal's normal */
    bool *finite; /* of each row */
} Rectified;

static void row_fill(void *context, size_t y)
{
    const Rectified *r = context;
    const double points = CELL_POINTS * CELL_POINTS, step = 1.0 / (double)(r->side * CELL_POINTS);
    bool finite = true;
    for (uint x = 0; x < r->side; ++x) {
        double radiant = 0.0, flux = 0.0;
        for (uint k = 0; k < CELL_POINTS * CELL_POINTS; ++k) {
            float stretch;
            size_t column = (size_t)x * CELL_POINTS + k % CELL_POINTS, row = y * CELL_POINTS + k / CELL_POINTS;
            double u = ((double)column + 0.5) * step, v = ((double)row + 0.5) * step;
            Vec3 d = portal_direction(&r->portal, vec2((float)u, (float)v), &stretch);
            double light = (double)rgb_luminance(environment_beyond(&r->view, r->light, d)) * (double)stretch / points;
            radiant += light;
            flux += light * (double)vec3_dot(d, r->portal.axes.n);
        }
        r->radiant[y * r->side + x] = (float)radiant;
        r->flux[y * r->side + x] = (float)flux;
        finite = finite && isfinite((float)radiant);
    }
    r->finite[y] = finite;
}

static double total(const float *cells, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; ++i)
        sum += (double)cells[i];
    return sum;
}

/* Appends the sums of the cells' light in units of a 2^32nd of the whole, at least one for every cell, so that no
 * direction is out of reach. */
static bool sums_add(Scene *scene, const Rectified *r, double radiant, uint *first, Error *error)
{
    size_t side = r->side, count = (side + 1) * (side + 1);
    if (scene->texels.count + count > SCENE_WORDS_MAX) {
        error_set(error, "the images and portals of the scene need more than 16 GiB");
        return error_fix(error, "use smaller images");
    }
    *first = (uint)scene->texels.count;
    uint *sums = array_grow(&scene->texels, count, error);
    if (!sums)
        return false;
    double units = 4294967295.0 - (double)(side * side);
    for (size_t x = 0; x <= side; ++x)
        sums[x] = 0;
    for (size_t y = 0; y < side; ++y) {
        const uint *above = sums + y * (side + 1);
        uint *row = sums + (y + 1) * (side + 1), sum = 0;
        row[0] = 0;
        for (size_t x = 0; x < side; ++x) {
            sum += 1u + (uint)floor((double)r->radiant[y * side + x] / radiant * units * (1.0 - 1e-9));
            row[x + 1] = above[x + 1] + sum;
        }
    }
    return true;
}

static bool tables_add(Scene *scene, const Rectified *r, double flux, Error *error)
{
    size_t cells = (size_t)r->side * r->side;
    double radiant = total(r->radiant, cells);
    if (!(radiant > 0.0))
        return true;
    LightDetail *light = scene_light_detail(scene, &ARRAY_AT(&scene->lights, Light, r->light));
    Portal *portal = &ARRAY_AT(&scene->portals, Portal, light->portal);
    portal->columns = portal->rows = r->side;
    for (size_t i = 0; i < cells; ++i)
        r->flux[i] += (float)(EVEN_PART * flux / (double)cells);
    light->distribution = (uint)scene->distributions2d.count;
    Distribution2D *out = array_grow(&scene->distributions2d, 1, error);
    return out && sums_add(scene, r, radiant, &portal->sums, error) &&
           distribution2d_build(r->flux, r->side, r->side, &scene->lookup, out, error);
}

/* ---- entry point ------------------------------------------------------------------------------------------------- */

static uint side_choose(const Scene *scene, const LightDetail *light)
{
    if (light->image == NONE)
        return CONSTANT_SIDE;
    uint height = ARRAY_AT(&scene->images, TextureImage, light->image).height;
    return height < SIDE_MIN ? SIDE_MIN : height > PORTAL_SIDE_MAX ? PORTAL_SIDE_MAX : height;
}

static bool rectified_fill(Rectified *r, Error *error)
{
    parallel_run(r->side, processors_usable(), row_fill, r);
    for (uint y = 0; y < r->side; ++y)
        if (!r->finite[y]) {
            error_set(error, "the environment behind a portal is not finite");
            return error_fix(error, "repair its image, or clamp the values below 1e30");
        }
    return true;
}

bool portal_setup(Scene *scene, uint light, double *flux, Error *error)
{
    const LightDetail *source = scene_light_detail(scene, &ARRAY_AT(&scene->lights, Light, light));
    Rectified r = {.light = light,
                   .side = side_choose(scene, source),
                   .portal = ARRAY_AT(&scene->portals, Portal, source->portal)};
    r.view = (SceneView){.frame = &scene->frame,
                         .features = ~(ulong)0,
                         .images = scene->images.data,
                         .lights = scene->lights.data,
                         .light_details = scene->light_details.data,
                         .lookup = scene->lookup.data,
                         .texels = scene->texels.data};
    size_t cells = (size_t)r.side * r.side;
    r.radiant = malloc(2 * cells * sizeof *r.radiant);
    r.finite = calloc(r.side, sizeof *r.finite);
    bool ok = r.radiant && r.finite;
    if (!ok)
        error_memory(error, 2 * cells * sizeof *r.radiant, "a portal");
    r.flux = ok ? r.radiant + cells : NULL;
    ok = ok && rectified_fill(&r, error);
    if (ok) {
        double passing = total(r.flux, cells);
        *flux = passing / (double)cells * (double)r.portal.width * (double)r.portal.height;
        ok = tables_add(scene, &r, passing, error);
    }
    free(r.radiant);
    free(r.finite);
    return ok;
}
