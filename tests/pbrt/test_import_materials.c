/* Materials: defaults, parameters, names, substitutes. */
#include "pbrt/test_import.h"

#include "image/color.h"

#include <string.h>

/* The material of the only shape after `directives`. */
static Material material_of(const char *directives, Scene *scene)
{
    char text[2048];
    snprintf(text, sizeof text, "%s Shape \"sphere\"", directives);
    import_world(text, scene);
    return ELEMENT(scene, materials, Material, ELEMENT(scene, shapes, Shape, 0).material);
}

START_TEST(defaults)
{
    Scene scene;
    Material m = material_of("", &scene);
    ck_assert_uint_eq(m.kind, MATERIAL_DIFFUSE);
    assert_vec3(m.color0.value, 0.5f, 0.5f, 0.5f, 0.0f);
    ck_assert_uint_eq(m.color0.program, NONE);
    ck_assert_uint_eq(m.displacement.program, NONE);
    ck_assert_uint_eq(m.normal_map, NONE);
    ck_assert_uint_eq(m.coat_table, NONE);
    scene_destroy(&scene);
    m = material_of("Material \"dielectric\"", &scene);
    ASSERT_FLOAT(m.eta, 1.5f);
    ASSERT_FLOAT(m.roughness_u.value, 0.0f);
    ck_assert_uint_eq(m.flags, MATERIAL_REMAP_ROUGHNESS);
    scene_destroy(&scene);
    m = material_of("Material \"diffusetransmission\" \"float scale\" 0.5", &scene);
    assert_vec3(m.color0.value, 0.25f, 0.25f, 0.25f, 0.0f);
    assert_vec3(m.color1.value, 0.25f, 0.25f, 0.25f, 0.0f);
    ASSERT_FLOAT(m.scale, 0.5f);
    scene_destroy(&scene);
    m = material_of("Material \"thindielectric\" \"float eta\" 1.3", &scene);
    ck_assert_uint_eq(m.kind, MATERIAL_THIN_DIELECTRIC);
    ASSERT_FLOAT(m.eta, 1.3f);
    scene_destroy(&scene);
}
END_TEST

START_TEST(conductors)
{
    Scene scene;
    float eta[3], k[3];
    Error error;
    ck_assert(color_named_spectrum("metal-Cu-eta", COLOR_INDEX, eta, &error));
    ck_assert(color_named_spectrum("metal-Cu-k", COLOR_INDEX, k, &error));
    Material m = material_of("Material \"conductor\"", &scene);
    assert_vec3(m.color0.value, eta[0], eta[1], eta[2], 0.0f);
    assert_vec3(m.color1.value, k[0], k[1], k[2], 0.0f);
    scene_destroy(&scene);
    m = material_of(
        "Material \"conductor\" \"rgb eta\" [ 0.2 0.9 1.1 ] \"rgb k\" [ 3.9 2.4 2.1 ] \"float uroughness\" 0.1\n"
        "\"float roughness\" 0.3 \"bool remaproughness\" false",
        &scene);
    assert_vec3(m.color0.value, 0.2f, 0.9f, 1.1f, 0.0f);
    assert_vec3(m.color1.value, 3.9f, 2.4f, 2.1f, 0.0f);
    ASSERT_FLOAT(m.roughness_u.value, 0.1f);
    ASSERT_FLOAT(m.roughness_v.value, 0.3f);
    ck_assert_uint_eq(m.flags, 0);
    scene_destroy(&scene);
    m = material_of("Material \"conductor\" \"rgb reflectance\" [ 1 0.5 0 ]", &scene);
    assert_vec3(m.color0.value, 1.0f, 0.5f, 0.0f, 0.0f);
    ck_assert_uint_eq(m.flags, MATERIAL_CONDUCTOR_REFLECTANCE | MATERIAL_REMAP_ROUGHNESS);
    scene_destroy(&scene);
}
END_TEST

