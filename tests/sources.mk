# One Check program per area; each lists every unit of the area that can be wrong.
LDADD = tests/libfixtures.la libtwinlight_cpu.la $(OCL_LIBRARY) libtwinlight_host.la $(EMBREE_LIBS) $(OPENCL_LIBS) \
	$(CHECK_LIBS) $(MPFR_LIBS) -lm

# Those that take longest come first, so that all processors have work until the end.
if HAVE_CHECK
if HAVE_OPENCL
check_PROGRAMS += tests/test_opencl
endif
check_PROGRAMS += \
	tests/test_mmlt \
	tests/test_bidirectional \
	tests/test_caustic \
	tests/test_bsdf \
	tests/test_analytic \
	tests/test_archive \
	tests/test_key_sort \
	tests/test_light_guide \
	tests/test_bench \
	tests/test_combination \
	tests/test_bvh \
	tests/test_chain \
	tests/test_chain_population \
	tests/test_chain_seeds \
	tests/test_chain_statistics \
	tests/test_checkpoint \
	tests/test_compare \
	tests/test_emit \
	tests/test_error \
	tests/test_film \
	tests/test_geometry \
	tests/test_numerics \
	tests/test_openings \
	tests/test_group \
	tests/test_import \
	tests/test_layers \
	tests/test_light \
	tests/test_math \
	tests/test_grid_emission \
	tests/test_medium_grid \
	tests/test_metrics \
	tests/test_mlt_option \
	tests/test_options \
	tests/test_partition \
	tests/test_platform_bits \
	tests/test_photon_lights \
	tests/test_plan \
	tests/test_pool \
	tests/test_progress \
	tests/test_ranks \
	tests/test_reference \
	tests/test_render \
	tests/test_restore \
	tests/test_scenes \
	tests/test_serve \
	tests/test_shard \
	tests/test_shift \
	tests/test_texture \
	tests/test_tile_light \
	tests/test_verify
if HAVE_ASSIMP
check_PROGRAMS += tests/test_gltf
endif
TESTS += $(check_PROGRAMS)
check_LTLIBRARIES = tests/libfixtures.la
endif

# The statistical tests with EFFORT times the samples, and cases that `make check` leaves out.
EFFORT = 8
# Builds a copy with a BSDF and an integrator more: minutes.
dist_check_SCRIPTS += tests/test_recipes.sh
LONG_TESTS = tests/test_analytic tests/test_bidirectional tests/test_bsdf tests/test_bvh tests/test_caustic tests/test_error tests/test_film tests/test_mmlt tests/test_numerics tests/test_reference \
	tests/test_scenes tests/command/test_checkpoint.sh tests/command/test_hostile.sh
if HAVE_OPENCL
LONG_TESTS += tests/test_opencl
endif
.PHONY: check-long
check-long:
	srcdir='$(srcdir)' $(srcdir)/tests/test_recipes.sh
	TWINLIGHT_TEST_EFFORT=$(EFFORT) $(MAKE) $(AM_MAKEFLAGS) check TESTS='$(LONG_TESTS)'

# Whether the tests detect faults that are planted one at a time: mutants.sh -h. Takes hours; not part of any check.
.PHONY: mutants
mutants: twinlight$(EXEEXT)
	$(srcdir)/tests/mutants/mutants.sh -w mutants.work -p ./twinlight$(EXEEXT) -t mutants.md

# Kernels built by one test program serve the next, without touching the user's own cache.
TEST_CACHE = $(abs_top_builddir)/test-cache
AM_TESTS_ENVIRONMENT = XDG_CACHE_HOME='$(TEST_CACHE)'; export XDG_CACHE_HOME;
clean-local:
	rm -rf test-cache mutants.work mutants.md

