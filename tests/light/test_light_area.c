/* Sampling of area lights: points from light_sample against light_pdf_w, on every shape.
 * Each shape is described a second time, in double, by a map from the unit square onto its visible surface. The
 * expected number of samples in a cell of the square is the integral of light_pdf_w |cos| / distance^2 over the cell's
 * surface; the cell of a sample is found by inverting the map. */
#include "light/test_light.h"
#include "support/light_fixture.h"

enum { GRID = 10, SUB = 24, SAMPLES = 40000 };

/* Fourteen cases, each with a chance of failure of 1e-3 / 14 (Sidak: 1e-3 overall). */
#define P_MIN (1e-3 / 14.0)

typedef struct AreaShape {
    uint kind;
    Quadric quadric;
    double matrix[16];
    double corners[4][3];
    double ref[3];
    bool cone; /* a full sphere seen from outside: only the cap is visible */
} AreaShape;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void transform(const double m[16], const double p[3], double out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3];
}

/* An orthonormal basis whose third axis points from the sphere's centre to ref; *distance is that to ref. */
static void cap_basis(const AreaShape *s, double axes[3][3], double *distance)
{
    double center[3] = {s->matrix[3], s->matrix[7], s->matrix[11]};
    for (int i = 0; i < 3; ++i)
        axes[2][i] = s->ref[i] - center[i];
    *distance = sqrt(dot(axes[2], axes[2]));
    for (int i = 0; i < 3; ++i)
        axes[2][i] /= *distance;
    double helper[3] = {fabs(axes[2][0]) < 0.6, fabs(axes[2][0]) >= 0.6, 0.0};
    cross(helper, axes[2], axes[0]);
    double length = sqrt(dot(axes[0], axes[0]));
    for (int i = 0; i < 3; ++i)
        axes[0][i] /= length;
    cross(axes[2], axes[0], axes[1]);
}

static double world_radius(const AreaShape *s)
{
    return (double)s->quadric.radius *
           sqrt(s->matrix[0] * s->matrix[0] + s->matrix[4] * s->matrix[4] + s->matrix[8] * s->matrix[8]);
}

static void cap_point(const AreaShape *s, double a, double b, double out[3])
{
    double axes[3][3], distance, radius = world_radius(s);
    cap_basis(s, axes, &distance);
    double low = radius / distance, z = low + (1.0 - low) * a, r = sqrt(1.0 - z * z), phi = 2.0 * M_PI * b;
    for (int i = 0; i < 3; ++i)
        out[i] =
            s->matrix[4 * i + 3] + radius * (r * cos(phi) * axes[0][i] + r * sin(phi) * axes[1][i] + z * axes[2][i]);
}

static void shape_point(const AreaShape *s, double a, double b, double out[3])
{
    const Quadric *q = &s->quadric;
    double radius = (double)q->radius, inner = (double)q->inner_radius, phi = (double)q->phi_max * b, p[3];
    if (s->kind == PRIMITIVE_TRIANGLE) {
        double root = sqrt(a), w[3] = {1.0 - root, root * (1.0 - b), root * b};
        for (int i = 0; i < 3; ++i)
            out[i] = w[0] * s->corners[0][i] + w[1] * s->corners[1][i] + w[2] * s->corners[2][i];
    } else if (s->kind == PRIMITIVE_BILINEAR) {
        for (int i = 0; i < 3; ++i)
            out[i] = (1.0 - a) * (1.0 - b) * s->corners[0][i] + a * (1.0 - b) * s->corners[1][i] +
                     (1.0 - a) * b * s->corners[2][i] + a * b * s->corners[3][i];
    } else if (s->cone) {
        cap_point(s, a, b, out);
    } else if (s->kind == PRIMITIVE_SPHERE) {
        double z = (double)q->z_min + a * ((double)q->z_max - (double)q->z_min), r = sqrt(radius * radius - z * z);
        p[0] = r * cos(phi);
        p[1] = r * sin(phi);
        p[2] = z;
        transform(s->matrix, p, out);
    } else if (s->kind == PRIMITIVE_CYLINDER) {
        p[0] = radius * cos(phi);
        p[1] = radius * sin(phi);
        p[2] = (double)q->z_min + a * ((double)q->z_max - (double)q->z_min);
        transform(s->matrix, p, out);
    } else {
        double r = inner + a * (radius - inner);
        p[0] = r * cos(phi);
        p[1] = r * sin(phi);
        p[2] = (double)q->z_min;
        transform(s->matrix, p, out);
    }
}

