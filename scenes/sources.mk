# Scenes drawn for Twinlight, installed as examples, and what they are made of.
scenesdir = $(pkgdatadir)/scenes
dist_scenes_DATA = \
	scenes/cornell.pbrt \
	scenes/cube.pbrt \
	scenes/door.pbrt \
	scenes/fire.pbrt \
	scenes/fog.pbrt \
	scenes/glass.pbrt \
	scenes/glossy.pbrt \
	scenes/hair.pbrt \
	scenes/lamp.pbrt \
	scenes/mirror.pbrt \
	scenes/pool.pbrt \
	scenes/relief.pbrt \
	scenes/ring.pbrt \
	scenes/showcase.pbrt \
	scenes/smoke.pbrt \
	scenes/tumbler.pbrt \
	scenes/windows.pbrt
scenepartsdir = $(scenesdir)/parts
dist_sceneparts_DATA = \
	scenes/parts/band.ply \
	scenes/parts/bottle.ply \
	scenes/parts/bowl.ply \
	scenes/parts/box.pbrt \
	scenes/parts/carafe-water.ply \
	scenes/parts/carafe-wet.ply \
	scenes/parts/carafe.ply \
	scenes/parts/fire.pbrt.gz \
	scenes/parts/goblet-water.ply \
	scenes/parts/goblet-wet.ply \
	scenes/parts/goblet.ply \
	scenes/parts/hair.pbrt.gz \
	scenes/parts/hammered.png \
	scenes/parts/jar.ply \
	scenes/parts/lemon.ply \
	scenes/parts/pane.ply \
	scenes/parts/smoke.pbrt \
	scenes/parts/sun.exr \
	scenes/parts/torus.ply \
	scenes/parts/tumbler-water.ply \
	scenes/parts/tumbler-wet.ply \
	scenes/parts/tumbler.ply \
	scenes/parts/vase.ply

# `make scene-parts` makes scenes/parts/ in the source folder again; `make scene-references` the pictures to compare with.
EXTRA_PROGRAMS += scenes/average_images scenes/make_fire scenes/make_hair scenes/make_parts scenes/make_smoke
scenes_average_images_SOURCES = scenes/average_images.c
scenes_average_images_LDADD = libtwinlight_host.la -lm
scenes_make_fire_SOURCES = scenes/make_fire.c
scenes_make_fire_LDADD = -lm
scenes_make_hair_SOURCES = scenes/make_hair.c
scenes_make_hair_LDADD = -lm
scenes_make_parts_SOURCES = scenes/make_parts.c
scenes_make_parts_LDADD = libtwinlight_host.la -lm
scenes_make_smoke_SOURCES = scenes/make_smoke.c
scenes_make_smoke_LDADD = libtwinlight_host.la -lm
CLEANFILES += scenes/average_images$(EXEEXT) scenes/make_fire$(EXEEXT) scenes/make_hair$(EXEEXT) \
	scenes/make_parts$(EXEEXT) scenes/make_smoke$(EXEEXT)
EXTRA_DIST += \
	scenes/make_references.sh \
	scenes/reference/cornell.exr \
	scenes/reference/door.exr \
	scenes/reference/glossy.exr \
	scenes/reference/lamp.exr \
	scenes/reference/pool.exr \
	scenes/reference/relief.exr \
	scenes/reference/windows.exr

.PHONY: scene-parts scene-references
scene-parts: scenes/make_parts$(EXEEXT) scenes/make_fire$(EXEEXT) scenes/make_hair$(EXEEXT) scenes/make_smoke$(EXEEXT)
	./scenes/make_parts$(EXEEXT) $(srcdir)/scenes
	./scenes/make_fire$(EXEEXT) | gzip -9n >$(srcdir)/scenes/parts/fire.pbrt.gz
	./scenes/make_hair$(EXEEXT) | gzip -9n >$(srcdir)/scenes/parts/hair.pbrt.gz
	./scenes/make_smoke$(EXEEXT) $(srcdir)/scenes
scene-references: twinlight$(EXEEXT) scenes/average_images$(EXEEXT)
	$(srcdir)/scenes/make_references.sh ./twinlight$(EXEEXT) ./scenes/average_images$(EXEEXT) $(srcdir)/scenes/reference

# Scenes that are hard on the arithmetic (docs/NUMERICS.md).
EXTRA_DIST += \
	scenes/hard/corner.pbrt \
	scenes/hard/far.pbrt \
	scenes/hard/scaled.pbrt \
	scenes/hard/sun.pbrt \
	scenes/hard/tiny.pbrt