EXTRA_DIST += \
	tests/support/analytic.h \
	tests/support/bidirectional.h \
	tests/path/bidirectional_path.h \
	tests/support/bsdf_cases.h \
	tests/geometry/bvh_scenes.h \
	tests/support/cli.sh \
	tests/support/filter_cases.h \
	tests/support/geometry_fixture.h \
	tests/geometry/geometry_suites.h \
	tests/instances.pbrt \
	tests/support/light_fixture.h \
	tests/coverage.md tests/coverage.sh \
	tests/mutants/mutants.md \
	tests/mutants/mutants.sh \
	tests/mutants/mutants.txt \
	tests/support/numerics.h \
	tests/support/opencl_probe.h \
	tests/support/render_fixture.h \
	tests/support/room_scene.h \
	tests/mmlt/test_combination.h \
	tests/mmlt/test_combination_estimators.h \
	tests/mmlt/test_combination_model.h \
	tests/geometry/test_bvh.h \
	tests/mmlt/test_chain.h \
	tests/mmlt/test_partition.h \
	tests/mmlt/test_partition_state.h \
	tests/film/test_film.h \
	tests/light/test_emit.h \
	tests/support/test_files.h \
	tests/gltf/test_gltf.h \
	tests/pbrt/test_import.h \
	tests/light/test_light.h \
	tests/math/test_math.h \
	tests/backend/test_opencl.h \
	tests/support/test_matrix.h \
	tests/serve/served.h \
	tests/serve/test_serve.h \
	tests/support/test_util.h \
	tests/support/verify_fixture.h \
	tests/support/walk_kernels.h \
	tests/math/platform_probe.cl

if HAVE_OPENCL
OPENCL_PROBE = tests/support/opencl_probe.c
else
OPENCL_PROBE = tests/support/opencl_probe_absent.c
endif

# Shared by several programs.
tests_libfixtures_la_SOURCES = \
	tests/support/analytic_fixture.c \
	tests/support/bidirectional_groups.c \
	tests/support/bidirectional_scenes.c \
	tests/support/geometry_fixture.c \
	tests/support/render_fixture.c \
	tests/support/verify_fixture.c \
	tests/support/walk_kernels.c \
	$(OPENCL_PROBE)

tests_test_archive_SOURCES = tests/base/test_archive.c
tests_test_key_sort_SOURCES = tests/base/test_key_sort.c
tests_test_light_guide_SOURCES = tests/light/test_light_guide.c
tests_test_bench_SOURCES = tests/bench/test_bench.c
tests_test_caustic_SOURCES = tests/path/test_caustic.c tests/path/test_caustic.h \
	tests/path/test_caustic_photons.c tests/path/test_caustic_search.c
tests_test_chain_population_SOURCES = tests/mmlt/test_chain_population.c
tests_test_chain_seeds_SOURCES = tests/mmlt/test_chain_seeds.c
tests_test_chain_statistics_SOURCES = tests/mmlt/test_chain_statistics.c
tests_test_checkpoint_SOURCES = tests/render/test_checkpoint.c
tests_test_compare_SOURCES = tests/compare/test_compare.c
tests_test_error_SOURCES = tests/render/test_error.c tests/render/test_error.h tests/render/test_error_estimate.c
tests_test_group_SOURCES = tests/backend/test_group.c
tests_test_layers_SOURCES = tests/render/test_layers.c
tests_test_grid_emission_SOURCES = tests/geometry/test_grid_emission.c tests/geometry/trilinear.h
tests_test_medium_grid_SOURCES = tests/geometry/test_medium_grid.c tests/geometry/trilinear.h
tests_test_metrics_SOURCES = tests/compare/test_metrics.c
tests_test_mlt_option_SOURCES = tests/command/test_mlt_option.c
tests_test_options_SOURCES = tests/command/test_options.c
tests_test_progress_SOURCES = tests/render/test_progress.c
tests_test_platform_bits_SOURCES = tests/math/test_platform_bits.c
tests_test_photon_lights_SOURCES = tests/render/test_photon_lights.c
tests_test_plan_SOURCES = tests/mmlt/test_plan.c
tests_test_pool_SOURCES = tests/mmlt/test_pool.c
tests_test_ranks_SOURCES = tests/ranks/test_ranks.c
tests_test_reference_SOURCES = tests/render/test_reference.c
tests_test_render_SOURCES = tests/render/test_render.c
tests_test_restore_SOURCES = tests/render/test_restore.c
tests_test_scenes_SOURCES = tests/render/test_scenes.c
tests_test_shard_SOURCES = tests/render/test_shard.c
tests_test_shift_SOURCES = tests/mmlt/test_shift.c
tests_test_openings_SOURCES = tests/render/test_openings.c
tests_test_tile_light_SOURCES = tests/render/test_tile_light.c
tests_test_verify_SOURCES = tests/render/test_verify.c

