/* Emission from area lights: points and directions against their densities, on every shape.
 * Each shape is described a second time, in double, by a map from the unit square onto its surface under which sampled
 * points must be uniform. A point is mapped back by inverting the map; one over its density must be the area scaling of
 * the map there. */
#include "light/emit.h"
#include "light/test_emit.h"
#include "support/light_fixture.h"

enum { GRID = 8, SAMPLES = 20000 };

typedef struct EmitShape {
    uint kind;
    uint flags; /* of the light */
    uint shape_flags;
    Quadric quadric;
    double matrix[16];
    float corners[12];
} EmitShape;

#define TWO_PI_F 6.28318531f
#define IDENTITY                                                                                                       \
    {                                                                                                                  \
        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1                                                                 \
    }
#define SHEARED                                                                                                        \
    {                                                                                                                  \
        1.5, 0.3, 0, 2, -0.2, 0.8, 0.4, 1, 0.1, 0, -2, 5, 0, 0, 0, 1                                                   \
    }

static const EmitShape SHAPES[] = {
    {.kind = PRIMITIVE_TRIANGLE, .corners = {0, 0, 0, 3, 0, 1, 1, 2, -1}},
    {.kind = PRIMITIVE_TRIANGLE,
     .flags = LIGHT_TWO_SIDED,
     .shape_flags = SHAPE_FLIP_NORMAL,
     .corners = {5, 0, 0, 5, 1, 0, 5, 0, 100}},
    {.kind = PRIMITIVE_BILINEAR, .corners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}},
    {.kind = PRIMITIVE_BILINEAR, .flags = LIGHT_TWO_SIDED, .corners = {0, 0, 0, 2, 0, 1, 0, 3, 1, 1, 2, -1}},
    {.kind = PRIMITIVE_SPHERE,
     .quadric = {.radius = 2, .z_min = -2, .z_max = 2, .phi_max = TWO_PI_F},
     .matrix = IDENTITY},
    {.kind = PRIMITIVE_SPHERE,
     .flags = LIGHT_TWO_SIDED,
     .shape_flags = SHAPE_FLIP_NORMAL,
     .quadric = {.radius = 2, .z_min = -1, .z_max = 1.5f, .phi_max = 4},
     .matrix = SHEARED},
    {.kind = PRIMITIVE_SPHERE,
     .quadric = {.radius = 1, .z_min = -1, .z_max = 1, .phi_max = TWO_PI_F},
     .matrix = SHEARED},
    {.kind = PRIMITIVE_DISK,
     .quadric = {.radius = 2, .inner_radius = 0.5f, .z_min = 0.3f, .phi_max = 5},
     .matrix = SHEARED},
    {.kind = PRIMITIVE_DISK,
     .flags = LIGHT_TWO_SIDED,
     .quadric = {.radius = 1, .phi_max = TWO_PI_F},
     .matrix = IDENTITY},
    {.kind = PRIMITIVE_CYLINDER,
     .quadric = {.radius = 1.5f, .z_min = -1, .z_max = 2, .phi_max = TWO_PI_F},
     .matrix = IDENTITY},
    {.kind = PRIMITIVE_CYLINDER,
     .flags = LIGHT_TWO_SIDED,
     .shape_flags = SHAPE_FLIP_NORMAL,
     .quadric = {.radius = 0.5f, .z_min = 0.3f, .z_max = 4, .phi_max = 4},
     .matrix = SHEARED},
};
enum { SHAPE_COUNT = sizeof SHAPES / sizeof *SHAPES };

/* Two chi-square tests per shape (Sidak: 1e-3 overall). */
#define P_MIN (1e-3 / (2.0 * SHAPE_COUNT))

static void setup(LightFixture *f, const EmitShape *s)
{
    fixture_init(f);
    if (s->kind == PRIMITIVE_TRIANGLE || s->kind == PRIMITIVE_BILINEAR)
        fixture_add_polygon(f, s->corners, s->kind == PRIMITIVE_TRIANGLE ? 3 : 4, NULL, s->shape_flags, s->flags);
    else
        fixture_add_quadric(f, s->kind, s->quadric, s->matrix, 1.0f, s->shape_flags, s->flags);
    fixture_finish(f);
}

