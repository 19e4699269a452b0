/* The parts of the import tests, and what they share. */
#ifndef TWINLIGHT_TESTS_PBRT_TEST_IMPORT_H
#define TWINLIGHT_TESTS_PBRT_TEST_IMPORT_H

#include "pbrt/import.h"
#include "support/test_util.h"

TCase *import_text_case(void); /* lexer, numbers, names */
TCase *import_params_case(void);
TCase *import_transform_case(void);
TCase *import_settings_case(void); /* film, camera, filter, integrator, sampler */
TCase *import_shapes_case(void);
TCase *import_subdivide_case(void);
TCase *import_objects_case(void);
TCase *import_materials_case(void);
TCase *import_media_case(void); /* participating media */
TCase *import_places_case(void); /* lights and cameras in other media than declared */
TCase *import_nanovdb_case(void);
TCase *import_textures_case(void);
TCase *import_lights_case(void);
TCase *import_ply_case(void);
TCase *import_files_case(void); /* Include, Import, limits, the public scenes */
TCase *import_limits_case(void); /* counts of 32 bits and more */
TCase *import_bad_case(void); /* tests/bad */
TCase *import_corpus_case(void); /* tests/corpus */

/* The folder of the tests' sources. */
const char *import_tests_dir(void);

/* Imports the text; if that fails, so does the test, with the error message. File names are relative to `directory`. */
void import_text_in(const char *text, const char *directory, bool lenient, Scene *scene);

/* The same for text without file names. */
void import_text(const char *text, Scene *scene);

/* The same for text after WorldBegin. */
void import_world(const char *text, Scene *scene);

/* The message of an import that must fail, in a static buffer. */
const char *import_error(const char *text);

/* Log messages since the last call, in a static buffer: warnings and infos of an import. */
const char *import_log(void);

#define ELEMENT(scene, member, T, i) ARRAY_AT(&(scene)->member, T, i)

/* Check compares floats as doubles; the casts avoid the compiler's warning. */
#define ASSERT_FLOAT(a, b) ck_assert_double_eq((double)(a), (double)(b))
#define ASSERT_NEAR(a, b, tolerance) ck_assert_double_eq_tol((double)(a), (double)(b), (double)(tolerance))

/* |a - b| <= tolerance for all three components. */
void assert_vec3(Vec3 a, float x, float y, float z, float tolerance);

#endif
