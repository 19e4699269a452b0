#include "scene/primitive_area.h"

#include "base/matrix.h"

#include <math.h>

static double length3(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void edge3(Vec3 from, Vec3 to, double out[3])
{
    out[0] = (double)to.x - (double)from.x;
    out[1] = (double)to.y - (double)from.y;
    out[2] = (double)to.z - (double)from.z;
}

double triangle_area(Vec3 a, Vec3 b, Vec3 c)
{
    double ab[3], ac[3], n[3];
    edge3(a, b, ab);
    edge3(a, c, ac);
    vector_cross(ab, ac, n);
    return 0.5 * length3(n);
}

bool triangle_degenerate(Vec3 a, Vec3 b, Vec3 c)
{
    Vec3 n = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
    return !(vec3_length_squared(n) > 0.0f) || !(triangle_area(a, b, c) > 0.0);
}

/* Factor by which the affine transform scales the area element with object-space normal n: |det M| |M^-T n|. */
static double area_stretch(const Quadric *quadric, const double n[3])
{
    const float *m = quadric->world_from_object.m;
    const float *w = quadric->object_from_world.m;
    double a[3] = {(double)m[0], (double)m[4], (double)m[8]};
    double b[3] = {(double)m[1], (double)m[5], (double)m[9]};
    double c[3] = {(double)m[2], (double)m[6], (double)m[10]};
    double bc[3], transformed[3];
    vector_cross(b, c, bc);
    double determinant = a[0] * bc[0] + a[1] * bc[1] + a[2] * bc[2];
    for (int j = 0; j < 3; ++j)
        transformed[j] = (double)w[j] * n[0] + (double)w[4 + j] * n[1] + (double)w[8 + j] * n[2];
    return fabs(determinant) * length3(transformed);
}

/* Area by the midpoint rule with steps x steps points. */
static double sphere_area(const Quadric *quadric, int steps)
{
    double r = (double)quadric->radius;
    double low = fmax(-r, (double)quadric->z_min), high = fmin(r, (double)quadric->z_max);
    double sum = 0.0;
    if (!(high > low) || !(quadric->phi_max > 0.0f))
        return 0.0;
    for (int j = 0; j < steps; ++j)
        for (int i = 0; i < steps; ++i) {
            double z = (low + (high - low) * (j + 0.5) / steps) / r;
            double phi = (double)quadric->phi_max * (i + 0.5) / steps;
            double s = sqrt(fmax(0.0, 1.0 - z * z));
            double n[3] = {s * cos(phi), s * sin(phi), z};
            sum += area_stretch(quadric, n);
        }
    return (double)quadric->phi_max * r * (high - low) * sum / (steps * steps);
}

static double disk_area(const Quadric *quadric)
{
    double n[3] = {0.0, 0.0, 1.0};
    double r = (double)quadric->radius, inner = (double)quadric->inner_radius;
    return 0.5 * (double)quadric->phi_max * fmax(0.0, r * r - inner * inner) * area_stretch(quadric, n);
}

/* Area by the midpoint rule with `steps` points around the axis. */
static double cylinder_area(const Quadric *quadric, int steps)
{
    double sum = 0.0, height = (double)quadric->z_max - (double)quadric->z_min;
    for (int i = 0; i < steps; ++i) {
        double phi = (double)quadric->phi_max * (i + 0.5) / steps;
        double n[3] = {cos(phi), sin(phi), 0.0};
        sum += area_stretch(quadric, n);
    }
    return (double)quadric->phi_max * (double)quadric->radius * fmax(0.0, height) * sum / steps;
}

double quadric_area(const Quadric *quadric, uint kind, int steps)
{
    if (kind == PRIMITIVE_CYLINDER)
        return cylinder_area(quadric, steps);
    return kind == PRIMITIVE_SPHERE ? sphere_area(quadric, steps) : disk_area(quadric);
}

double patch_area(const Vec3 *positions, const Patch *patch)
{
    enum { STEPS = 16 };
    Vec3 p00 = positions[patch->v[0]], p10 = positions[patch->v[1]];
    Vec3 p01 = positions[patch->v[2]], p11 = positions[patch->v[3]];
    double du0[3], du1[3], dv0[3], dv1[3], sum = 0.0;
    edge3(p00, p10, du0);
    edge3(p01, p11, du1);
    edge3(p00, p01, dv0);
    edge3(p10, p11, dv1);
    for (int j = 0; j < STEPS; ++j)
        for (int i = 0; i < STEPS; ++i) {
            double u = (i + 0.5) / STEPS, v = (j + 0.5) / STEPS, du[3], dv[3], n[3];
            for (int k = 0; k < 3; ++k) {
                du[k] = (1.0 - v) * du0[k] + v * du1[k];
                dv[k] = (1.0 - u) * dv0[k] + u * dv1[k];
            }
            vector_cross(du, dv, n);
            sum += length3(n);
        }
    return sum / (STEPS * STEPS);
}