START_TEST(spectra)
{
    Scene scene;
    Material m = material_of("Material \"diffuse\" \"spectrum reflectance\" [ 300 0.25 900 0.25 ]", &scene);
    assert_vec3(m.color0.value, 0.25f, 0.25f, 0.25f, 1e-5f);
    scene_destroy(&scene);
    m = material_of("Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"", &scene);
    ASSERT_NEAR(m.eta, 1.52f, 0.01f);
    ck_assert_ptr_nonnull(strstr(import_log(), "dispersion is not supported"));
    scene_destroy(&scene);
    m = material_of("Material \"dielectric\" \"spectrum eta\" [ 300 1.4 900 1.4 ]", &scene);
    ASSERT_NEAR(m.eta, 1.4f, 1e-5f);
    scene_destroy(&scene);
}
END_TEST

START_TEST(coated_diffuse)
{
    Scene scene;
    Material m = material_of("Material \"coateddiffuse\" \"rgb reflectance\" [ 1 0.4 0 ] \"float vroughness\" 0.2\n"
                             "\"float thickness\" 0.1 \"float g\" 0 \"integer maxdepth\" 3 \"integer nsamples\" 4",
                             &scene);
    ck_assert_uint_eq(m.kind, MATERIAL_COATED_DIFFUSE);
    assert_vec3(m.color0.value, 1.0f, 0.4f, 0.0f, 0.0f);
    ASSERT_FLOAT(m.roughness_u.value, 0.0f);
    ASSERT_FLOAT(m.roughness_v.value, 0.2f);
    ASSERT_FLOAT(m.eta, 1.5f);
    scene_destroy(&scene);
    ck_assert_ptr_nonnull(strstr(import_error("WorldBegin Material \"coateddiffuse\" \"rgb albedo\" [ 1 1 1 ]"),
                                 "a medium inside a coat (albedo) is not supported"));
}
END_TEST

START_TEST(coated_conductor)
{
    Scene scene;
    Material m = material_of("Material \"coatedconductor\"", &scene);
    ck_assert_uint_eq(m.kind, MATERIAL_COATED_CONDUCTOR);
    ASSERT_NEAR(m.color0.value.x, 0.43f, 0.01f); /* copper */
    ASSERT_FLOAT(m.eta, 1.5f);
    ASSERT_FLOAT(m.scale, 0.01f);
    ck_assert_uint_eq(m.flags, MATERIAL_REMAP_ROUGHNESS);
    ck_assert_uint_eq(scene_material_has_delta(&scene, 0), 1);
    scene_destroy(&scene);
    m = material_of(
        "Material \"coatedconductor\" \"float interface.roughness\" 0.3 \"float interface.vroughness\" 0.2\n"
        "\"float conductor.uroughness\" 0.1 \"float conductor.vroughness\" 0.4 \"float interface.eta\" 1.3\n"
        "\"rgb conductor.eta\" [ 0.2 0.9 1.1 ] \"rgb conductor.k\" [ 3.9 2.4 2.1 ] \"float thickness\" 0.5\n"
        "\"float g\" 0.1 \"integer maxdepth\" 3 \"integer nsamples\" 4 \"bool remaproughness\" false",
        &scene);
    assert_vec3(m.color0.value, 0.2f, 0.9f, 1.1f, 0.0f);
    assert_vec3(m.color1.value, 3.9f, 2.4f, 2.1f, 0.0f);
    ASSERT_FLOAT(m.roughness_u.value, 0.3f);
    ASSERT_FLOAT(m.roughness_v.value, 0.2f);
    ASSERT_FLOAT(m.base_u.value, 0.1f);
    ASSERT_FLOAT(m.base_v.value, 0.4f);
    ASSERT_FLOAT(m.eta, 1.3f);
    ASSERT_FLOAT(m.scale, 0.5f);
    ck_assert_uint_eq(m.flags, 0);
    ck_assert_uint_eq(scene_material_has_delta(&scene, 0), 0);
    scene_destroy(&scene);
    m = material_of("Material \"coatedconductor\" \"rgb reflectance\" [ 1 0.5 0 ]", &scene);
    ck_assert_uint_eq(m.flags, MATERIAL_CONDUCTOR_REFLECTANCE | MATERIAL_REMAP_ROUGHNESS);
    scene_destroy(&scene);
}
END_TEST

/* A scattering coat over a conductor becomes a mix of two coats with the same interface, of which that over the
 * conductor is thinner; relief belongs to both. */
START_TEST(scattering_coats)
{
    Scene scene;
    Material m =
        material_of("Texture \"d\" \"float\" \"wrinkled\" Material \"coatedconductor\" \"float thickness\" 0.4\n"
                    "\"rgb albedo\" [ 0.5 0.5 0 ] \"float interface.roughness\" 0.2 \"float interface.eta\" 1.3\n"
                    "\"texture displacement\" \"d\" \"float conductor.roughness\" 0.1 \"float g\" 0.5",
                    &scene);
    ck_assert_ptr_nonnull(strstr(import_log(), "the medium inside the coat scatters"));
    ck_assert_uint_eq(m.kind, MATERIAL_MIX);
    ck_assert_uint_eq(m.displacement.program, NONE);
    Material metal = ELEMENT(&scene, materials, Material, m.mix_a),
             base = ELEMENT(&scene, materials, Material, m.mix_b);
    ck_assert_uint_eq(metal.kind, MATERIAL_COATED_CONDUCTOR);
    ck_assert_uint_eq(base.kind, MATERIAL_COATED_DIFFUSE);
    ck_assert(metal.scale > 0.3f && metal.scale < 0.4f && m.amount.value > 0.0f && m.amount.value < 0.2f);
    ck_assert(base.color0.value.x > 0.5f && base.color0.value.z == 0.0f && base.color1.value.x == 0.0f);
    ASSERT_FLOAT(base.eta, 1.3f);
    ASSERT_FLOAT(base.roughness_u.value, 0.2f);
    ASSERT_FLOAT(metal.base_v.value, 0.1f);
    ck_assert_uint_ne(base.displacement.program, NONE);
    ck_assert_uint_eq(metal.displacement.program, base.displacement.program);
    ck_assert_uint_eq(base.flags, MATERIAL_REMAP_ROUGHNESS);
    scene_destroy(&scene);
    m = material_of("Material \"coatedconductor\" \"rgb reflectance\" [ 0.3 0.3 0.3 ] \"rgb albedo\" [ 0 0 0 ]",
                    &scene);
    ck_assert_uint_eq(m.kind, MATERIAL_COATED_CONDUCTOR);
    ASSERT_FLOAT(m.scale, 0.01f);
    scene_destroy(&scene);
}
END_TEST

/* A texture as thickness is its mean over the square of texture coordinates. */
START_TEST(coat_thickness_of_a_texture)
{
    static const char *const COATS[] = {"coatedconductor", "coateddiffuse"};
    for (size_t i = 0; i < 2; ++i) {
        Scene scene;
        char text[512];
        snprintf(text, sizeof text,
                 "Texture \"t\" \"float\" \"bilerp\" \"float v00\" 0 \"float v01\" 1 \"float v10\" 2 \"float v11\" 5\n"
                 "Material \"%s\" \"texture thickness\" \"t\"",
                 COATS[i]);
        Material m = material_of(text, &scene);
        ASSERT_NEAR(i == 0 ? m.scale : m.color1.value.x, 2.0f, 1e-4f);
        ck_assert_ptr_nonnull(strstr(import_log(), "the thickness of the coat is a texture: its mean, 2, is used"));
        scene_destroy(&scene);
    }
}
END_TEST

START_TEST(coats_that_are_refused)
{
    static const char *const CASES[][2] = {
        {"\"rgb albedo\" [ 1 1 1 ] \"texture reflectance\" \"c\"",
         "a coat with an albedo over a metal with a texture is not supported"},
        {"\"texture albedo\" \"c\"", "a texture as the albedo inside a coat is not supported"},
        {"\"rgb albedo\" [ 1 1 1 ] \"float g\" 1", "the g of a coat must be a number above -1 and below 1"},
        {"\"rgb albedo\" [ 1 1 1 ] \"texture g\" \"f\"", "the g of a coat must be a number above -1 and below 1"},
        {"\"rgb albedo\" [ 1 2 1 ]", "\"albedo\" is an albedo and has a component above 1: 2"}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; ++i) {
        char text[512];
        snprintf(text, sizeof text,
                 "WorldBegin Texture \"c\" \"spectrum\" \"checkerboard\" Texture \"f\" \"float\" \"checkerboard\"\n"
                 "Material \"coatedconductor\" %s",
                 CASES[i][0]);
        const char *found = import_error(text);
        ck_assert_msg(strstr(found, CASES[i][1]), "%s instead of %s", found, CASES[i][1]);
    }
}
END_TEST

/* Equal coats share a record, whatever lies below; others do not. */
START_TEST(coats_are_shared)
{
    Scene scene;
    Error error = {0};
    import_world("LightSource \"point\" Shape \"sphere\" Material \"coatedconductor\" \"float thickness\" 0.25\n"
                 "Shape \"sphere\" Material \"coatedconductor\" \"float thickness\" 0.5 Shape \"sphere\"\n"
                 "Material \"coatedconductor\" \"float thickness\" 0.25 \"float conductor.roughness\" 0.3\n"
                 "Shape \"sphere\"",
                 &scene);
    ck_assert_msg(scene_finish(&scene, &error), "%s", error.message);
    uint tables[3];
    for (size_t i = 0; i < 3; ++i)
        tables[i] = ELEMENT(&scene, materials, Material, i + 1).coat_table;
    ASSERT_FLOAT(ELEMENT(&scene, lookup, float, tables[0]), 0.25f);
    ASSERT_FLOAT(ELEMENT(&scene, lookup, float, tables[1]), 0.5f);
    ck_assert_uint_eq(tables[0], tables[2]);
    ck_assert_uint_eq(scene.features & (FEATURE_COATED_CONDUCTOR | FEATURE_ROUGH),
                      FEATURE_COATED_CONDUCTOR | FEATURE_ROUGH);
    scene_destroy(&scene);
}
END_TEST

START_TEST(named_and_mixed)
{
    Scene scene;
    Material m =
        material_of("NamedMaterial \"late\" AttributeBegin MakeNamedMaterial \"late\" \"string type\" \"dielectric\"\n"
                    "AttributeEnd",
                    &scene);
    ck_assert_uint_eq(m.kind, MATERIAL_DIELECTRIC);
    scene_destroy(&scene);
    m = material_of(
        "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"b\" \"string type\" \"conductor\"\n"
        "Material \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" 0.25",
        &scene);
    ck_assert_uint_eq(m.kind, MATERIAL_MIX);
    ck_assert_uint_eq(m.mix_a, 0);
    ck_assert_uint_eq(m.mix_b, 1);
    ASSERT_FLOAT(m.amount.value, 0.25f);
    scene_destroy(&scene);
}
END_TEST

/* sigma_a counts before reflectance, its older name color, and pigments; pbrt's defaults. */
START_TEST(hair)
{
    Scene scene;
    Material m = material_of("Material \"hair\"", &scene);
    ck_assert_uint_eq(m.kind, MATERIAL_HAIR);
    ck_assert_uint_eq(m.flags, MATERIAL_HAIR_MELANIN);
    ASSERT_FLOAT(m.base_u.value, 1.3f);
    ASSERT_FLOAT(m.base_v.value, 0.0f);
    ASSERT_FLOAT(m.eta, 1.55f);
    ASSERT_FLOAT(m.roughness_u.value, 0.3f);
    ASSERT_FLOAT(m.roughness_v.value, 0.3f);
    ASSERT_FLOAT(m.amount.value, 2.0f);
    scene_destroy(&scene);
    m = material_of("Material \"hair\" \"float pheomelanin\" 0.4 \"float beta_m\" 0.1 \"float beta_n\" 0.2 "
                    "\"float alpha\" 3 \"float eta\" 1.4",
                    &scene);
    ck_assert_uint_eq(m.flags, MATERIAL_HAIR_MELANIN);
    ASSERT_FLOAT(m.base_u.value, 0.0f);
    ASSERT_FLOAT(m.base_v.value, 0.4f);
    ASSERT_FLOAT(m.roughness_u.value, 0.1f);
    ASSERT_FLOAT(m.roughness_v.value, 0.2f);
    ASSERT_FLOAT(m.amount.value, 3.0f);
    ASSERT_FLOAT(m.eta, 1.4f);
    scene_destroy(&scene);
    m = material_of("Material \"hair\" \"rgb color\" [ 0.1 0.2 0.3 ] \"float eumelanin\" 1", &scene);
    ck_assert_uint_eq(m.flags, MATERIAL_HAIR_COLOR);
    assert_vec3(m.color0.value, 0.1f, 0.2f, 0.3f, 1e-6f);
    ck_assert_ptr_nonnull(strstr(import_log(), "the hair's pigments are ignored: its reflectance is given"));
    scene_destroy(&scene);
    m = material_of("Material \"hair\" \"rgb sigma_a\" [ 3 2 1 ] \"rgb reflectance\" [ 0.1 0.2 0.3 ]", &scene);
    ck_assert_uint_eq(m.flags, 0);
    assert_vec3(m.color0.value, 3, 2, 1, 1e-6f);
    ck_assert_ptr_nonnull(strstr(import_log(), "are ignored: its sigma_a is given"));
    scene_destroy(&scene);
}
END_TEST

START_TEST(scopes)
{
    Scene scene;
    Material m = material_of("Material \"dielectric\" AttributeBegin Material \"conductor\" AttributeEnd", &scene);
    ck_assert_uint_eq(m.kind, MATERIAL_DIELECTRIC);
    scene_destroy(&scene);
    m = material_of("MakeNamedMaterial \"a\" \"string type\" \"conductor\" NamedMaterial \"a\" Material \"dielectric\"",
                    &scene);
    ck_assert_uint_eq(m.kind, MATERIAL_DIELECTRIC);
    scene_destroy(&scene);
}
END_TEST

START_TEST(substitutes)
{
    static const struct {
        const char *text;
        uint kind;
    } cases[] = {{"measured", MATERIAL_DIFFUSE}, {"subsurface", MATERIAL_DIFFUSE}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char text[256];
        Scene scene;
        snprintf(text, sizeof text, "WorldBegin Material \"%s\" \"float eta\" 1 Shape \"sphere\"", cases[i].text);
        ck_assert_ptr_nonnull(strstr(import_error(text), "is not supported"));
        import_text_in(text, "", true, &scene);
        ck_assert_uint_eq(ELEMENT(&scene, materials, Material, 0).kind, cases[i].kind);
        ck_assert_uint_eq(scene.counts.substitutions, 1);
        ck_assert_ptr_nonnull(strstr(import_log(), cases[i].text));
        scene_destroy(&scene);
    }
}
END_TEST

/* A shape's material may be defined behind it, a mix before what it mixes, and a material before its textures. */
START_TEST(names_are_known_at_the_end)
{
    Scene scene;
    Material m, part;
    import_world("NamedMaterial \"late\" Shape \"sphere\" Shape \"sphere\"\n"
                 "MakeNamedMaterial \"late\" \"string type\" \"mix\" \"string materials\" [ \"glass\" \"red\" ]\n"
                 "MakeNamedMaterial \"red\" \"string type\" \"diffuse\" \"texture reflectance\" \"t\"\n"
                 "MakeNamedMaterial \"glass\" \"string type\" \"dielectric\" \"float eta\" 1.7\n"
                 "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [ 1 0 0 ]",
                 &scene);
    uint used = ELEMENT(&scene, shapes, Shape, 0).material;
    ck_assert_uint_eq(ELEMENT(&scene, shapes, Shape, 1).material, used);
    ck_assert_uint_eq(scene.materials.count, 3);
    m = ELEMENT(&scene, materials, Material, used);
    ck_assert_uint_eq(m.kind, MATERIAL_MIX);
    part = ELEMENT(&scene, materials, Material, m.mix_a);
    ck_assert_uint_eq(part.kind, MATERIAL_DIELECTRIC);
    ASSERT_FLOAT(part.eta, 1.7f);
    part = ELEMENT(&scene, materials, Material, m.mix_b);
    ck_assert_uint_eq(part.kind, MATERIAL_DIFFUSE);
    ck_assert_uint_ne(part.color0.program, NONE);
    scene_destroy(&scene);
}
END_TEST

START_TEST(late_names_that_are_wrong)
{
    ck_assert_str_eq(import_error("WorldBegin\nNamedMaterial \"a\" Shape \"sphere\"\n"
                                  "MakeNamedMaterial \"b\" \"string type\" \"diffuse\""),
                     "test.pbrt:2:15: error: unknown material \"a\"");
    ck_assert_str_eq(
        import_error("WorldBegin\n"
                     "MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [ \"b\" \"c\" ]\n"
                     "MakeNamedMaterial \"b\" \"string type\" \"mix\" \"string materials\" [ \"c\" \"a\" ]\n"
                     "MakeNamedMaterial \"c\" \"string type\" \"diffuse\""),
        "test.pbrt:2:1: error: the material \"a\" is a mix of itself");
    ck_assert_str_eq(import_error("WorldBegin\nNamedMaterial \"a\" Shape \"sphere\"\n"
                                  "MakeNamedMaterial \"a\" \"string type\" \"interface\""),
                     "test.pbrt:3:19: error: the material \"a\", an \"interface\", is used before it is defined");
    ck_assert_str_eq(import_error("WorldBegin\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n"
                                  "Shape \"sphere\" Texture \"u\" \"spectrum\" \"constant\""),
                     "test.pbrt:2:20: error: unknown spectrum texture \"t\" for parameter \"reflectance\"");
    ck_assert_str_eq(import_error("WorldBegin\nMaterial \"diffuse\" \"texture reflectance\" \"t\" \"float nosuch\" 1\n"
                                  "Texture \"t\" \"spectrum\" \"constant\""),
                     "test.pbrt:2:46: error: unknown parameter \"nosuch\" of the material diffuse");
}
END_TEST

TCase *import_materials_case(void)
{
    TCase *tcase = tcase_create("materials");
    tcase_set_timeout(tcase, 60); /* albedos of coats */
    tcase_add_test(tcase, defaults);
    tcase_add_test(tcase, conductors);
    tcase_add_test(tcase, spectra);
    tcase_add_test(tcase, coated_diffuse);
    tcase_add_test(tcase, coated_conductor);
    tcase_add_test(tcase, scattering_coats);
    tcase_add_test(tcase, coat_thickness_of_a_texture);
    tcase_add_test(tcase, coats_that_are_refused);
    tcase_add_test(tcase, coats_are_shared);
    tcase_add_test(tcase, named_and_mixed);
    tcase_add_test(tcase, hair);
    tcase_add_test(tcase, scopes);
    tcase_add_test(tcase, substitutes);
    tcase_add_test(tcase, names_are_known_at_the_end);
    tcase_add_test(tcase, late_names_that_are_wrong);
    return tcase;
}
