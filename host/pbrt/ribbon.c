#include "pbrt/ribbon.h"

#include "base/matrix.h"

#include <math.h>
#include <stdlib.h>

/* Patches per segment: at most 2^this. */
#define RIBBON_LEVELS_MAX 6

/* Deviation of patches from the ribbon, relative to its width, and by how much the normal may turn within one
 * (radians). */
#define RIBBON_FLATNESS 0.05
#define RIBBON_TURN 0.1

/* A mesh under construction. */
typedef struct Ribbon {
    float *positions, *normals, *uvs;
    uint *indices;
    size_t vertex_count, patch_count;
} Ribbon;

static void normal_get(const float *normal, double out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = (double)normal[i];
    vector_normalize(out);
}

static double vectors_angle(const double a[3], const double b[3])
{
    return acos(fmin(fmax(a[0] * b[0] + a[1] * b[1] + a[2] * b[2], -1.0), 1.0));
}

/* The normal at u between those at both ends of a segment (Shoemake 1985). */
static void normal_between(const float *normals, double u, double out[3])
{
    double a[3], b[3];
    normal_get(normals, a);
    normal_get(normals + 3, b);
    double angle = vectors_angle(a, b), whole = sin(angle);
    bool turns = angle > 1e-6 && whole > 1e-6;
    double at_a = turns ? sin((1.0 - u) * angle) / whole : 1.0 - u, at_b = turns ? sin(u * angle) / whole : u;
    for (int i = 0; i < 3; ++i)
        out[i] = at_a * a[i] + at_b * b[i];
    vector_normalize(out);
}

/* Levels of division of a segment. The deviation of a cubic from its chord is below 3/4 of the second differences of
 * its control points, and each level divides it by four. */
static int segment_levels(const Curve *s, const float *normals)
{
    double a[3], b[3], bend = 0.0;
    normal_get(normals, a);
    normal_get(normals + 3, b);
    for (int i = 0; i < 2; ++i) {
        Vec3 second = vec3_add(vec3_sub(s->p[i], vec3_scale(s->p[i + 1], 2.0f)), s->p[i + 2]);
        bend = fmax(bend, (double)vec3_length(second));
    }
    double width = fmax((double)fmaxf(s->width[0], s->width[1]), 1e-30);
    double curved = 0.5 * log2(fmax(0.75 * bend / (RIBBON_FLATNESS * width), 1.0));
    double turned = log2(fmax(vectors_angle(a, b) / RIBBON_TURN, 1.0));
    return (int)fmin(ceil(fmax(curved, turned)), RIBBON_LEVELS_MAX);
}

/* Point and derivative of the segment. */
static void segment_point(const Curve *s, double u, double p[3], double d[3])
{
    double w = 1.0 - u, c[4][3];
    for (int k = 0; k < 4; ++k) {
        c[k][0] = (double)s->p[k].x;
        c[k][1] = (double)s->p[k].y;
        c[k][2] = (double)s->p[k].z;
    }
    for (int i = 0; i < 3; ++i) {
        double a = c[0][i], b = c[1][i], e = c[2][i], f = c[3][i];
        p[i] = w * w * w * a + 3.0 * w * w * u * b + 3.0 * w * u * u * e + u * u * u * f;
        d[i] = w * w * (b - a) + 2.0 * w * u * (e - b) + u * u * (f - e);
        if (w * w * fabs(b - a) + w * u * fabs(e - b) + u * u * fabs(f - e) == 0.0)
            d[i] = f - a;
    }
}

/* Appends the two vertices at u of a segment. Seen from where the normal points to, v is as on other curves. */
static void vertices_add(Ribbon *ribbon, const Curve *s, const float *normals, double u)
{
    double p[3], d[3], n[3], across[3], normal[3];
    double half = 0.5 * ((1.0 - u) * (double)s->width[0] + u * (double)s->width[1]);
    segment_point(s, u, p, d);
    normal_between(normals, u, n);
    vector_cross(n, d, across);
    vector_normalize(across);
    vector_cross(d, across, normal);
    vector_normalize(normal);
    for (int side = 0; side < 2; ++side) {
        size_t v = ribbon->vertex_count++;
        for (size_t i = 0; i < 3; ++i) {
            ribbon->positions[3 * v + i] = (float)(p[i] + (side == 0 ? -half : half) * across[i]);
            ribbon->normals[3 * v + i] = (float)normal[i];
        }
        ribbon->uvs[2 * v] = (float)u;
        ribbon->uvs[2 * v + 1] = 1.0f - (float)side;
    }
}

static void segment_add(Ribbon *ribbon, const Curve *s, const float *normals)
{
    int patches = 1 << segment_levels(s, normals);
    for (int i = 0; i <= patches; ++i) {
        uint v = (uint)ribbon->vertex_count;
        vertices_add(ribbon, s, normals, (double)i / patches);
        if (i == patches)
            break;
        uint *corner = ribbon->indices + 4 * ribbon->patch_count++;
        corner[0] = v;
        corner[1] = v + 2;
        corner[2] = v + 1;
        corner[3] = v + 3;
    }
}

static void ribbon_destroy(Ribbon *ribbon)
{
    free(ribbon->positions);
    free(ribbon->normals);
    free(ribbon->uvs);
    free(ribbon->indices);
}

static bool ribbon_create(Ribbon *ribbon, size_t patches, size_t segments, Error *error)
{
    size_t vertices = 2 * (patches + segments) + 1;
    *ribbon = (Ribbon){.positions = malloc(3 * vertices * sizeof(float)),
                       .normals = malloc(3 * vertices * sizeof(float)),
                       .uvs = malloc(2 * vertices * sizeof(float)),
                       .indices = malloc((4 * patches + 1) * sizeof(uint))};
    if (ribbon->positions && ribbon->normals && ribbon->uvs && ribbon->indices)
        return true;
    ribbon_destroy(ribbon);
    error_memory(error, 8 * vertices * sizeof(float), "a ribbon");
    return false;
}

bool ribbon_add(PbrtImport *im, const ShapeContext *context, const Curve *segments, size_t count, const float *normals)
{
    Ribbon ribbon;
    size_t patches = 0;
    if (!context->has_inverse) {
        error_at(im->error, context->place, "the current transform cannot be inverted, and the ribbon has normals");
        return error_fix(im->error, "look for a Scale by 0, or use a curve of the type \"flat\"");
    }
    for (size_t i = 0; i < count; ++i)
        patches += (size_t)1 << segment_levels(&segments[i], &normals[3 * i]);
    if (!ribbon_create(&ribbon, patches, count, im->error))
        return false;
    for (size_t i = 0; i < count; ++i)
        segment_add(&ribbon, &segments[i], &normals[3 * i]);
    MeshData mesh = {.uvs = ribbon.uvs,
                     .vertex_count = ribbon.vertex_count,
                     .indices = ribbon.indices,
                     .triangle_count = ribbon.patch_count};
    bool good = shape_add_mesh(im, context, PRIMITIVE_BILINEAR, ribbon.positions, ribbon.normals, &mesh);
    ribbon_destroy(&ribbon);
    return good;
}
