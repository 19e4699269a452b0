/* Tokens, numbers and tables of names. */
#include "pbrt/test_import.h"
#include "support/test_files.h"

#include "base/name_table.h"
#include "base/text_number.h"
#include "pbrt/lexer.h"

#include <string.h>

static Token next(Lexer *lexer)
{
    Error error = {{0}, {0}};
    Token token;
    ck_assert_msg(lexer_next(lexer, &token, &error), "%s", error.message);
    return token;
}

static bool lexer_open(Lexer *lexer, const char *text, size_t length, Error *error)
{
    TextWindow window;
    text_window_from_memory(&window, text, length);
    return lexer_init(lexer, &window, "a.pbrt", error);
}

START_TEST(tokens_have_kinds_and_places)
{
    const char *text = "Shape \"sphere\" # a comment \"with\" [ things ]\n  \"float radius\"[2.5]\r\n\ttrue#not\n";
    static const struct {
        TokenKind kind;
        const char *text;
        int line, column;
    } expected[] = {
        {TOKEN_WORD, "Shape", 1, 1},    {TOKEN_STRING, "sphere", 1, 7}, {TOKEN_STRING, "float radius", 2, 3},
        {TOKEN_OPEN, "[", 2, 17},       {TOKEN_WORD, "2.5", 2, 18},     {TOKEN_CLOSE, "]", 2, 21},
        {TOKEN_WORD, "true#not", 3, 2}, {TOKEN_END, "", 4, 1},          {TOKEN_END, "", 4, 1}};
    Lexer lexer;
    Error error;
    ck_assert(lexer_open(&lexer, text, strlen(text), &error));
    for (size_t i = 0; i < sizeof expected / sizeof *expected; ++i) {
        Token token = next(&lexer);
        ck_assert_int_eq(token.kind, expected[i].kind);
        ck_assert_uint_eq(token.length, strlen(expected[i].text));
        ck_assert_mem_eq(token.text, expected[i].text, token.length);
        ck_assert_int_eq(token.place.line, expected[i].line);
        ck_assert_int_eq(token.place.column, expected[i].column);
        ck_assert_str_eq(token.place.file, "a.pbrt");
    }
}
END_TEST

START_TEST(strings_decode_escapes)
{
    const char *text = "\"a\\\"b\\\\c\\n\\t\\'\" \"\" \"\\";
    Lexer lexer;
    Error error = {{0}, {0}};
    Arena arena = {0};
    ck_assert(lexer_open(&lexer, text, strlen(text), &error));
    Token token = next(&lexer);
    ck_assert_str_eq(token_text(&token, &arena, &error), "a\"b\\c\n\t'");
    token = next(&lexer);
    ck_assert_int_eq(token.kind, TOKEN_STRING);
    ck_assert_str_eq(token_text(&token, &arena, &error), "");
    ck_assert(!lexer_next(&lexer, &token, &error));
    ck_assert_str_eq(error.message, "a.pbrt:1:20: error: the string that begins here has no end");
    arena_destroy(&arena);
}
END_TEST

START_TEST(encodings)
{
    Lexer lexer;
    Error error;
    ck_assert(lexer_open(&lexer, "\xef\xbb\xbfIdentity", 11, &error));
    Token token = next(&lexer);
    ck_assert(token_is(&token, "Identity"));
    ck_assert_int_eq(token.place.column, 1);
    ck_assert(!lexer_open(&lexer, "\xff\xfeI\0", 4, &error));
    ck_assert_str_eq(error.message, "a.pbrt:1:1: error: the file is UTF-16");
    ck_assert(lexer_open(&lexer, "\"a\0b\"", 5, &error));
    ck_assert(!lexer_next(&lexer, &token, &error));
    ck_assert_str_eq(error.message, "a.pbrt:1:1: error: a string holds a NUL byte");
}
END_TEST

