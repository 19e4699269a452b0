/* Shapes: defaults, orientation, normals, alpha; and objects with their instances. */
#include "geometry/medium.h"
#include "pbrt/test_import.h"

#include <string.h>

#define TRIANGLE "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] "

START_TEST(sphere_defaults_and_clipping)
{
    Scene scene;
    import_world("Shape \"sphere\" Shape \"sphere\" \"float radius\" 2 \"float zmin\" 1.5 \"float zmax\" -5 "
                 "\"float phimax\" 90",
                 &scene);
    const Quadric *whole = &ELEMENT(&scene, quadrics, Quadric, 0), *part = &ELEMENT(&scene, quadrics, Quadric, 1);
    ASSERT_FLOAT(whole->radius, 1.0f);
    ASSERT_FLOAT(whole->z_min, -1.0f);
    ASSERT_FLOAT(whole->z_max, 1.0f);
    ASSERT_NEAR(whole->phi_max, 2.0f * PI, 1e-6f);
    ck_assert_uint_eq(whole->whole, 1);
    ASSERT_FLOAT(part->z_min, -2.0f);
    ASSERT_FLOAT(part->z_max, 1.5f);
    ASSERT_NEAR(part->phi_max, 0.5f * PI, 1e-6f);
    ck_assert_uint_eq(part->whole, 0);
    scene_destroy(&scene);
}
END_TEST

START_TEST(disk_defaults)
{
    Scene scene;
    import_world("Shape \"disk\" \"float height\" 3 \"float innerradius\" 0.5", &scene);
    const Quadric *disk = &ELEMENT(&scene, quadrics, Quadric, 0);
    ASSERT_FLOAT(disk->radius, 1.0f);
    ASSERT_FLOAT(disk->inner_radius, 0.5f);
    ASSERT_FLOAT(disk->z_min, 3.0f);
    ck_assert_uint_eq(ELEMENT(&scene, primitives, Primitive, 0).shape_and_kind >> PRIMITIVE_KIND_SHIFT, PRIMITIVE_DISK);
    scene_destroy(&scene);
}
END_TEST

/* Heights in either order, as in pbrt. */
START_TEST(cylinder_defaults)
{
    Scene scene;
    import_world("Shape \"cylinder\" Shape \"cylinder\" \"float radius\" 2 \"float zmin\" 5 \"float zmax\" -7 "
                 "\"float phimax\" 90",
                 &scene);
    const Quadric *whole = &ELEMENT(&scene, quadrics, Quadric, 0), *part = &ELEMENT(&scene, quadrics, Quadric, 1);
    ASSERT_FLOAT(whole->radius, 1.0f);
    ASSERT_FLOAT(whole->z_min, -1.0f);
    ASSERT_FLOAT(whole->z_max, 1.0f);
    ASSERT_NEAR(whole->phi_max, 2.0f * PI, 1e-6f);
    ck_assert_uint_eq(whole->whole, 0);
    ASSERT_FLOAT(part->radius, 2.0f);
    ASSERT_FLOAT(part->z_min, -7.0f);
    ASSERT_FLOAT(part->z_max, 5.0f);
    ASSERT_NEAR(part->phi_max, 0.5f * PI, 1e-6f);
    ck_assert_uint_eq(ELEMENT(&scene, primitives, Primitive, 1).shape_and_kind >> PRIMITIVE_KIND_SHIFT,
                      PRIMITIVE_CYLINDER);
    scene_destroy(&scene);
}
END_TEST

START_TEST(mesh_data)
{
    Scene scene;
    import_world("Translate 0 0 1 Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]\n"
                 "\"integer indices\" [ 0 1 2 2 1 3 ] \"point2 uv\" [ 0 0 1 0 0 1 1 1 ]\n"
                 "\"normal N\" [ 0 0 2 0 0 2 0 0 2 0 0 2 ] \"integer faceIndices\" [ 0 1 ]",
                 &scene);
    ck_assert_uint_eq(scene.primitives.count, 2);
    ck_assert_uint_eq(scene.positions.count, 4);
    ck_assert_uint_eq(scene.uvs.count, 4);
    const Primitive *second = &ELEMENT(&scene, primitives, Primitive, 1);
    ck_assert_uint_eq(second->a, 2);
    ck_assert_uint_eq(second->b, 1);
    ck_assert_uint_eq(second->c, 3);
    assert_vec3(ELEMENT(&scene, positions, Vec3, 3), 1, 1, 1, 0.0f);
    assert_vec3(ELEMENT(&scene, normals, Vec3, 0), 0, 0, 1, 0.0f);
    ck_assert_uint_eq(ELEMENT(&scene, shapes, Shape, 0).flags, SHAPE_HAS_NORMALS | SHAPE_HAS_UV);
    scene_destroy(&scene);
}
END_TEST