static void transform(const double m[16], const double p[3], double out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3];
}

/* Bilinear weights of the corners at (a, b). */
static void corner_weights(const EmitShape *s, double a, double b, double w[4])
{
    if (s->kind == PRIMITIVE_TRIANGLE) {
        double b1 = 1.0 - sqrt(1.0 - a), b2 = b * (1.0 - b1);
        w[0] = 1.0 - b1 - b2, w[1] = b1, w[2] = b2, w[3] = 0.0;
    } else {
        w[0] = (1.0 - a) * (1.0 - b), w[1] = a * (1.0 - b), w[2] = (1.0 - a) * b, w[3] = a * b;
    }
}

/* The map from the unit square to the surface. */
static void shape_point(const EmitShape *s, double a, double b, double p[3])
{
    if (s->kind == PRIMITIVE_TRIANGLE || s->kind == PRIMITIVE_BILINEAR) {
        double w[4];
        corner_weights(s, a, b, w);
        for (int k = 0; k < 3; ++k) {
            p[k] = 0.0;
            for (int i = 0; i < 4; ++i)
                p[k] += w[i] * (double)s->corners[3 * i + k];
        }
        return;
    }
    const Quadric *q = &s->quadric;
    double r, z = (double)q->z_min, outer = (double)q->radius, inner = (double)q->inner_radius;
    if (s->kind == PRIMITIVE_SPHERE) {
        z = (1.0 - a) * (double)q->z_min + a * (double)q->z_max;
        r = sqrt(fmax(0.0, outer * outer - z * z));
    } else if (s->kind == PRIMITIVE_CYLINDER) {
        z = (1.0 - a) * (double)q->z_min + a * (double)q->z_max;
        r = outer;
    } else {
        r = sqrt((1.0 - a) * inner * inner + a * outer * outer);
    }
    double phi = b * (double)q->phi_max, local[3] = {r * cos(phi), r * sin(phi), z};
    transform(s->matrix, local, p);
}

/* (a, b) of the bilinear patch's point closest to p, by Gauss-Newton. */
static void patch_invert(const EmitShape *s, const double p[3], double *a, double *b)
{
    *a = *b = 0.5;
    for (int i = 0; i < 20; ++i) {
        const double h = 1e-6;
        double at[3], pa[3], pb[3], aa = 0, ab = 0, bb = 0, ra = 0, rb = 0;
        shape_point(s, *a, *b, at);
        shape_point(s, *a + h, *b, pa);
        shape_point(s, *a, *b + h, pb);
        for (int k = 0; k < 3; ++k) {
            double da = (pa[k] - at[k]) / h, db = (pb[k] - at[k]) / h, r = p[k] - at[k];
            aa += da * da, ab += da * db, bb += db * db, ra += da * r, rb += db * r;
        }
        double determinant = aa * bb - ab * ab;
        *a += (bb * ra - ab * rb) / determinant;
        *b += (aa * rb - ab * ra) / determinant;
    }
}

static void triangle_invert(const EmitShape *s, const double p[3], double *a, double *b)
{
    double e1[3], e2[3], d[3], c11 = 0, c12 = 0, c22 = 0, d1 = 0, d2 = 0;
    for (int k = 0; k < 3; ++k) {
        e1[k] = (double)s->corners[3 + k] - (double)s->corners[k];
        e2[k] = (double)s->corners[6 + k] - (double)s->corners[k];
        d[k] = p[k] - (double)s->corners[k];
        c11 += e1[k] * e1[k], c12 += e1[k] * e2[k], c22 += e2[k] * e2[k], d1 += d[k] * e1[k], d2 += d[k] * e2[k];
    }
    double determinant = c11 * c22 - c12 * c12;
    double b1 = (c22 * d1 - c12 * d2) / determinant, b2 = (c11 * d2 - c12 * d1) / determinant;
    *a = 1.0 - (1.0 - b1) * (1.0 - b1);
    *b = b2 / (1.0 - b1);
}

