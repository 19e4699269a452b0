# One Check program per area; each lists every unit of the area that can be wrong.
TEST_LIBS = libtwinlight_cpu.la libtwinlight_host.la $(EMBREE_LIBS) $(CHECK_LIBS) $(MPFR_LIBS) -lm

if HAVE_CHECK
check_PROGRAMS += \
	tests/test_bsdf \
	tests/test_film \
	tests/test_geometry \
	tests/test_import \
	tests/test_light \
	tests/test_math \
	tests/test_render \
	tests/test_texture
TESTS += $(check_PROGRAMS)
endif

tests_test_bsdf_SOURCES = tests/test_bsdf.c tests/test_util.h
tests_test_film_SOURCES = tests/test_film.c tests/test_util.h
tests_test_geometry_SOURCES = \
	tests/geometry_fixture.c tests/geometry_fixture.h tests/geometry_suites.h \
	tests/test_geometry.c \
	tests/test_geometry_backend.c \
	tests/test_geometry_quadrics.c \
	tests/test_geometry_rays.c \
	tests/test_util.h
tests_test_import_SOURCES = tests/test_import.c tests/test_util.h
tests_test_light_SOURCES = tests/test_light.c tests/test_util.h
tests_test_math_SOURCES = tests/test_math.c tests/test_util.h
tests_test_render_SOURCES = tests/test_render.c tests/render_fixture.c tests/render_fixture.h tests/test_util.h
tests_test_texture_SOURCES = tests/test_texture.c tests/test_util.h

tests_test_bsdf_CFLAGS = $(AM_CFLAGS) $(CHECK_CFLAGS)
tests_test_film_CFLAGS = $(AM_CFLAGS) $(CHECK_CFLAGS)
tests_test_geometry_CFLAGS = $(AM_CFLAGS) $(CHECK_CFLAGS)
tests_test_import_CFLAGS = $(AM_CFLAGS) $(CHECK_CFLAGS)
tests_test_light_CFLAGS = $(AM_CFLAGS) $(CHECK_CFLAGS)
tests_test_math_CFLAGS = $(AM_CFLAGS) $(CHECK_CFLAGS)
tests_test_render_CFLAGS = $(AM_CFLAGS) $(CHECK_CFLAGS)
tests_test_texture_CFLAGS = $(AM_CFLAGS) $(CHECK_CFLAGS)

tests_test_bsdf_LDADD = $(TEST_LIBS)
tests_test_film_LDADD = $(TEST_LIBS)
tests_test_geometry_LDADD = $(TEST_LIBS)
tests_test_import_LDADD = $(TEST_LIBS)
tests_test_light_LDADD = $(TEST_LIBS)
tests_test_math_LDADD = $(TEST_LIBS)
tests_test_render_LDADD = $(TEST_LIBS)
tests_test_texture_LDADD = $(TEST_LIBS)

# The command line: its parts, and the whole program.
if HAVE_CHECK
check_PROGRAMS += tests/test_options
endif
tests_test_options_SOURCES = tests/test_options.c tests/test_util.h
tests_test_options_CFLAGS = $(AM_CFLAGS) $(CHECK_CFLAGS)
tests_test_options_LDADD = $(TEST_LIBS)

dist_check_SCRIPTS += tests/test_cli.sh
TESTS += tests/test_cli.sh
