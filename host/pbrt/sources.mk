libtwinlight_host_la_SOURCES += \
	host/pbrt/coats.c host/pbrt/coats.h \
	host/pbrt/context.c host/pbrt/context.h \
	host/pbrt/curve.c host/pbrt/curve.h \
	host/pbrt/directives.c host/pbrt/directives.h \
	host/pbrt/errors.c host/pbrt/errors.h \
	host/pbrt/film_camera.c \
	host/pbrt/hair.c host/pbrt/hair.h \
	host/pbrt/import.c host/pbrt/import.h \
	host/pbrt/import_options.h \
	host/pbrt/late.c host/pbrt/late.h \
	host/pbrt/lexer.c host/pbrt/lexer.h \
	host/pbrt/light_images.c host/pbrt/light_reader.h \
	host/pbrt/lights.c \
	host/pbrt/materials.c \
	host/pbrt/media_places.c host/pbrt/media_places.h \
	host/pbrt/media.c host/pbrt/media.h host/pbrt/media_presets.h \
	host/pbrt/media_cloud.c host/pbrt/media_grid.c host/pbrt/media_nanovdb.c \
	host/pbrt/mesh.c host/pbrt/mesh.h \
	host/pbrt/nanovdb.c host/pbrt/nanovdb.h \
	host/pbrt/needs.c host/pbrt/needs.h \
	host/pbrt/objects.c \
	host/pbrt/options.c \
	host/pbrt/param_list.c \
	host/pbrt/params.c host/pbrt/params.h \
	host/pbrt/parser.c host/pbrt/parser.h \
	host/pbrt/ply.c host/pbrt/ply.h \
	host/pbrt/ply_header.c host/pbrt/ply_header.h \
	host/pbrt/ply_values.c host/pbrt/ply_values.h \
	host/pbrt/polygon.c host/pbrt/polygon.h \
	host/pbrt/readers.h \
	host/pbrt/ribbon.c host/pbrt/ribbon.h \
	host/pbrt/shape_add.c host/pbrt/shape_add.h \
	host/pbrt/shapes.c \
	host/pbrt/state.c host/pbrt/state.h \
	host/pbrt/subdivide.c host/pbrt/subdivide.h \
	host/pbrt/subdivide_level.c host/pbrt/subdivide_level.h \
	host/pbrt/texture_builder.h host/pbrt/texture_procedural.c \
	host/pbrt/textures.c \
	host/pbrt/transforms.c host/pbrt/transforms.h \
	host/pbrt/values.c host/pbrt/values.h
