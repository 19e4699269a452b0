# One Check program per area; each lists every unit of the area that can be wrong. A program of one file needs no list.
LDADD = tests/libfixtures.la libtwinlight_cpu.la $(OCL_LIBRARY) libtwinlight_host.la $(EMBREE_LIBS) $(OPENCL_LIBS) \
	$(CHECK_LIBS) $(MPFR_LIBS) -lm

if HAVE_CHECK
check_PROGRAMS += \
	tests/test_aim \
	tests/test_analytic \
	tests/test_bench \
	tests/test_bidirectional \
	tests/test_blend \
	tests/test_bsdf \
	tests/test_bvh \
	tests/test_chain \
	tests/test_chain_population \
	tests/test_chain_seeds \
	tests/test_chain_statistics \
	tests/test_compare \
	tests/test_emit \
	tests/test_film \
	tests/test_geometry \
	tests/test_mmlt \
	tests/test_numerics \
	tests/test_group \
	tests/test_import \
	tests/test_layers \
	tests/test_light \
	tests/test_math \
	tests/test_metrics \
	tests/test_options \
	tests/test_platform_bits \
	tests/test_pool \
	tests/test_reference \
	tests/test_render \
	tests/test_scenes \
	tests/test_shift \
	tests/test_texture \
	tests/test_verify
if HAVE_OPENCL
check_PROGRAMS += tests/test_opencl
endif
TESTS += $(check_PROGRAMS)
check_LTLIBRARIES = tests/libfixtures.la
endif

# The statistical tests with EFFORT times the samples, and cases that are left out of `make check`.
EFFORT = 8
LONG_TESTS = tests/test_bidirectional tests/test_bvh tests/test_film tests/test_mmlt tests/test_numerics tests/test_reference \
	tests/test_scenes tests/test_hostile.sh
if HAVE_OPENCL
LONG_TESTS += tests/test_opencl
endif
.PHONY: check-long
check-long:
	TWINLIGHT_TEST_EFFORT=$(EFFORT) $(MAKE) $(AM_MAKEFLAGS) check TESTS='$(LONG_TESTS)'

# Whether the tests see faults that are planted one at a time: mutants.sh -h. A quarter of an hour; not a part of any check.
.PHONY: mutants
mutants: twinlight$(EXEEXT)
	$(srcdir)/tests/mutants.sh -w mutants.work -p ./twinlight$(EXEEXT) -t mutants.md

# Kernels that one test program has had built serve the next, and the user's own cache is left alone.
TEST_CACHE = $(abs_top_builddir)/test-cache
AM_TESTS_ENVIRONMENT = XDG_CACHE_HOME='$(TEST_CACHE)'; export XDG_CACHE_HOME;
clean-local:
	rm -rf test-cache mutants.work mutants.md

EXTRA_DIST += \
	tests/analytic.h \
	tests/bidirectional.h \
	tests/bidirectional_path.h \
	tests/bsdf_cases.h \
	tests/bvh_scenes.h \
	tests/cli.sh \
	tests/filter_cases.h \
	tests/geometry_fixture.h \
	tests/geometry_suites.h \
	tests/instances.pbrt \
	tests/light_fixture.h \
	tests/mutants.md \
	tests/mutants.sh \
	tests/mutants.txt \
	tests/numerics.h \
	tests/opencl_probe.h \
	tests/render_fixture.h \
	tests/test_blend.h \
	tests/test_bvh.h \
	tests/test_chain.h \
	tests/test_emit.h \
	tests/test_files.h \
	tests/test_import.h \
	tests/test_light.h \
	tests/test_math.h \
	tests/test_opencl.h \
	tests/test_matrix.h \
	tests/test_util.h \
	tests/verify_fixture.h \
	tests/platform_probe.cl

if HAVE_OPENCL
OPENCL_PROBE = tests/opencl_probe.c
else
OPENCL_PROBE = tests/opencl_probe_absent.c
endif

# What several programs share.
tests_libfixtures_la_SOURCES = \
	tests/analytic_fixture.c \
	tests/bidirectional_groups.c \
	tests/bidirectional_scenes.c \
	tests/geometry_fixture.c \
	tests/render_fixture.c \
	tests/verify_fixture.c \
	$(OPENCL_PROBE)