tests_test_analytic_SOURCES = tests/render/test_analytic.c \
	tests/render/test_analytic_area.c \
	tests/render/test_analytic_bumps.c \
	tests/render/test_analytic_camera.c \
	tests/render/test_analytic_environment.c \
	tests/render/test_analytic_glass.c \
	tests/render/test_analytic_instances.c \
	tests/render/test_analytic_intensity.c \
	tests/render/test_analytic_lights.c \
	tests/render/test_analytic_media.c \
	tests/render/test_analytic_opaque.c \
	tests/render/test_analytic_textures.c

tests_test_bidirectional_SOURCES = tests/path/test_bidirectional.c \
	tests/path/bidirectional_path.c \
	tests/path/test_bidirectional_film.c \
	tests/path/test_bidirectional_running.c \
	tests/path/test_bidirectional_spread.c \
	tests/path/test_bidirectional_strategies.c \
	tests/path/test_bidirectional_walks.c \
	tests/path/test_bidirectional_weights.c

tests_test_combination_SOURCES = tests/mmlt/test_combination.c \
	tests/mmlt/test_combination_bidirectional.c \
	tests/mmlt/test_combination_estimators.c \
	tests/mmlt/test_combination_few.c \
	tests/mmlt/test_combination_known.c \
	tests/mmlt/test_combination_model.c \
	tests/mmlt/test_combination_rare.c

tests_test_bsdf_SOURCES = tests/bsdf/test_bsdf.c \
	tests/bsdf/test_bsdf_coated.c \
	tests/bsdf/test_bsdf_coat_medium.c \
	tests/bsdf/test_bsdf_mix.c \
	tests/bsdf/test_bsdf_coated_conductor.c \
	tests/bsdf/test_bsdf_energy.c \
	tests/bsdf/test_bsdf_formulas.c \
	tests/bsdf/test_bsdf_hair.c \
	tests/bsdf/test_bsdf_identities.c \
	tests/bsdf/test_bsdf_inverse.c \
	tests/bsdf/test_bsdf_phase.c \
	tests/bsdf/test_bsdf_sampling.c

tests_test_bvh_SOURCES = tests/geometry/test_bvh.c \
	tests/geometry/test_bvh_adversary.c \
	tests/geometry/test_bvh_build.c \
	tests/geometry/test_bvh_opencl.c \
	tests/geometry/bvh_scenes.c

tests_test_chain_SOURCES = tests/mmlt/test_chain.c \
	tests/mmlt/test_chain_shown.c

tests_test_emit_SOURCES = tests/light/test_emit.c \
	tests/light/test_emit_aims.c \
	tests/light/test_emit_area.c \
	tests/light/test_emit_camera.c \
	tests/light/test_emit_spherical.c \
	tests/light/test_emit_direction.c \
	tests/light/test_emit_distance.c \
	tests/light/test_emit_image.c \
	tests/light/test_emit_openings.c \
	tests/light/test_emit_power.c \
	tests/light/test_emit_splat.c

tests_test_film_SOURCES = tests/film/test_film.c \
	tests/film/test_film_complete.c \
	tests/film/test_film_files.c \
	tests/film/test_film_output.c \
	tests/film/test_film_spread.c \
	tests/film/test_film_units.c \
	tests/film/test_film_words.c

tests_test_geometry_SOURCES = tests/geometry/test_geometry.c \
	tests/geometry/test_geometry_backend.c \
	tests/geometry/test_geometry_curve.c \
	tests/geometry/test_geometry_cylinder.c \
	tests/geometry/test_geometry_quadrics.c \
	tests/geometry/test_geometry_rays.c

