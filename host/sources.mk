noinst_LTLIBRARIES += libtwinlight_host.la
libtwinlight_host_la_SOURCES = \
	host/array.c host/array.h \
	host/backend.h \
	host/error.c host/error.h \
	host/log.c host/log.h \
	host/arena.c host/arena.h \
	host/file_read.c host/file_read.h \
	host/matrix.c host/matrix.h \
	host/name_table.c host/name_table.h \
	host/pbrt_context.h \
	host/pbrt_directives.c host/pbrt_directives.h \
	host/pbrt_film_camera.c \
	host/pbrt_import.c host/pbrt_import.h \
	host/pbrt_lexer.c host/pbrt_lexer.h \
	host/pbrt_lights.c \
	host/pbrt_materials.c \
	host/pbrt_mesh.c host/pbrt_mesh.h \
	host/pbrt_objects.c \
	host/pbrt_options.c \
	host/pbrt_param_list.c \
	host/pbrt_params.c host/pbrt_params.h \
	host/pbrt_parser.c host/pbrt_parser.h \
	host/pbrt_shapes.c host/pbrt_shapes.h \
	host/pbrt_state.c host/pbrt_state.h \
	host/pbrt_textures.c \
	host/pbrt_values.c host/pbrt_values.h \
	host/ply.c host/ply.h \
	host/ply_header.c host/ply_internal.h \
	host/text_number.c host/text_number.h \
	host/scene.c host/scene.h \
	host/scene_finish.c
libtwinlight_host_la_LIBADD = $(EXR_LIBS) $(OPENEXR_LIBS) $(PNG_LIBS) $(ZLIB_LIBS) $(STB_LIBS) -lm

bin_PROGRAMS += twinlight
twinlight_SOURCES = host/main.c
twinlight_LDADD = libtwinlight_cpu.la libtwinlight_host.la $(EMBREE_LIBS)
