/* Parameter lists: precedence and error messages. */
#include "pbrt/test_import.h"

#include "pbrt/params.h"

#include <string.h>

/* Reads "type name" and its values from a list of strings, one token each. */
static void declare(ParamBuffer *buffer, const char *text)
{
    Lexer lexer;
    Token token;
    Error error = {{0}, {0}};
    TextWindow window;
    text_window_from_memory(&window, text, strlen(text));
    ck_assert(lexer_init(&lexer, &window, "p.pbrt", &error));
    ck_assert(lexer_next(&lexer, &token, &error));
    ck_assert_msg(param_declare(buffer, &token, &error), "%s", error.message);
    while (lexer_next(&lexer, &token, &error) && token.kind != TOKEN_END)
        ck_assert_msg(param_value_add(buffer, &token, &error), "%s", error.message);
    ck_assert_msg(param_end(buffer, &error), "%s", error.message);
}

START_TEST(values_of_every_type)
{
    ParamBuffer buffer;
    ParamList list;
    Error error = {{0}, {0}};
    size_t count;
    float v[3];
    param_buffer_init(&buffer);
    declare(&buffer, "\"float radius\" 2.5");
    declare(&buffer, "\" integer\tn \" -3");
    declare(&buffer, "\"bool on\" true");
    declare(&buffer, "\"string file\" \"a b.ply\"");
    declare(&buffer, "\"point3 P\" 1 2 3 4 5 6");
    declare(&buffer, "\"vector v1\" 7 8 9");
    declare(&buffer, "\"integer indices\" 0 1 2");
    param_buffer_seal(&buffer);
    param_list_init(&list, "thing", (SourcePlace){"p.pbrt", 1, 1}, &error);
    param_list_add_buffer(&list, &buffer);
    ASSERT_FLOAT(param_float(&list, "radius", 1.0f), 2.5f);
    ASSERT_FLOAT(param_float(&list, "height", 0.25f), 0.25f);
    ck_assert_int_eq(param_integer(&list, "n", 0), -3);
    ck_assert(param_bool(&list, "on", false));
    ck_assert_str_eq(param_string(&list, "file", ""), "a b.ply");
    const float *points = param_floats(&list, "P", PARAM_POINT3, &count);
    ck_assert_uint_eq(count, 6);
    ASSERT_FLOAT(points[5], 6.0f);
    ck_assert(param_vector(&list, "v1", PARAM_VECTOR3, v));
    ASSERT_FLOAT(v[2], 9.0f);
    const int *indices = param_integers(&list, "indices", &count);
    ck_assert_uint_eq(count, 3);
    ck_assert_int_eq(indices[2], 2);
    ck_assert(param_list_finish(&list, false));
    param_list_destroy(&list);
    param_buffer_destroy(&buffer);
}
END_TEST

START_TEST(last_wins_and_attributes_come_after)
{
    ParamBuffer buffer;
    ParamList list;
    Arena arena = {0};
    Error error = {{0}, {0}};
    param_buffer_init(&buffer);
    declare(&buffer, "\"float radius\" 9");
    declare(&buffer, "\"float zmin\" 9");
    declare(&buffer, "\"float unused\" 9");
    param_buffer_seal(&buffer);
    const ParamSet *set = param_set_make(&buffer, NULL, &arena, &error);
    param_buffer_clear(&buffer);
    declare(&buffer, "\"float radius\" 1");
    declare(&buffer, "\"float radius\" 2");
    param_buffer_seal(&buffer);
    param_list_init(&list, "thing", (SourcePlace){"p.pbrt", 1, 1}, &error);
    param_list_add_buffer(&list, &buffer);
    param_list_add_set(&list, set, true);
    ASSERT_FLOAT(param_float(&list, "radius", 0.0f), 2.0f);
    ASSERT_FLOAT(param_float(&list, "zmin", 0.0f), 9.0f);
    ck_assert(param_list_finish(&list, false));
    param_list_destroy(&list);
    param_buffer_destroy(&buffer);
    arena_destroy(&arena);
}
END_TEST

START_TEST(first_error_sticks)
{
    ParamBuffer buffer;
    ParamList list;
    Error error = {{0}, {0}};
    param_buffer_init(&buffer);
    declare(&buffer, "\"integer radius\" 2");
    declare(&buffer, "\"float height\" 3");
    param_buffer_seal(&buffer);
    param_list_init(&list, "thing", (SourcePlace){"p.pbrt", 4, 1}, &error);
    param_list_add_buffer(&list, &buffer);
    ASSERT_FLOAT(param_float(&list, "radius", 1.0f), 1.0f);
    ASSERT_FLOAT(param_float(&list, "height", 1.0f), 1.0f);
    param_error(&list, "height", "another");
    ck_assert(!param_list_finish(&list, true));
    ck_assert_str_eq(error.message, "p.pbrt:1:1: error: parameter \"radius\" of thing is of type integer");
    ck_assert_str_eq(error.fix, "give it as \"float radius\"");
    param_list_destroy(&list);
    param_buffer_destroy(&buffer);
}
END_TEST

START_TEST(unknown_parameter_names_the_nearest)
{
    Scene scene;
    ck_assert_str_eq(import_error("WorldBegin Shape \"sphere\" \"float raduis\" 1"),
                     "test.pbrt:1:27: error: unknown parameter \"raduis\" of sphere");
    import_text_in("WorldBegin Shape \"sphere\" \"float raduis\" 3", "", true, &scene);
    ck_assert_ptr_nonnull(strstr(import_log(), "test.pbrt:1:27: warning: unknown parameter \"raduis\""));
    ASSERT_FLOAT(ELEMENT(&scene, quadrics, Quadric, 0).radius, 1.0f);
    scene_destroy(&scene);
}
END_TEST

START_TEST(attribute_directive)
{
    Scene scene;
    import_world("Attribute \"shape\" \"float radius\" 3\n"
                 "AttributeBegin Attribute \"shape\" \"float radius\" 4 \"float nonsense\" 1\n"
                 "Shape \"sphere\" Shape \"sphere\" \"float radius\" 5 AttributeEnd Shape \"sphere\"",
                 &scene);
    ASSERT_FLOAT(ELEMENT(&scene, quadrics, Quadric, 0).radius, 4.0f);
    ASSERT_FLOAT(ELEMENT(&scene, quadrics, Quadric, 1).radius, 5.0f);
    ASSERT_FLOAT(ELEMENT(&scene, quadrics, Quadric, 2).radius, 3.0f);
    scene_destroy(&scene);
}
END_TEST

TCase *import_params_case(void)
{
    TCase *tcase = tcase_create("params");
    tcase_add_test(tcase, values_of_every_type);
    tcase_add_test(tcase, last_wins_and_attributes_come_after);
    tcase_add_test(tcase, first_error_sticks);
    tcase_add_test(tcase, unknown_parameter_names_the_nearest);
    tcase_add_test(tcase, attribute_directive);
    return tcase;
}
