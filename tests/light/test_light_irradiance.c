/* Irradiance from every kind of light against its closed form, and which side and part of an area light emits. */
#include "light/test_light.h"
#include "support/light_fixture.h"

/* Lambert's formula for a polygon of radiance 1 entirely above the horizon: half the sum over edges of the angle
 * subtended by the edge times the component along n of the normal of the edge's plane. */
static double polygon_irradiance(const float *positions, const int *order, int count, Vec3 ref, Vec3 n)
{
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        double a[3], b[3], c[3], la = 0.0, lb = 0.0, lc = 0.0, d = 0.0;
        const float *p = positions + 3 * order[i], *q = positions + 3 * order[(i + 1) % count];
        const float r[3] = {ref.x, ref.y, ref.z};
        for (int k = 0; k < 3; ++k) {
            a[k] = (double)p[k] - (double)r[k];
            b[k] = (double)q[k] - (double)r[k];
            la += a[k] * a[k];
            lb += b[k] * b[k];
            d += a[k] * b[k];
        }
        for (int k = 0; k < 3; ++k) {
            c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
            lc += c[k] * c[k];
        }
        double angle = acos(d / sqrt(la * lb));
        sum += angle * (c[0] * (double)n.x + c[1] * (double)n.y + c[2] * (double)n.z) / sqrt(lc);
    }
    return 0.5 * fabs(sum);
}

START_TEST(test_polygons)
{
    static const float corners[12] = {1.0f, 0.0f, 2.0f, 2.0f, 1.0f, 1.5f, 0.0f, 1.0f, 2.5f, 1.0f, 2.0f, 2.0f};
    static const int triangle[3] = {0, 1, 2}, quad[4] = {0, 1, 3, 2};
    Vec3 ref = vec3(0.2f, -0.3f, 0.1f), n = vec3(0.0f, 0.0f, 1.0f);
    for (int vertices = 3; vertices <= 4; ++vertices) {
        LightFixture f;
        fixture_init(&f);
        fixture_add_polygon(&f, corners, vertices, NULL, 0, LIGHT_TWO_SIDED);
        fixture_finish(&f);
        ASSERT_IRRADIANCE(&f, 0, ref, n,
                          polygon_irradiance(corners, vertices == 3 ? triangle : quad, vertices, ref, n));
        fixture_destroy(&f);
    }
}
END_TEST

START_TEST(test_disks)
{
    const double matrix[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};
    for (int ring = 0; ring < 2; ++ring) {
        LightFixture f;
        fixture_init(&f);
        double inner = ring ? 0.6 : 0.0;
        Quadric disk = {.radius = 1.1f, .inner_radius = (float)inner, .z_min = -0.8f, .phi_max = 6.28318531f};
        fixture_add_quadric(&f, PRIMITIVE_DISK, disk, matrix, 1.0f, 0, 0);
        fixture_finish(&f);
        /* on the axis, parallel to the disk: pi sin^2 of its half-angle */
        ASSERT_IRRADIANCE(&f, 0, vec3(0, 0, 0), vec3(0, 0, 1),
                          M_PI * (1.21 / (1.21 + 0.64) - inner * inner / (inner * inner + 0.64)));
        fixture_destroy(&f);
    }
}
END_TEST

START_TEST(test_spheres)
{
    LightFixture f;
    fixture_init(&f);
    fixture_add_sphere(&f, 0.7f, 1.0, 2.0, 3.0, 1.0f, LIGHT_TWO_SIDED);
    fixture_finish(&f);
    /* above the horizon: pi (R / d)^2 cos */
    ASSERT_IRRADIANCE(&f, 0, vec3(0, 0, 0), vec3(0, 0, 1), M_PI * 0.49 / 14.0 * 3.0 / sqrt(14.0));
    /* from inside, anywhere: pi */
    ASSERT_IRRADIANCE(&f, 0, vec3(1.0f, 2.0f, 3.0f), vec3(0, 0, 1), M_PI);
    ASSERT_IRRADIANCE(&f, 0, vec3(1.2f, 1.8f, 2.8f), vec3(0.6f, 0.8f, 0), M_PI);
    fixture_destroy(&f);
}
END_TEST

