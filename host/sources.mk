noinst_LTLIBRARIES += libtwinlight_host.la
libtwinlight_host_la_SOURCES = \
	host/aim_setup.c host/aim_setup.h \
	host/arena.c host/arena.h \
	host/array.c host/array.h \
	host/backend.h \
	host/bad_chains.c host/bad_chains.h \
	host/backend_choice.c host/backend_choice.h \
	host/backend_group.c host/backend_group.h \
	host/backend_table.h \
	host/bench.h \
	host/bench_analysis.c host/bench_analysis.h \
	host/bench_chains.c \
	host/bench_figures.c \
	host/bench_html.c host/bench_html.h \
	host/bench_options.c host/bench_options.h \
	host/bench_pictures.c \
	host/bench_record.c host/bench_record.h \
	host/bench_render.c host/bench_render.h \
	host/bench_style.c \
	host/bench_tables.c host/bench_tables.h \
	host/bench_task.c host/bench_task.h \
	host/blend.c host/blend.h \
	host/blend_learn.c host/blend_learn.h \
	host/build_info.c host/build_info.h \
	host/bvh.c host/bvh.h \
	host/bvh_tree.c host/bvh_tree.h \
	host/camera_setup.c host/camera_setup.h \
	host/cmd_bench.c \
	host/cmd_compare.c host/cmd_compare.h \
	host/cmd_devices.c \
	host/cmd_info.c \
	host/cmd_pyramid.c \
	host/chain_groups.c host/chain_groups.h \
	host/chain_list.c host/chain_list.h \
	host/chain_population.c host/chain_population.h \
	host/importance.c host/importance.h \
	host/chain_seeds.c host/chain_seeds.h \
	host/chain_statistics.c host/chain_statistics.h \
	host/cmd_render.c \
	host/coat_table.c host/coat_table.h \
	host/color.c host/color.h \
	host/contact_sheet.c host/contact_sheet.h \
	host/color_named.c \
	host/color_tables.h \
	host/command.h \
	host/compare_print.c host/compare_print.h \
	host/despeckle.c host/despeckle.h \
	host/display_error.c host/display_error.h \
	host/distribution_build.c host/distribution_build.h \
	host/error.c host/error.h \
	host/error_image.c host/error_image.h \
	host/exit_status.h \
	host/exr.c host/exr.h \
	host/file_read.c host/file_read.h \
	host/film.c host/film.h \
	host/film_pilot.c host/film_pilot.h \
	host/filter_setup.c host/filter_setup.h \
	host/flip.c \
	host/frame_name.c host/frame_name.h \
	host/hash.h \
	host/html.c host/html.h \
	host/input_files.c host/input_files.h \
	host/image.c host/image.h \
	host/image_exr.c \
	host/image_exr_dwa.c \
	host/image_formats.h \
	host/image_pfm.c \
	host/image_read.c host/image_read.h \
	host/image_stb.c \
	host/instance_bounds.h \
	host/integrator.c host/integrator.h \
	host/bd_fields.c host/bd_fields.h \
	host/integrator_bdpt.c \
	host/integrator_ibpt.c \
	host/integrator_mmlt.c \
	host/integrator_pt.c \
	host/interrupt.c host/interrupt.h \
	host/json.c host/json.h \
	host/light_setup.c host/light_setup.h \
	host/log.c host/log.h \
	host/matrix.c host/matrix.h \
	host/metrics.c host/metrics.h \
	host/mmlt.h \
	host/mmlt_bad.c \
	host/mmlt_generation.c \
	host/mmlt_pool.c \
	host/name_table.c host/name_table.h \
	host/option_values.c host/option_values.h \
	host/options.c host/options.h \
	host/output_check.c host/output_check.h \
	host/output_file.c host/output_file.h \
	host/path_name.c host/path_name.h \
	host/pbrt_context.c host/pbrt_context.h \
	host/pbrt_directives.c host/pbrt_directives.h \
	host/pbrt_errors.c host/pbrt_errors.h \
	host/pbrt_film_camera.c \
	host/pbrt_import.c host/pbrt_import.h \
	host/pbrt_import_options.h \
	host/pbrt_lexer.c host/pbrt_lexer.h \
	host/pbrt_lights.c \
	host/pbrt_materials.c \
	host/pbrt_mesh.c host/pbrt_mesh.h \
	host/pbrt_objects.c \
	host/pbrt_options.c \
	host/pbrt_param_list.c \
	host/pbrt_params.c host/pbrt_params.h \
	host/pbrt_parser.c host/pbrt_parser.h \
	host/pbrt_readers.h \
	host/pbrt_shape_add.c host/pbrt_shape_add.h \
	host/pbrt_shapes.c \
	host/pbrt_state.c host/pbrt_state.h \
	host/pbrt_textures.c \
	host/pbrt_values.c host/pbrt_values.h \
	host/picture.c host/picture.h \
	host/pixel_order.c host/pixel_order.h \
	host/pixel_series.c host/pixel_series.h \
	host/plane_filter.c host/plane_filter.h \
	host/ply.c host/ply.h \
	host/ply_header.c host/ply_header.h \
	host/png_write.c host/png_write.h \
	host/progress.c host/progress.h \
	host/ray_reach.c host/ray_reach.h \
	host/render.c host/render.h \
	host/render_job.h \
	host/render_layers.c host/render_layers.h \
	host/render_run.c host/render_run.h \
	host/render_options.c host/render_options.h \
	host/render_output.c host/render_output.h \
	host/render_report.c host/render_report.h \
	host/render_settings.c host/render_settings.h \
	host/render_verify.c host/render_verify.h \
	host/rendering_file.c host/rendering_file.h \
	host/sample_statistics.c host/sample_statistics.h \
	host/scene.c host/scene.h \
	host/scene_center.c host/scene_center.h \
	host/scene_finish.c \
	host/scene_format.c host/scene_format.h \
	host/scene_advice.c host/scene_advice.h \
	host/scene_pack.c host/scene_pack.h \
	host/scene_summary.c host/scene_summary.h \
	host/ssim.c \
	host/startup.c host/startup.h \
	host/stats.c host/stats.h \
	host/student.c host/student.h \
	host/svg_chart.c host/svg_chart.h \
	host/step_recorder.c host/step_recorder.h \
	host/temporary_file.c host/temporary_file.h \
	host/text_number.c host/text_number.h \
	host/text_window.c host/text_window.h \
	host/texture_image.c host/texture_image.h \
	host/timing.c host/timing.h \
	host/trace_output.c host/trace_output.h \
	host/verify.c host/verify.h \
	host/z_test.c host/z_test.h
libtwinlight_host_la_LIBADD = $(EMBREE_LIBS) $(EXR_LIBS) $(OPENEXR_LIBS) $(PNG_LIBS) $(ZLIB_LIBS) $(STB_LIBS) -lm

# The commit goes into reports of measurements; the file changes only when that does.
host/build_info.lo: build_commit.h
.PHONY: commit
commit:
build_commit.h: commit
	@commit=`git -C $(srcdir) describe --always --dirty 2>/dev/null || echo unknown`; \
	  echo "#define BUILD_COMMIT \"$$commit\"" >$@.new; \
	  if cmp -s $@.new $@; then rm $@.new; else mv $@.new $@; fi
CLEANFILES += build_commit.h

bin_PROGRAMS += twinlight
twinlight_SOURCES = host/main.c
twinlight_LDADD = libtwinlight_cpu.la $(OCL_LIBRARY) libtwinlight_host.la $(EMBREE_LIBS)