/* The inverse of the map. */
static void shape_invert(const EmitShape *s, const double p[3], double *a, double *b)
{
    if (s->kind == PRIMITIVE_BILINEAR) {
        patch_invert(s, p, a, b);
    } else if (s->kind == PRIMITIVE_TRIANGLE) {
        triangle_invert(s, p, a, b);
    } else {
        double inverse[16], q[3], outer = (double)s->quadric.radius, inner = (double)s->quadric.inner_radius;
        test_matrix_inverse(s->matrix, inverse);
        transform(inverse, p, q);
        double phi = atan2(q[1], q[0]);
        *b = (phi < 0.0 ? phi + 2.0 * M_PI : phi) / (double)s->quadric.phi_max;
        if (s->kind != PRIMITIVE_DISK)
            *a = (q[2] - (double)s->quadric.z_min) / (double)(s->quadric.z_max - s->quadric.z_min);
        else
            *a = (q[0] * q[0] + q[1] * q[1] - inner * inner) / (outer * outer - inner * inner);
    }
}

/* Area scaling of the map at (a, b); *n: unit normal, on either side. */
static double shape_area(const EmitShape *s, double a, double b, double n[3])
{
    const double h = 1e-6;
    double p[4][3], x[3], y[3], length = 0.0;
    shape_point(s, a - h, b, p[0]);
    shape_point(s, a + h, b, p[1]);
    shape_point(s, a, b - h, p[2]);
    shape_point(s, a, b + h, p[3]);
    for (int k = 0; k < 3; ++k)
        x[k] = (p[1][k] - p[0][k]) / (2.0 * h), y[k] = (p[3][k] - p[2][k]) / (2.0 * h);
    for (int k = 0; k < 3; ++k) {
        n[k] = x[(k + 1) % 3] * y[(k + 2) % 3] - x[(k + 2) % 3] * y[(k + 1) % 3];
        length += n[k] * n[k];
    }
    length = sqrt(length);
    for (int k = 0; k < 3; ++k)
        n[k] /= length;
    return length;
}

static int cell_of(double x, int cells)
{
    return (int)fmin(fmax(x * cells, 0.0), cells - 1);
}

/* Checks the LightEmission against the functions that evaluate it later, and against the map. */
static void check_record(const EmitShape *s, const LightFixture *f, const LightEmission *e, double a, double b)
{
    double n[3];
    TEST_NEAR(vec3_length(e->w), 1.0, 2e-6);
    TEST_NEAR(vec3_length(e->ng), 1.0, 2e-6);
    TEST_NEAR(vec3_dot(e->ng, e->w), e->cosine, 1e-6);
    TEST_TRUE(e->cosine > 0.0f && e->radiance.x == 1.0f);
    TEST_TRUE(e->delta_position == 0u && e->delta_direction == 0u && e->infinite == 0u);
    TEST_TRUE(light_emit_pdf_w(&f->view, 0, e->ng, e->w) == e->pdf_w);
    bool two = (s->flags & LIGHT_TWO_SIDED) != 0u;
    TEST_TRUE(light_emit_pdf_w(&f->view, 0, vec3_negate(e->ng), e->w) == (two ? e->pdf_w : 0.0f));
    Surface hit = {.p = e->p, .ng = e->ng, .u = (float)a, .v = (float)b};
    TEST_NEAR(light_emit_pdf_p(&f->view, 0, &hit) / e->pdf_p, 1.0, 1e-4);
    if (a < 1e-3 || a > 1.0 - 1e-3) /* square roots in the map: finite differences fail */
        return;
    double area = shape_area(s, a, b, n);
    double cosine = n[0] * (double)e->ng.x + n[1] * (double)e->ng.y + n[2] * (double)e->ng.z;
    TEST_NEAR((double)e->pdf_p * area, 1.0, 2e-3);
    TEST_NEAR(fabs(cosine), 1.0, 1e-4);
}

/* The cell of w's hemisphere, on either side: the squared cosine and the angle around the normal must be uniform.
 * `side`: 1 on the back. */
static int direction_cell(const LightEmission *e, int side)
{
    Vec3 local = frame_to_local(frame_from_normal(e->ng), e->w);
    double phi = atan2((double)local.y, (double)local.x) / (2.0 * M_PI) + 0.5;
    return (side * GRID + cell_of((double)(local.z * local.z), GRID)) * GRID + cell_of(phi, GRID);
}