START_TEST(normals_transform_as_normals)
{
    Scene scene;
    /* Under Scale 2 1 1 the plane x + y = 0 becomes x / 2 + y = 0: its normal is (1, 2, 0). */
    import_world("Scale 2 1 1 " TRIANGLE "\"normal N\" [ 1 1 0 1 1 0 1 1 0 ] ReverseOrientation " TRIANGLE
                 "\"normal N\" [ 1 1 0 1 1 0 0 0 0 ]",
                 &scene);
    float s = 1.0f / sqrtf(5.0f);
    assert_vec3(ELEMENT(&scene, normals, Vec3, 0), s, 2 * s, 0, 1e-6f);
    assert_vec3(ELEMENT(&scene, normals, Vec3, 3), -s, -2 * s, 0, 1e-6f);
    assert_vec3(ELEMENT(&scene, normals, Vec3, 5), 0, 0, 0, 0.0f);
    scene_destroy(&scene);
}
END_TEST

START_TEST(orientation_flags)
{
    static const struct {
        const char *before;
        uint flags;
    } cases[] = {{"", 0},
                 {"ReverseOrientation", SHAPE_REVERSE | SHAPE_FLIP_NORMAL},
                 {"Scale 1 1 -1", SHAPE_FLIP_NORMAL},
                 {"Scale -1 1 -1", 0},
                 {"Scale -1 1 1 ReverseOrientation", SHAPE_REVERSE},
                 {"ReverseOrientation ReverseOrientation", 0},
                 {"AttributeBegin ReverseOrientation AttributeEnd", 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char text[256];
        Scene scene;
        snprintf(text, sizeof text, "%s Shape \"sphere\"", cases[i].before);
        import_world(text, &scene);
        ck_assert_uint_eq(ELEMENT(&scene, shapes, Shape, 0).flags, cases[i].flags);
        scene_destroy(&scene);
    }
}
END_TEST

START_TEST(bilinear_patch)
{
    Scene scene;
    import_world("Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 1 ]", &scene);
    ck_assert_uint_eq(scene.patches.count, 1);
    for (uint k = 0; k < 4; ++k)
        ck_assert_uint_eq(ELEMENT(&scene, patches, Patch, 0).v[k], k);
    scene_destroy(&scene);
}
END_TEST

START_TEST(degenerate_triangles_are_counted)
{
    Scene scene;
    import_world("AreaLightSource \"diffuse\" Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 2 0 0 0 1 0 ]\n"
                 "\"integer indices\" [ 0 1 2 0 1 3 1 1 3 ]",
                 &scene);
    ck_assert_uint_eq(scene.primitives.count, 1);
    ck_assert_uint_eq(scene.lights.count, 1);
    ck_assert_uint_eq(scene.counts.degenerate_triangles, 2);
    ck_assert_uint_eq(scene.counts.zero_area_lights, 2);
    ck_assert_ptr_nonnull(strstr(import_log(), "warning: 2 primitives of zero area were dropped"));
    scene_destroy(&scene);
}
END_TEST

START_TEST(flat_transform_without_normals)
{
    Scene scene;
    import_world("Scale 1 1 0 " TRIANGLE, &scene);
    ck_assert_uint_eq(scene.primitives.count, 1);
    scene_destroy(&scene);
}
END_TEST

START_TEST(alpha)
{
    Scene scene;
    import_world("Texture \"leaf\" \"float\" \"checkerboard\"\n"
                 "Shape \"sphere\" \"texture alpha\" \"leaf\" Shape \"sphere\" \"float alpha\" 0.5\n"
                 "Shape \"sphere\" \"float alpha\" 1",
                 &scene);
    const Shape *shapes = scene.shapes.data;
    ck_assert_uint_eq(ELEMENT(&scene, texture_ops, TextureOp, shapes[0].alpha + 2).code, TEXTURE_CHECKERBOARD);
    const TextureOp *constant = &ELEMENT(&scene, texture_ops, TextureOp, shapes[1].alpha);
    ck_assert_uint_eq(constant[0].code, TEXTURE_CONSTANT);
    ASSERT_FLOAT(constant[0].value.x, 0.5f);
    ck_assert_uint_eq(constant[1].code, TEXTURE_END);
    ck_assert_uint_eq(shapes[2].alpha, NONE);
    ck_assert(ELEMENT(&scene, primitives, Primitive, 0).shape_and_kind & PRIMITIVE_ALPHA_BIT);
    ck_assert(!(ELEMENT(&scene, primitives, Primitive, 2).shape_and_kind & PRIMITIVE_ALPHA_BIT));
    scene_destroy(&scene);
}
END_TEST

START_TEST(interface_shapes_are_invisible)
{
    Scene scene;
    import_world("Material \"interface\" AreaLightSource \"diffuse\" Shape \"sphere\" " TRIANGLE, &scene);
    ck_assert_uint_eq(scene.primitives.count, 0);
    ck_assert_uint_eq(scene.lights.count, 0);
    ck_assert_ptr_nonnull(strstr(import_log(), "warning: the area light is ignored"));
    scene_destroy(&scene);
    ck_assert_ptr_nonnull(strstr(import_error("WorldBegin Material \"interface\" Shape \"sphere\" \"float raduis\" 1"),
                                 "unknown parameter"));
}
END_TEST

static Curve curve_of(const Scene *scene, uint i)
{
    return ELEMENT(scene, curves, Curve, i);
}

/* Widths go evenly over all segments; the transform scales them. Bezier segments share their ends. */
START_TEST(curves)
{
    Scene scene;
    import_world("Scale 2 2 2 Shape \"curve\" \"float width0\" 1 \"float width1\" 0 \"point3 P\" "
                 "[ 0 0 0  1 0 0  2 1 0  3 1 0  4 1 0  5 2 0  6 3 0 ] Shape \"curve\" \"string type\" \"cylinder\" "
                 "\"integer splitdepth\" 1 \"point3 P\" [ 0 0 0  1 0 0  2 1 0  3 1 0 ] Shape \"curve\" \"point3 P\" "
                 "[ 1 1 1 1 1 1 1 1 1 1 1 1 ]",
                 &scene);
    ck_assert_uint_eq(scene.curves.count, 3);
    ck_assert_uint_eq(scene.primitives.count, 2 * 8 + 2);
    ck_assert_uint_eq(scene.counts.degenerate_triangles, 1);
    ck_assert_uint_eq(ELEMENT(&scene, primitives, Primitive, 11).a, 1);
    ck_assert_uint_eq(ELEMENT(&scene, primitives, Primitive, 11).b, CURVE_PIECE(3u, 3u));
    ck_assert_uint_eq(ELEMENT(&scene, primitives, Primitive, 17).c, CURVE_ROUND);
    Curve first = curve_of(&scene, 0), second = curve_of(&scene, 1), third = curve_of(&scene, 2);
    assert_vec3(first.p[3], 6, 2, 0, 0.0f);
    assert_vec3(second.p[0], 6, 2, 0, 0.0f);
    assert_vec3(second.p[3], 12, 6, 0, 0.0f);
    ASSERT_NEAR(first.width[0], 2.0f, 1e-6f);
    ASSERT_NEAR(first.width[1], 1.0f, 1e-6f);
    ASSERT_NEAR(second.width[0], 1.0f, 1e-6f);
    ASSERT_FLOAT(second.width[1], 0.0f);
    ASSERT_NEAR(third.width[1], 2.0f, 1e-6f);
    scene_destroy(&scene);
}
END_TEST

/* Degree 2 is elevated; B-splines become Bezier segments that meet. */
START_TEST(curve_bases)
{
    Scene scene;
    import_world("Shape \"curve\" \"integer degree\" 2 \"point3 P\" [ 0 0 0  3 0 0  3 6 0 ]"
                 "Shape \"curve\" \"string basis\" \"bspline\" \"point3 P\" [ 0 0 0  6 0 0  6 6 0  0 6 0  0 0 6 ]"
                 "Shape \"curve\" \"string basis\" \"bspline\" \"integer degree\" 2 \"point3 P\" "
                 "[ 0 0 0  6 0 0  6 6 0  0 6 0 ]",
                 &scene);
    ck_assert_uint_eq(scene.curves.count, 5);
    Curve elevated = curve_of(&scene, 0), a = curve_of(&scene, 1), b = curve_of(&scene, 2), c = curve_of(&scene, 3);
    assert_vec3(elevated.p[0], 0, 0, 0, 0.0f);
    assert_vec3(elevated.p[1], 2, 0, 0, 1e-6f);
    assert_vec3(elevated.p[2], 3, 2, 0, 1e-6f);
    assert_vec3(elevated.p[3], 3, 6, 0, 0.0f);
    assert_vec3(a.p[0], 5, 1, 0, 1e-6f);
    assert_vec3(a.p[1], 6, 2, 0, 1e-6f);
    assert_vec3(a.p[2], 6, 4, 0, 1e-6f);
    assert_vec3(a.p[3], 5, 5, 0, 1e-6f);
    ck_assert(memcmp(&a.p[3], &b.p[0], sizeof b.p[0]) == 0);
    assert_vec3(c.p[0], 3, 0, 0, 1e-6f);
    assert_vec3(c.p[1], 5, 0, 0, 1e-6f);
    assert_vec3(c.p[2], 6, 1, 0, 1e-6f);
    assert_vec3(c.p[3], 6, 3, 0, 1e-6f);
    scene_destroy(&scene);
}
END_TEST

/* A ribbon becomes bilinear patches with its normals, and may emit. */
START_TEST(ribbons)
{
    Scene scene;
    import_world("AreaLightSource \"diffuse\" Shape \"curve\" \"string type\" \"ribbon\" \"float width\" 0.5 "
                 "\"point3 P\" [ 0 0 0  1 0 0  2 0 0  3 0 0 ] \"normal N\" [ 0 0 2  0 2 0 ]",
                 &scene);
    ck_assert_uint_eq(scene.curves.count, 0);
    ck_assert_uint_eq(scene.primitives.count, 16); /* a quarter of a turn */
    ck_assert_uint_eq(scene.lights.count, 16);
    ck_assert_uint_eq(scene.patches.count, 16);
    ck_assert_uint_eq(ELEMENT(&scene, shapes, Shape, 0).flags & (SHAPE_HAS_UV | SHAPE_HAS_NORMALS),
                      SHAPE_HAS_UV | SHAPE_HAS_NORMALS);
    Vec3 corner = ELEMENT(&scene, positions, Vec3, 0), normal = ELEMENT(&scene, normals, Vec3, 0);
    assert_vec3(corner, 0, -0.25f, 0, 1e-6f);
    assert_vec3(normal, 0, 0, 1, 1e-6f);
    ck_assert(ELEMENT(&scene, uvs, Vec2, 0).x == 0.0f && ELEMENT(&scene, uvs, Vec2, 0).y == 1.0f);
    double area = 0.0;
    for (uint i = 0; i < 16; ++i)
        area += (double)ELEMENT(&scene, lights, Light, i).area;
    ck_assert_msg(fabs(area - 1.5) < 0.02, "area %g", area);
    scene_destroy(&scene);
}
END_TEST

/* Curves emit nothing and do not separate media. */
START_TEST(curves_without_sides)
{
    Scene scene;
    const char *text = "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" WorldBegin AreaLightSource \"diffuse\" "
                       "MediumInterface \"fog\" \"\" Shape \"curve\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0  3 0 0 ] "
                       "\"normal N\" [ 0 0 1 0 0 1 ]";
    import_text_in(text, "", true, &scene);
    ck_assert_uint_eq(scene.curves.count, 1);
    ck_assert(!(ELEMENT(&scene, shapes, Shape, 0).flags & MEDIA_BITS));
    const char *log = import_log();
    ck_assert_ptr_nonnull(strstr(log, "an area light on a curve is not supported; instead: it emits no light"));
    ck_assert_ptr_nonnull(strstr(log, "the curve does not separate media: only a ribbon can"));
    ck_assert_ptr_nonnull(strstr(log, "the normals are ignored: only ribbons have normals"));
    scene_destroy(&scene);
}
END_TEST

TCase *import_shapes_case(void)
{
    TCase *tcase = tcase_create("shapes");
    tcase_add_test(tcase, sphere_defaults_and_clipping);
    tcase_add_test(tcase, disk_defaults);
    tcase_add_test(tcase, cylinder_defaults);
    tcase_add_test(tcase, mesh_data);
    tcase_add_test(tcase, normals_transform_as_normals);
    tcase_add_test(tcase, orientation_flags);
    tcase_add_test(tcase, bilinear_patch);
    tcase_add_test(tcase, degenerate_triangles_are_counted);
    tcase_add_test(tcase, flat_transform_without_normals);
    tcase_add_test(tcase, alpha);
    tcase_add_test(tcase, interface_shapes_are_invisible);
    tcase_add_test(tcase, curves);
    tcase_add_test(tcase, curve_bases);
    tcase_add_test(tcase, ribbons);
    tcase_add_test(tcase, curves_without_sides);
    return tcase;
}

START_TEST(instances)
{
    Scene scene;
    import_world("Translate 0 0 1 ObjectBegin \"ball\" Scale 2 2 2 Shape \"sphere\" ObjectEnd\n"
                 "Translate 10 0 0 ObjectInstance \"ball\" Scale -1 1 1 ObjectInstance \"ball\"",
                 &scene);
    ck_assert_uint_eq(scene.objects.count, 2);
    ck_assert_uint_eq(scene.instances.count, 2);
    /* The definition keeps its own transform; the instance's transform is applied after it, as in pbrt. */
    assert_vec3(ELEMENT(&scene, quadrics, Quadric, 0).center, 0, 0, 1, 0.0f);
    ASSERT_FLOAT(ELEMENT(&scene, quadrics, Quadric, 0).world_radius, 2.0f);
    const Instance *first = &ELEMENT(&scene, instances, Instance, 0);
    ck_assert_uint_eq(first->object, 1);
    assert_vec3(affine_point(first->world_from_object, vec3(0, 0, 1)), 10, 0, 2, 1e-6f);
    assert_vec3(affine_point(first->object_from_world, vec3(10, 0, 2)), 0, 0, 1, 1e-6f);
    scene_destroy(&scene);
}
END_TEST

START_TEST(emissive_shapes_join_the_world)
{
    Scene scene;
    import_world(
        "ObjectBegin \"lamp\" Shape \"disk\" Translate 1 0 0 AreaLightSource \"diffuse\" \"rgb L\" [ 1 2 3 ]\n" TRIANGLE
        "\"normal N\" [ 0 0 1 0 0 1 0 0 1 ] Shape \"sphere\" ObjectEnd\n"
        "ObjectInstance \"lamp\" Scale 2 2 -2 ObjectInstance \"lamp\"",
        &scene);
    ck_assert_uint_eq(scene.instances.count, 2);
    ck_assert_uint_eq(scene.primitives.count, 5);
    ck_assert_uint_eq(scene.lights.count, 4);
    const Light *light = &ELEMENT(&scene, lights, Light, 2);
    ASSERT_NEAR(light->area, 2.0f, 1e-5f);
    assert_vec3(light->emission, 1, 2, 3, 0.0f);
    const Primitive *p = &ELEMENT(&scene, primitives, Primitive, light->primitive);
    assert_vec3(ELEMENT(&scene, positions, Vec3, p->b), 4, 0, 0, 1e-6f);
    const Shape *shape = &ELEMENT(&scene, shapes, Shape, p->shape_and_kind & PRIMITIVE_SHAPE_MASK);
    ck_assert_uint_eq(shape->flags & SHAPE_FLIP_NORMAL, SHAPE_FLIP_NORMAL);
    assert_vec3(ELEMENT(&scene, normals, Vec3, shape->first_normal), 0, 0, -1, 1e-6f);
    const Quadric *sphere = &ELEMENT(&scene, quadrics, Quadric, 2);
    assert_vec3(sphere->center, 2, 0, 0, 1e-6f);
    ASSERT_NEAR(sphere->world_radius, 2.0f, 1e-6f);
    Error error = {{0}, {0}};
    ck_assert_msg(scene_finish(&scene, &error), "%s", error.message);
    scene_destroy(&scene);
}
END_TEST

START_TEST(object_of_lights_only_has_no_instance)
{
    Scene scene;
    import_world("ObjectBegin \"lamp\" AreaLightSource \"diffuse\" Shape \"sphere\" ObjectEnd ObjectInstance \"lamp\"\n"
                 "Shape \"disk\"",
                 &scene);
    ck_assert_uint_eq(scene.instances.count, 0);
    ck_assert_uint_eq(scene.lights.count, 1);
    /* The area light's scope ended with the object. */
    ck_assert_uint_eq(scene.primitives.count, 2);
    scene_destroy(&scene);
}
END_TEST

TCase *import_objects_case(void)
{
    TCase *tcase = tcase_create("objects");
    tcase_add_test(tcase, instances);
    tcase_add_test(tcase, emissive_shapes_join_the_world);
    tcase_add_test(tcase, object_of_lights_only_has_no_instance);
    return tcase;
}
