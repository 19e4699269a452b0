SHARED_FILES += \
	shared/geometry/bilinear.h \
	shared/geometry/box.h \
	shared/geometry/bvh_traverse.h \
	shared/geometry/curve.h \
	shared/geometry/cylinder.h \
	shared/geometry/disk.h \
	shared/geometry/grid_emission.h \
	shared/geometry/media_walk.h \
	shared/geometry/medium.h \
	shared/geometry/medium_grid.h \
	shared/geometry/primitive.h \
	shared/geometry/ray.h \
	shared/geometry/sphere.h \
	shared/geometry/surface.h \
	shared/geometry/texture.h \
	shared/geometry/texture_map.h \
	shared/geometry/texture_procedural.h \
	shared/geometry/triangle.h