tests_test_analytic_SOURCES = tests/test_analytic.c \
	tests/test_analytic_area.c \
	tests/test_analytic_bumps.c \
	tests/test_analytic_camera.c \
	tests/test_analytic_environment.c \
	tests/test_analytic_glass.c \
	tests/test_analytic_instances.c \
	tests/test_analytic_lights.c \
	tests/test_analytic_opaque.c \
	tests/test_analytic_textures.c

tests_test_bidirectional_SOURCES = tests/test_bidirectional.c \
	tests/bidirectional_path.c \
	tests/test_bidirectional_film.c \
	tests/test_bidirectional_running.c \
	tests/test_bidirectional_strategies.c \
	tests/test_bidirectional_walks.c \
	tests/test_bidirectional_weights.c

tests_test_blend_SOURCES = tests/test_blend.c \
	tests/test_blend_known.c

tests_test_bsdf_SOURCES = tests/test_bsdf.c \
	tests/test_bsdf_coated.c \
	tests/test_bsdf_energy.c \
	tests/test_bsdf_formulas.c \
	tests/test_bsdf_identities.c \
	tests/test_bsdf_inverse.c \
	tests/test_bsdf_sampling.c

tests_test_bvh_SOURCES = tests/test_bvh.c \
	tests/test_bvh_adversary.c \
	tests/test_bvh_build.c \
	tests/test_bvh_opencl.c \
	tests/bvh_scenes.c

tests_test_chain_SOURCES = tests/test_chain.c \
	tests/test_chain_shown.c

tests_test_emit_SOURCES = tests/test_emit.c \
	tests/test_emit_area.c \
	tests/test_emit_camera.c \
	tests/test_emit_direction.c \
	tests/test_emit_distance.c \
	tests/test_emit_image.c \
	tests/test_emit_power.c \
	tests/test_emit_splat.c

tests_test_film_SOURCES = tests/test_film.c \
	tests/test_film_files.c \
	tests/test_film_output.c

tests_test_geometry_SOURCES = tests/test_geometry.c \
	tests/test_geometry_backend.c \
	tests/test_geometry_quadrics.c \
	tests/test_geometry_rays.c

tests_test_import_SOURCES = tests/test_import.c \
	tests/test_import_bad.c \
	tests/test_import_files.c \
	tests/test_import_lights.c \
	tests/test_import_limits.c \
	tests/test_import_materials.c \
	tests/test_import_params.c \
	tests/test_import_ply.c \
	tests/test_import_settings.c \
	tests/test_import_shapes.c \
	tests/test_import_text.c \
	tests/test_import_textures.c \
	tests/test_import_transform.c

tests_test_light_SOURCES = tests/test_light.c \
	tests/test_light_area.c \
	tests/test_light_camera.c \
	tests/test_light_environment.c \
	tests/test_light_filter.c \
	tests/test_light_irradiance.c \
	tests/test_light_mis.c \
	tests/test_light_select.c

tests_test_math_SOURCES = tests/test_math.c \
	tests/test_math_alias.c \
	tests/test_math_distribution2d.c \
	tests/test_math_elementary.c \
	tests/test_math_elementary_pairs.c \
	tests/test_math_rng.c \
	tests/test_math_sphere_maps.c \
	tests/test_math_warp.c

tests_test_mmlt_SOURCES = tests/test_mmlt.c \
	tests/test_mmlt_shown.c

tests_test_numerics_SOURCES = tests/test_numerics.c \
	tests/test_numerics_film.c \
	tests/test_numerics_lights.c \
	tests/test_numerics_scale.c

tests_test_opencl_SOURCES = tests/test_opencl.c \
	tests/test_opencl_bits.c \
	tests/test_opencl_devices.c \
	tests/test_opencl_inspect.c \
	tests/test_opencl_pipeline.c \
	tests/test_opencl_program.c

tests_test_texture_SOURCES = tests/test_texture.c \
	tests/test_texture_color.c \
	tests/test_texture_files.c \
	tests/test_texture_image.c

# Rules of the tree itself, and the whole program from outside.
script_tests = \
	tests/check_layers.sh \
	tests/check_opencl.sh \
	tests/test_bench.sh \
	tests/test_cli.sh \
	tests/test_devices.sh \
	tests/test_hostile.sh \
	tests/test_outputs.sh
dist_check_SCRIPTS += $(script_tests)
TESTS += $(script_tests)