tests_test_gltf_SOURCES = tests/gltf/test_gltf.c \
	tests/gltf/test_gltf_bad.c \
	tests/gltf/test_gltf_convert.c \
	tests/gltf/test_gltf_materials.c \
	tests/gltf/test_gltf_scene.c \
	tests/gltf/test_gltf_skins.c \
	tests/gltf/test_gltf_textures.c

tests_test_import_SOURCES = tests/pbrt/test_import.c \
	tests/pbrt/test_import_bad.c \
	tests/pbrt/test_import_files.c \
	tests/pbrt/test_import_lights.c \
	tests/pbrt/test_import_limits.c \
	tests/pbrt/test_import_materials.c \
	tests/pbrt/test_import_media.c \
	tests/pbrt/test_import_nanovdb.c \
	tests/pbrt/test_import_params.c \
	tests/pbrt/test_import_places.c \
	tests/pbrt/test_import_ply.c \
	tests/pbrt/test_import_settings.c \
	tests/pbrt/test_import_shapes.c \
	tests/pbrt/test_import_text.c \
	tests/pbrt/test_import_textures.c \
	tests/pbrt/test_import_transform.c \
	tests/pbrt/test_subdivide.c

tests_test_light_SOURCES = tests/light/test_light.c \
	tests/light/test_light_area.c \
	tests/light/test_light_camera.c \
	tests/light/test_light_environment.c \
	tests/light/test_light_filter.c \
	tests/light/test_light_irradiance.c \
	tests/light/test_light_mis.c \
	tests/light/test_light_portal.c \
	tests/light/test_light_select.c \
	tests/light/test_light_bounds.c \
	tests/light/test_light_tree.c

tests_test_math_SOURCES = tests/math/test_math.c \
	tests/math/test_math_alias.c \
	tests/math/test_math_distribution2d.c \
	tests/math/test_math_elementary.c \
	tests/math/test_math_elementary_pairs.c \
	tests/math/test_math_rng.c \
	tests/math/test_math_sobol.c \
	tests/math/test_math_sphere_maps.c \
	tests/math/test_math_warp.c

tests_test_mmlt_SOURCES = tests/mmlt/test_mmlt.c \
	tests/mmlt/test_mmlt_easy.c \
	tests/mmlt/test_mmlt_shown.c

tests_test_numerics_SOURCES = tests/render/test_numerics.c \
	tests/render/test_numerics_film.c \
	tests/render/test_numerics_lights.c \
	tests/render/test_numerics_scale.c

tests_test_opencl_SOURCES = tests/backend/test_opencl.c \
	tests/backend/test_opencl_bits.c \
	tests/backend/test_opencl_devices.c \
	tests/backend/test_opencl_inspect.c \
	tests/backend/test_opencl_pipeline.c \
	tests/backend/test_opencl_program.c

tests_test_partition_SOURCES = tests/mmlt/test_partition.c \
	tests/mmlt/test_partition_kernels.c \
	tests/mmlt/test_partition_replay.c

tests_test_serve_SOURCES = tests/serve/test_serve.c \
	tests/serve/served.c \
	tests/serve/test_serve_clients.c \
	tests/serve/test_serve_page.c \
	tests/serve/test_serve_tev.c

tests_test_texture_SOURCES = tests/image/test_texture.c \
	tests/image/test_texture_color.c \
	tests/image/test_texture_files.c \
	tests/image/test_texture_image.c \
	tests/image/test_texture_procedural.c

# Rules of the source tree, and end-to-end tests of the program. test_devices.sh comes late: test_cli.sh has built what both need.
script_tests = \
	tests/check_layers.sh \
	tests/check_parameters.sh \
	tests/check_opencl.sh \
	tests/bench/test_bench.sh \
	tests/command/test_checkpoint.sh \
	tests/command/test_cli.sh \
	tests/command/test_convert.sh \
	tests/command/test_hostile.sh \
	tests/command/test_merge.sh \
	tests/command/test_mpi.sh \
	tests/command/test_outputs.sh \
	tests/command/test_devices.sh \
	tests/command/test_readme.sh
dist_check_SCRIPTS += $(script_tests)
TESTS += $(script_tests)