/* With radiance proportional to 1 / radius^2, the irradiance is the same for all sizes of a fully visible sphere. */
START_TEST(test_tiny_spheres)
{
    for (double radius = 1.0; radius > 0.9e-6; radius *= 0.1)
        for (int far = 0; far < 2; ++far) {
            LightFixture f;
            double z = far ? 100.0 : 2.0;
            fixture_init(&f);
            fixture_add_sphere(&f, (float)radius, 0.0, 0.0, z, (float)(z * z / (radius * radius)), 0);
            fixture_finish(&f);
            double error, got = fixture_irradiance(&f, 0, vec3(0, 0, 0), vec3(0, 0, 1), 5, 64, &error);
            ck_assert_msg(fabs(got / M_PI - 1.0) < 1e-4, "radius %g at %g: irradiance %g", radius, z, got);
            fixture_destroy(&f);
        }
}
END_TEST

/* Sampled points of a tiny sphere lie on it, on the near side. */
START_TEST(test_tiny_sphere_points)
{
    LightFixture f;
    fixture_init(&f);
    fixture_add_sphere(&f, 1e-6f, 0.0, 0.0, 0.0, 1.0f, 0);
    fixture_finish(&f);
    Vec3 ref = vec3(0.3f, -0.4f, 1.0f);
    for (uint i = 0; i < 4096; ++i) {
        LightSample s;
        ck_assert(light_sample(&f.view, 0, ref, fixture_random(2, i), &s));
        ck_assert_double_eq_tol((double)vec3_length(s.p) / 1e-6, 1.0, 1e-5);
        ck_assert_double_gt((double)vec3_dot(s.p, ref), 0.0);
    }
    fixture_destroy(&f);
}
END_TEST

START_TEST(test_delta_lights)
{
    LightFixture f;
    fixture_init(&f);
    const float cos_total = cosf(0.6f), cos_falloff = cosf(0.4f), half = 0.5f * (cos_total + cos_falloff);
    LightData point = {.kind = LIGHT_POINT, .emission = {3, 3, 3}, .detail.position = {0, 0, 2}};
    LightData spot = {.kind = LIGHT_SPOT,
                      .emission = {3, 3, 3},
                      .detail.position = {0, 0, 2},
                      .detail.direction = {0, 0, -1},
                      .detail.cos_total = cos_total,
                      .detail.cos_falloff = cos_falloff};
    LightData distant = {.kind = LIGHT_DISTANT, .emission = {3, 3, 3}, .detail.direction = {0.6f, 0, -0.8f}};
    fixture_add_light(&f, point);
    fixture_add_light(&f, spot);
    fixture_add_light(&f, distant);
    fixture_finish(&f);
    LightSample s;
    Vec3 up = vec3(0, 0, 1);
    ASSERT_IRRADIANCE(&f, 0, vec3(1.5f, 0, 0), up, 3.0 / 6.25 * 0.8);
    ASSERT_IRRADIANCE(&f, 2, vec3(1.5f, 0, 0), up, 3.0 * 0.8);
    ASSERT_IRRADIANCE(&f, 1, vec3(0, 0, 0), up, 3.0 / 4.0);
    /* Half-way between the cosines the falloff is one half; outside the cone it is zero. */
    double tangent = tan(acos((double)half));
    ASSERT_IRRADIANCE(&f, 1, vec3((float)(2.0 * tangent), 0, 0), up, 0.5 * 3.0 / 4.0 * pow((double)half, 3.0));
    ck_assert(!light_sample(&f.view, 1, vec3(2.0f, 0, 0), vec2(0.5f, 0.5f), &s));
    ck_assert(!light_sample(&f.view, 1, vec3(0, 0, 3.0f), vec2(0.5f, 0.5f), &s));
    ck_assert(!light_sample(&f.view, 0, vec3(0, 0, 2.0f), vec2(0.5f, 0.5f), &s));
    for (uint i = 0; i < 3; ++i)
        ck_assert((light_pdf_w(&f.view, i, vec3(0, 0, 0), up, NULL) == 0.0f));
    ck_assert(light_sample(&f.view, 2, vec3(0, 0, 0), vec2(0.5f, 0.5f), &s));
    ck_assert(s.infinite == 1u && s.delta == 1u && s.wi.x == -0.6f && s.wi.z == 0.8f);
    fixture_destroy(&f);
}
END_TEST