/* A file's tokens come through a window: those at its edges equal the tokens of the same text in memory. */
START_TEST(files_have_the_tokens_of_text)
{
    enum { SIZE = 5 * TEXT_WINDOW_BYTES };
    char *text = malloc(SIZE);
    unsigned state = 1;
    for (size_t i = 0; i < SIZE; ++i) {
        unsigned r = test_random(&state) % 1000;
        text[i] = "w\" []#\n\\"[r < 900 ? 0 : r < 980 ? 1 + 2 * (r % 2) : r % 8];
    }
    test_folder_make();
    test_file_write(test_path("text"), text, SIZE);
    FILE *file = fopen(test_path("text"), "rb");
    TextWindow window;
    ck_assert(text_window_from_file(&window, dup(fileno(file)), SIZE));
    fclose(file);
    Lexer lexer, reference;
    Error error = {{0}, {0}}, expected = {{0}, {0}};
    ck_assert(lexer_init(&lexer, &window, "a.pbrt", &error));
    ck_assert(lexer_open(&reference, text, SIZE, &expected));
    size_t count = 0, bad = 0;
    for (Token a, b; window.failure == 0; ++count) {
        bool good = lexer_next(&reference, &b, &expected);
        ck_assert(lexer_next(&lexer, &a, &error) == good);
        ck_assert_int_eq(a.place.line, b.place.line);
        ck_assert_int_eq(a.place.column, b.place.column);
        if (!good) { /* an unterminated string: continue after its quote */
            ck_assert_str_eq(error.message, expected.message);
            ++lexer.window.position;
            ++reference.window.position;
            ++bad;
            continue;
        }
        ck_assert_int_eq(a.kind, b.kind);
        ck_assert_uint_eq(a.length, b.length);
        ck_assert_mem_eq(a.text, b.text, a.length);
        if (a.kind == TOKEN_END)
            break;
    }
    ck_assert_uint_gt(count, 1000);
    ck_assert_uint_gt(bad, 10);
    lexer_destroy(&lexer);
    free(text);
    test_folder_remove();
}
END_TEST

START_TEST(tokens_are_bounded)
{
    static char text[TOKEN_LENGTH_MAX + 2];
    Lexer lexer;
    Error error = {{0}, {0}};
    Token token;
    memset(text, '1', sizeof text);
    ck_assert(lexer_open(&lexer, text, TOKEN_LENGTH_MAX, &error));
    ck_assert_uint_eq(next(&lexer).length, TOKEN_LENGTH_MAX);
    ck_assert(lexer_open(&lexer, text, sizeof text, &error));
    ck_assert(!lexer_next(&lexer, &token, &error));
    ck_assert_str_eq(error.message, "a.pbrt:1:1: error: a word of more than 65536 characters");
    text[0] = '"';
    ck_assert(lexer_open(&lexer, text, sizeof text, &error));
    ck_assert(!lexer_next(&lexer, &token, &error));
    ck_assert_str_eq(error.message, "a.pbrt:1:1: error: a string of more than 65536 characters");
    text[sizeof text - 1] = '"';
    ck_assert(lexer_open(&lexer, text, sizeof text, &error));
    ck_assert_uint_eq(next(&lexer).length, TOKEN_LENGTH_MAX);
}
END_TEST

static NumberStatus parse(const char *text, float *value)
{
    return number_float(text, strlen(text), value);
}

START_TEST(numbers_are_those_of_strtof)
{
    static const char *const TEXTS[] = {"0",
                                        "-0",
                                        "1",
                                        "-1",
                                        "+1",
                                        ".5",
                                        "5.",
                                        "1e5",
                                        "1E+5",
                                        "1e-5",
                                        "3.14159265358979323846",
                                        "16777217",
                                        "16777219",
                                        "0.1",
                                        "1e-45",
                                        "1.4e-45",
                                        "1.17549435e-38",
                                        "3.4028235e38",
                                        "1e-50",
                                        "123456789012345678901234567890",
                                        "0.000000000000000000000000000000000000001",
                                        "4.37114e-8",
                                        "8.589973e9",
                                        "9007199254740993",
                                        "1e22",
                                        "1e23",
                                        "0.000000059604644775390625",
                                        "1.00000005960464477539062500000000000000000001",
                                        "1.000000059604644775390625",
                                        "1.0000001788139343",
                                        "100000000000000000000e-20",
                                        "0e999999",
                                        "0.00000000000000000000000000000e12"};
    for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; ++i) {
        float value, wanted = strtof(TEXTS[i], NULL);
        ck_assert_int_eq(parse(TEXTS[i], &value), NUMBER_OK);
        ck_assert_msg(float_bits(value) == float_bits(wanted), "%s: %.9g, not %.9g", TEXTS[i], (double)value,
                      (double)wanted);
    }
}
END_TEST

/* Random digits, including ties: double rounding is wrong for about 1 in 2^29 uniform numbers, but for every tenth of
 * those built here. */