static double turn(double y, double x, double phi_max)
{
    double phi = atan2(y, x);
    return (phi < 0.0 ? phi + 2.0 * M_PI : phi) / phi_max;
}

/* Newton's method on the squared distance. */
static void patch_invert(const AreaShape *s, const double p[3], double ab[2])
{
    ab[0] = ab[1] = 0.5;
    for (int step = 0; step < 30; ++step) {
        double at[3], da[3], db[3], moved[3], h = 1e-6;
        shape_point(s, ab[0], ab[1], at);
        shape_point(s, ab[0] + h, ab[1], moved);
        for (int i = 0; i < 3; ++i)
            da[i] = (moved[i] - at[i]) / h;
        shape_point(s, ab[0], ab[1] + h, moved);
        for (int i = 0; i < 3; ++i) {
            db[i] = (moved[i] - at[i]) / h;
            at[i] = p[i] - at[i];
        }
        double aa = dot(da, da), bb = dot(db, db), m = dot(da, db), x = dot(da, at), y = dot(db, at);
        double determinant = aa * bb - m * m;
        ab[0] += (x * bb - y * m) / determinant;
        ab[1] += (y * aa - x * m) / determinant;
    }
}

static void shape_invert(const AreaShape *s, const double p[3], double ab[2])
{
    const Quadric *q = &s->quadric;
    double inverse[16], local[3], axes[3][3], distance;
    if (s->kind == PRIMITIVE_TRIANGLE) {
        double e[3], f[3], g[3];
        for (int i = 0; i < 3; ++i) {
            e[i] = s->corners[1][i] - s->corners[0][i];
            f[i] = s->corners[2][i] - s->corners[0][i];
            g[i] = p[i] - s->corners[0][i];
        }
        double ee = dot(e, e), ff = dot(f, f), ef = dot(e, f), ge = dot(g, e), gf = dot(g, f);
        double w1 = (ge * ff - gf * ef) / (ee * ff - ef * ef), w2 = (gf * ee - ge * ef) / (ee * ff - ef * ef);
        ab[0] = (w1 + w2) * (w1 + w2);
        ab[1] = w2 / (w1 + w2);
    } else if (s->kind == PRIMITIVE_BILINEAR) {
        patch_invert(s, p, ab);
    } else if (s->cone) {
        cap_basis(s, axes, &distance);
        double low = world_radius(s) / distance, d[3];
        for (int i = 0; i < 3; ++i)
            d[i] = p[i] - s->matrix[4 * i + 3];
        double length = sqrt(dot(d, d)); /* not the radius, whose rounding would move points near the pole */
        for (int i = 0; i < 3; ++i)
            d[i] /= length;
        ab[0] = (dot(d, axes[2]) - low) / (1.0 - low);
        ab[1] = turn(dot(d, axes[1]), dot(d, axes[0]), 2.0 * M_PI);
    } else {
        test_matrix_inverse(s->matrix, inverse);
        transform(inverse, p, local);
        double r = hypot(local[0], local[1]), low = (double)q->z_min, inner = (double)q->inner_radius;
        ab[0] = s->kind != PRIMITIVE_DISK ? (local[2] - low) / ((double)q->z_max - low)
                                          : (r - inner) / ((double)q->radius - inner);
        ab[1] = turn(local[1], local[0], (double)q->phi_max);
    }
}

