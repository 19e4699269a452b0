# Scenes drawn for Twinlight, installed as examples.
scenesdir = $(pkgdatadir)/scenes
dist_scenes_DATA = \
	scenes/cornell.pbrt \
	scenes/door.pbrt \
	scenes/lamp.pbrt \
	scenes/pool.pbrt \
	scenes/showcase.pbrt