START_TEST(numbers_round_once)
{
    uint64_t state = 1;
    for (int i = 0; i < 200000; ++i) {
        char text[64];
        state = state * 6364136223846793005u + 1442695040888963407u;
        uint random = (uint)(state >> 32);
        double tie = (double)bits_float((random & 0x007fffffu) | 0x3f800000u) + 0x1p-24;
        snprintf(text, sizeof text, i % 2 ? "%.15g" : "%.14ge3", tie + (double)((int)(random >> 24) - 128) * 0x1p-56);
        float value;
        ck_assert_int_eq(parse(text, &value), NUMBER_OK);
        ck_assert_msg(float_bits(value) == float_bits(strtof(text, NULL)), "%s", text);
    }
}
END_TEST

START_TEST(numbers_refused)
{
    static const char *const MALFORMED[] = {"",    "-",   "+",     ".",  "e5",  "1e",  "1e+", "nan",
                                            "inf", "0x1", "1.2.3", "1 ", "--1", "1,5", "1f",  "infinity"};
    float value;
    int integer;
    for (size_t i = 0; i < sizeof MALFORMED / sizeof *MALFORMED; ++i)
        ck_assert_msg(parse(MALFORMED[i], &value) == NUMBER_MALFORMED, "%s", MALFORMED[i]);
    ck_assert_int_eq(parse("1e39", &value), NUMBER_OVERFLOW);
    ck_assert_int_eq(parse("-3.5e38", &value), NUMBER_OVERFLOW);
    ck_assert_int_eq(parse("1e999999999999", &value), NUMBER_OVERFLOW);
    ck_assert_int_eq(number_integer("2147483647", 10, &integer), NUMBER_OK);
    ck_assert_int_eq(integer, 2147483647);
    ck_assert_int_eq(number_integer("-2147483648", 11, &integer), NUMBER_OK);
    ck_assert_int_eq(integer, (int)(-2147483647 - 1));
    ck_assert_int_eq(number_integer("2147483648", 10, &integer), NUMBER_OVERFLOW);
    ck_assert_int_eq(number_integer("99999999999999999999", 20, &integer), NUMBER_OVERFLOW);
    ck_assert_int_eq(number_integer("1.0", 3, &integer), NUMBER_MALFORMED);
    ck_assert_int_eq(number_integer("-", 1, &integer), NUMBER_MALFORMED);
}
END_TEST

START_TEST(names_are_found)
{
    static char names[1000][8];
    NameTable table;
    Error error;
    name_table_init(&table);
    ck_assert_uint_eq(name_table_find(&table, "n1"), NONE);
    for (uint i = 0; i < 1000; ++i) {
        snprintf(names[i], sizeof names[i], "n%u", i);
        ck_assert(name_table_add(&table, names[i], 7 * i, &error));
    }
    for (uint i = 0; i < 1000; ++i)
        ck_assert_uint_eq(name_table_find(&table, names[i]), 7 * i);
    ck_assert_uint_eq(name_table_find(&table, "n1000"), NONE);
    ck_assert_str_eq(name_table_nearest(&table, "n99x"), "n99");
    char list[32];
    name_table_list(&table, list, sizeof list);
    ck_assert_str_eq(list, "n0, n1, n2, n3, n4, n5, n6 ...");
    name_table_destroy(&table);
    name_table_destroy(&table);
}
END_TEST

START_TEST(near_names)
{
    static const char *const NAMES[] = {"radius", "zmin", "zmax", "phimax"};
    ck_assert_int_eq(name_distance("kitten", "sitting", 10), 3);
    ck_assert_int_eq(name_distance("", "abc", 10), 3);
    ck_assert_int_eq(name_distance("abc", "xyz", 2), 2);
    ck_assert_str_eq(name_nearest("raduis", NAMES, 4), "radius");
    ck_assert_str_eq(name_nearest("Zmax", NAMES, 4), "zmax");
    ck_assert_ptr_null(name_nearest("colour", NAMES, 4));
}
END_TEST

TCase *import_text_case(void)
{
    TCase *tcase = tcase_create("text");
    tcase_add_test(tcase, tokens_have_kinds_and_places);
    tcase_add_test(tcase, strings_decode_escapes);
    tcase_add_test(tcase, encodings);
    tcase_add_test(tcase, files_have_the_tokens_of_text);
    tcase_add_test(tcase, tokens_are_bounded);
    tcase_add_test(tcase, numbers_are_those_of_strtof);
    tcase_add_test(tcase, numbers_round_once);
    tcase_add_test(tcase, numbers_refused);
    tcase_add_test(tcase, names_are_found);
    tcase_add_test(tcase, near_names);
    return tcase;
}