static Vec3 to_vec3(const double p[3])
{
    return vec3((float)p[0], (float)p[1], (float)p[2]);
}

/* light_pdf_w times projected solid angle, per unit of (a, b). */
static double shape_density(const LightFixture *f, const AreaShape *s, double a, double b)
{
    double p[3], low[3], high[3], da[3], db[3], n[3], w[3], h = 1e-5;
    shape_point(s, a, b, p);
    shape_point(s, a - h, b, low);
    shape_point(s, a + h, b, high);
    for (int i = 0; i < 3; ++i)
        da[i] = (high[i] - low[i]) / (2.0 * h);
    shape_point(s, a, b - h, low);
    shape_point(s, a, b + h, high);
    for (int i = 0; i < 3; ++i) {
        db[i] = (high[i] - low[i]) / (2.0 * h);
        w[i] = p[i] - s->ref[i];
    }
    cross(da, db, n);
    double area = sqrt(dot(n, n)), distance = sqrt(dot(w, w));
    Surface hit = {.p = to_vec3(p), .ng = vec3_scale(to_vec3(n), (float)(1.0 / area)), .u = (float)a, .v = (float)b};
    Vec3 wi = vec3_normalize(to_vec3(w));
    double pdf = (double)light_pdf_w(&f->view, 0, to_vec3(s->ref), wi, &hit);
    return pdf * fabs(dot(n, w)) / (distance * distance * distance);
}

static void expected_counts(const LightFixture *f, const AreaShape *s, double *expected)
{
    for (int i = 0; i < GRID * GRID; ++i)
        expected[i] = 0.0;
    for (int y = 0; y < GRID * SUB; ++y)
        for (int x = 0; x < GRID * SUB; ++x)
            expected[y / SUB * GRID + x / SUB] +=
                shape_density(f, s, (x + 0.5) / (GRID * SUB), (y + 0.5) / (GRID * SUB)) / (GRID * SUB * GRID * SUB);
}

/* The sample's density must equal light_pdf_w at its point, and the point must lie on the shape. */
static void check_sample(const LightFixture *f, const AreaShape *s, const LightSample *sample, const double ab[2])
{
    double p[3], distance = (double)vec3_length(vec3_sub(sample->p, to_vec3(s->ref)));
    shape_point(s, ab[0], ab[1], p);
    ck_assert_double_lt((double)vec3_length(vec3_sub(sample->p, to_vec3(p))), 3e-6 * (1.0 + distance));
    Surface hit = {.p = sample->p, .ng = sample->ng, .u = (float)ab[0], .v = (float)ab[1]};
    double pdf = (double)light_pdf_w(&f->view, 0, to_vec3(s->ref), sample->wi, &hit);
    ck_assert_double_eq_tol(pdf / (double)sample->pdf_w, 1.0, 1e-5);
    ck_assert_double_eq_tol((double)vec3_length(sample->wi), 1.0, 1e-6);
    ck_assert_double_eq_tol((double)vec3_length(sample->ng), 1.0, 1e-6);
}

/* The ray toward the sample hits the light at the same point with the same normal, and light_pdf_w there equals the
 * sample's density. Returns false if a closer point of the shape is hit. */
static bool check_ray(const LightFixture *f, const AreaShape *s, const LightSample *sample)
{
    Ray ray = {.o = to_vec3(s->ref), .d = sample->wi, .t_max = FLOAT_MAX};
    RayQuery query = ray_query(ray);
    Hit hit = hit_none(FLOAT_MAX);
    float distance = vec3_length(vec3_sub(sample->p, ray.o)), grazing = float_abs(vec3_dot(sample->ng, sample->wi));
    if (grazing < 0.02f || !primitive_intersect(&f->view, 0, NONE, &query, &hit) || hit.t < 0.999f * distance)
        return false;
    Surface surface = surface_from_hit(&f->view, &ray, hit);
    ck_assert_double_lt((double)vec3_length(vec3_sub(surface.p, sample->p)), 1e-5 / (double)grazing);
    ck_assert_double_gt((double)vec3_dot(surface.ng, sample->ng), 1.0 - 1e-5);
    double pdf = (double)light_pdf_w(&f->view, 0, ray.o, ray.d, &surface);
    ck_assert_double_eq_tol(pdf / (double)sample->pdf_w, 1.0, 1e-4 / (double)grazing);
    return true;
}