/* A step function if both angles are equal. */
START_TEST(test_spot_step)
{
    ck_assert((spot_falloff(0.8f, 0.8f, 0.8f) == 1.0f));
    ck_assert((spot_falloff(0.7999f, 0.8f, 0.8f) == 0.0f));
}
END_TEST

/* One-sided lights emit on the side of ng; vertex normals and ReverseOrientation flip it. */
START_TEST(test_sides)
{
    static const float square[12] = {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0};
    static const float down[12] = {0, 0, -1, 0, 0, -1, 0, 0, -1, 0, 0, -1};
    for (int vertices = 3; vertices <= 4; ++vertices)
        for (int turned = 0; turned < 3; ++turned)
            for (uint two_sided = 0; two_sided < 2; ++two_sided) {
                LightFixture f;
                fixture_init(&f);
                fixture_add_polygon(&f, square, vertices, turned == 2 ? down : NULL,
                                    turned == 1 ? SHAPE_FLIP_NORMAL : 0, two_sided ? LIGHT_TWO_SIDED : 0);
                fixture_finish(&f);
                LightSample s;
                bool above = light_sample(&f.view, 0, vec3(0, 0, 2), fixture_random(1, 0), &s);
                bool below = light_sample(&f.view, 0, vec3(0, 0, -2), fixture_random(1, 0), &s);
                ck_assert_int_eq(above, turned == 0 || two_sided);
                ck_assert_int_eq(below, turned != 0 || two_sided);
                ck_assert(!light_sample(&f.view, 0, vec3(5, 0, 0), fixture_random(1, 0), &s));
                Vec3 up = vec3(0, 0, 1);
                ck_assert((light_emitted(&f.view, 0, up, up).x == 1.0f));
                ck_assert((light_emitted(&f.view, 0, up, vec3_negate(up)).x == (two_sided ? 1.0f : 0.0f)));
                fixture_destroy(&f);
            }
}
END_TEST

/* A light whose surface exists with probability alpha emits alpha times its radiance; the far side of a sphere, visible
 * through holes in the near side, is not sampled by the cone. */
START_TEST(test_alpha)
{
    LightFixture f;
    Error error = {0};
    fixture_init(&f);
    fixture_add_sphere(&f, 1.0f, 0.0, 0.0, 0.0, 2.0f, LIGHT_TWO_SIDED);
    TextureOp *ops = array_grow(&f.scene.texture_ops, 2, &error);
    ops[0].code = TEXTURE_CONSTANT;
    ops[0].value = vec3_splat(0.25f);
    ops[1].code = TEXTURE_END;
    ARRAY_AT(&f.scene.shapes, Shape, 0).alpha = 0;
    ARRAY_AT(&f.scene.primitives, Primitive, 0).shape_and_kind |= PRIMITIVE_ALPHA_BIT;
    fixture_finish(&f);
    f.view.features = ~(ulong)0;
    LightSample s;
    ck_assert(light_sample(&f.view, 0, vec3(0, 0, 3), fixture_random(1, 0), &s));
    ck_assert(s.radiance.x == 0.5f && s.radiance.z == 0.5f);
    Vec3 down = vec3(0, 0, -1);
    Surface near = {.p = {0, 0, 1}, .ng = {0, 0, 1}}, far = {.p = {0, 0, -1}, .ng = {0, 0, -1}};
    ck_assert((light_pdf_w(&f.view, 0, vec3(0, 0, 3), down, &near) > 0.0f));
    ck_assert((light_pdf_w(&f.view, 0, vec3(0, 0, 3), down, &far) == 0.0f));
    fixture_destroy(&f);
}
END_TEST

TCase *light_irradiance_case(void)
{
    TCase *tcase = tcase_create("irradiance");
    tcase_set_timeout(tcase, 60);
    tcase_add_test(tcase, test_polygons);
    tcase_add_test(tcase, test_disks);
    tcase_add_test(tcase, test_spheres);
    tcase_add_test(tcase, test_tiny_spheres);
    tcase_add_test(tcase, test_tiny_sphere_points);
    tcase_add_test(tcase, test_delta_lights);
    tcase_add_test(tcase, test_spot_step);
    tcase_add_test(tcase, test_sides);
    tcase_add_test(tcase, test_alpha);
    return tcase;
}