START_TEST(test_points_and_directions)
{
    const EmitShape *s = &SHAPES[_i];
    double points[GRID * GRID] = {0.0}, directions[2 * GRID * GRID] = {0.0}, even[2 * GRID * GRID];
    int sides = (s->flags & LIGHT_TWO_SIDED) != 0u ? 2 : 1;
    LightFixture f;
    LightEmission e;
    setup(&f, s);
    for (uint i = 0; i < SAMPLES; ++i) {
        TEST_TRUE(light_emit(&f.view, 0, fixture_random(1, i), fixture_random(2, i), &e));
        double p[3] = {(double)e.p.x, (double)e.p.y, (double)e.p.z}, back[3], n[3], a, b;
        shape_invert(s, p, &a, &b);
        a = fmin(fmax(a, 0.0), 1.0);
        b = fmin(fmax(b, 0.0), 1.0);
        shape_point(s, a, b, back);
        TEST_TRUE(fabs(p[0] - back[0]) + fabs(p[1] - back[1]) + fabs(p[2] - back[2]) < 1e-4);
        check_record(s, &f, &e, a, b);
        points[cell_of(a, GRID) * GRID + cell_of(b, GRID)] += 1.0;
        shape_area(s, fmin(fmax(a, 1e-3), 1.0 - 1e-3), b, n);
        bool turned = n[0] * (double)e.ng.x + n[1] * (double)e.ng.y + n[2] * (double)e.ng.z < 0.0;
        directions[direction_cell(&e, turned && sides == 2)] += 1.0;
    }
    for (int i = 0; i < 2 * GRID * GRID; ++i)
        even[i] = (double)SAMPLES / (GRID * GRID);
    double p = test_chi_square(points, even, GRID * GRID);
    ck_assert_msg(p > P_MIN, "shape %d: points, p = %g", _i, p);
    for (int i = 0; i < 2 * GRID * GRID; ++i)
        even[i] /= sides;
    p = test_chi_square(directions, even, sides * GRID * GRID);
    ck_assert_msg(p > P_MIN, "shape %d: directions, p = %g", _i, p);
    fixture_destroy(&f);
}
END_TEST

/* One-sided lights emit on the side for which light_emitted is not zero. */
START_TEST(test_sides)
{
    for (int i = 0; i < SHAPE_COUNT; ++i) {
        LightFixture f;
        setup(&f, &SHAPES[i]);
        for (uint k = 0; k < 200; ++k) {
            LightEmission e;
            TEST_TRUE(light_emit(&f.view, 0, fixture_random(1, k), fixture_random(2, k), &e));
            TEST_TRUE(light_emitted(&f.view, 0, e.ng, e.w).x == 1.0f);
        }
        fixture_destroy(&f);
    }
}
END_TEST

/* A light whose surface exists with probability alpha emits alpha times its radiance. */
START_TEST(test_alpha)
{
    for (int hidden = 0; hidden < 2; ++hidden) {
        LightFixture f;
        LightEmission e;
        Error error = {0};
        fixture_init(&f);
        fixture_add_sphere(&f, 1.0f, 0.0, 0.0, 0.0, 2.0f, 0);
        TextureOp *ops = array_grow(&f.scene.texture_ops, 2, &error);
        ops[0].code = TEXTURE_CONSTANT;
        ops[0].value = vec3_splat(hidden ? 0.0f : 0.25f);
        ops[1].code = TEXTURE_END;
        ARRAY_AT(&f.scene.shapes, Shape, 0).alpha = 0;
        ARRAY_AT(&f.scene.primitives, Primitive, 0).shape_and_kind |= PRIMITIVE_ALPHA_BIT;
        fixture_finish(&f);
        f.view.features = ~(ulong)0;
        bool emits = light_emit(&f.view, 0, vec2(0.3f, 0.3f), vec2(0.3f, 0.3f), &e);
        ck_assert(emits == !hidden);
        ck_assert(hidden || e.radiance.x == 0.5f);
        fixture_destroy(&f);
    }
}
END_TEST

TCase *emit_area_case(void)
{
    TCase *tcase = tcase_create("area lights");
    tcase_set_timeout(tcase, 60);
    tcase_add_loop_test(tcase, test_points_and_directions, 0, SHAPE_COUNT);
    tcase_add_test(tcase, test_sides);
    tcase_add_test(tcase, test_alpha);
    return tcase;
}