static void check_shape(const char *name, const AreaShape *s)
{
    LightFixture f;
    fixture_init(&f);
    if (s->kind == PRIMITIVE_TRIANGLE || s->kind == PRIMITIVE_BILINEAR) {
        float positions[12];
        for (int i = 0; i < 12; ++i)
            positions[i] = (float)s->corners[i / 3][i % 3];
        fixture_add_polygon(&f, positions, s->kind == PRIMITIVE_TRIANGLE ? 3 : 4, NULL, 0, LIGHT_TWO_SIDED);
    } else {
        fixture_add_quadric(&f, s->kind, s->quadric, s->matrix, 1.0f, 0, LIGHT_TWO_SIDED);
    }
    fixture_finish(&f);
    double expected[GRID * GRID], observed[GRID * GRID] = {0.0}, total = 0.0;
    expected_counts(&f, s, expected);
    for (int i = 0; i < GRID * GRID; ++i) {
        total += expected[i];
        expected[i] *= SAMPLES;
    }
    ck_assert_msg(fabs(total - 1.0) < 5e-4, "%s: light_pdf_w integrates to %g", name, total);
    int met = 0;
    for (uint i = 0; i < SAMPLES; ++i) {
        LightSample sample;
        ck_assert(light_sample(&f.view, 0, to_vec3(s->ref), fixture_random(3, i), &sample));
        double p[3] = {(double)sample.p.x, (double)sample.p.y, (double)sample.p.z}, ab[2];
        shape_invert(s, p, ab);
        if (i % 64 == 0)
            check_sample(&f, s, &sample, ab);
        met += i % 64 == 0 && check_ray(&f, s, &sample);
        int x = (int)fmin(fmax(ab[0] * GRID, 0.0), GRID - 1), y = (int)fmin(fmax(ab[1] * GRID, 0.0), GRID - 1);
        observed[y * GRID + x] += 1.0;
    }
    ck_assert_msg(met > SAMPLES / 64 / 4, "%s: %d samples seen", name, met);
    double p_value = test_chi_square(observed, expected, GRID * GRID);
    ck_assert_msg(p_value > P_MIN, "%s: chi-square p = %g", name, p_value);
    fixture_destroy(&f);
}

#define SHEAR                                                                                                          \
    {                                                                                                                  \
        1.0, 0.4, -0.2, 0.5, 0.0, 0.7, 0.3, -1.0, 0.1, 0.0, 1.6, 2.0, 0.0, 0.0, 0.0, 1.0                               \
    }
#define SHIFT                                                                                                          \
    {                                                                                                                  \
        0.0, 2.0, 0.0, 0.5, -2.0, 0.0, 0.0, -1.0, 0.0, 0.0, 2.0, 2.0, 0.0, 0.0, 0.0, 1.0                               \
    }
#define TAU_F 6.28318531f

START_TEST(test_triangle)
{
    AreaShape s = {.kind = PRIMITIVE_TRIANGLE,
                   .corners = {{1.0, 0.0, 0.5}, {2.0, 1.0, 0.0}, {0.0, 1.5, -0.5}},
                   .ref = {0.2, -0.3, 1.0}};
    check_shape("triangle", &s);
}
END_TEST

START_TEST(test_patch)
{
    AreaShape flat = {.kind = PRIMITIVE_BILINEAR,
                      .corners = {{1.0, 0.0, 0.5}, {2.0, 1.0, 0.0}, {0.0, 1.0, 1.0}, {1.0, 2.0, 0.5}},
                      .ref = {0.2, -0.3, 2.0}};
    check_shape("parallelogram", &flat);
    AreaShape bent = flat;
    bent.corners[3][0] = 2.5;
    bent.corners[3][2] = -1.0;
    check_shape("bilinear patch", &bent);
}
END_TEST

START_TEST(test_sphere_outside)
{
    AreaShape s = {.kind = PRIMITIVE_SPHERE,
                   .quadric = {.radius = 0.5f, .z_min = -0.5f, .z_max = 0.5f, .phi_max = TAU_F},
                   .matrix = SHIFT,
                   .ref = {3.0, -2.0, 3.5},
                   .cone = true};
    check_shape("sphere from outside", &s);
    s.ref[0] = 1.0;
    s.ref[1] = -0.9;
    s.ref[2] = 3.0;
    check_shape("sphere from close by", &s);
}
END_TEST

START_TEST(test_sphere_inside)
{
    AreaShape s = {.kind = PRIMITIVE_SPHERE,
                   .quadric = {.radius = 0.5f, .z_min = -0.5f, .z_max = 0.5f, .phi_max = TAU_F},
                   .matrix = SHIFT,
                   .ref = {0.7, -1.2, 2.3}};
    check_shape("sphere from inside", &s);
}
END_TEST

START_TEST(test_sphere_sheared)
{
    AreaShape s = {.kind = PRIMITIVE_SPHERE,
                   .quadric = {.radius = 1.2f, .z_min = -1.2f, .z_max = 1.2f, .phi_max = TAU_F},
                   .matrix = SHEAR,
                   .ref = {3.0, -4.0, 3.5}};
    check_shape("ellipsoid", &s);
    s.quadric.z_min = -0.3f;
    s.quadric.z_max = 0.9f;
    s.quadric.phi_max = 4.0f;
    check_shape("part of an ellipsoid", &s);
    AreaShape part = {.kind = PRIMITIVE_SPHERE, .quadric = s.quadric, .matrix = SHIFT, .ref = {3.0, -4.0, 3.5}};
    check_shape("part of a sphere", &part);
}
END_TEST

START_TEST(test_disk)
{
    AreaShape s = {.kind = PRIMITIVE_DISK,
                   .quadric = {.radius = 1.2f, .z_min = 0.4f, .phi_max = TAU_F},
                   .matrix = SHIFT,
                   .ref = {2.0, -2.0, 4.0}};
    check_shape("disk", &s);
    s.quadric.inner_radius = 0.7f;
    s.quadric.phi_max = 2.5f;
    check_shape("part of a ring", &s);
    AreaShape sheared = {.kind = PRIMITIVE_DISK, .quadric = s.quadric, .matrix = SHEAR, .ref = {2.0, -2.0, 4.0}};
    check_shape("part of a sheared ring", &sheared);
}
END_TEST

START_TEST(test_cylinder)
{
    AreaShape s = {.kind = PRIMITIVE_CYLINDER,
                   .quadric = {.radius = 0.6f, .z_min = -0.3f, .z_max = 0.9f, .phi_max = TAU_F},
                   .matrix = SHIFT,
                   .ref = {3.0, -4.0, 3.5}};
    check_shape("cylinder", &s);
    AreaShape part = {.kind = PRIMITIVE_CYLINDER, .quadric = s.quadric, .matrix = SHEAR, .ref = {0.6, -1.1, 2.5}};
    part.quadric.phi_max = 4.0f;
    check_shape("part of a sheared cylinder from inside", &part);
}
END_TEST

TCase *light_area_case(void)
{
    TCase *tcase = tcase_create("area lights");
    tcase_set_timeout(tcase, 60);
    tcase_add_test(tcase, test_triangle);
    tcase_add_test(tcase, test_patch);
    tcase_add_test(tcase, test_sphere_outside);
    tcase_add_test(tcase, test_sphere_inside);
    tcase_add_test(tcase, test_sphere_sheared);
    tcase_add_test(tcase, test_disk);
    tcase_add_test(tcase, test_cylinder);
    return tcase;
}
