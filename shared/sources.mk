# Shared kernels and what they use: headers of the common subset of C11 and OpenCL C 1.2, and kernel files (.cl).
SHARED_FILES = \
	shared/aov.cl \
	shared/bd_connect.cl \
	shared/bd_connect.h \
	shared/bd_random.h \
	shared/bd_start.h \
	shared/bd_state.h \
	shared/bd_walk.cl \
	shared/bd_walk.h \
	shared/bd_weight.h \
	shared/bilinear.h \
	shared/box.h \
	shared/bsdf.h \
	shared/bsdf_coated.h \
	shared/bsdf_conductor.h \
	shared/bsdf_dielectric.h \
	shared/bsdf_diffuse.h \
	shared/bsdf_diffuse_transmission.h \
	shared/bsdf_state.h \
	shared/bsdf_thin_dielectric.h \
	shared/bvh_traverse.h \
	shared/camera.h \
	shared/chain.h \
	shared/coat.h \
	shared/count.cl \
	shared/diagnostics.h \
	shared/disk.h \
	shared/distribution.h \
	shared/elementary.h \
	shared/film_add.cl \
	shared/film_splat.h \
	shared/film_sum.h \
	shared/fresnel.h \
	shared/ib_weight.h \
	shared/ibpt.cl \
	shared/item.h \
	shared/kernel_list.h \
	shared/kernels.cl \
	shared/light.h \
	shared/light_area.h \
	shared/light_delta.h \
	shared/light_emit.h \
	shared/light_infinite.h \
	shared/material.h \
	shared/microfacet.h \
	shared/mis.h \
	shared/mlt.cl \
	shared/mutation.h \
	shared/path_random.h \
	shared/path_state.h \
	shared/path_types.h \
	shared/pixel_filter.h \
	shared/platform.h \
	shared/platform_double.h \
	shared/pool.h \
	shared/primitive.h \
	shared/pt.cl \
	shared/ray.h \
	shared/rng.h \
	shared/scaled.h \
	shared/scene_types.h \
	shared/scene_view.h \
	shared/sphere.h \
	shared/state.h \
	shared/strategy.h \
	shared/struct_members.h \
	shared/surface.h \
	shared/texture.h \
	shared/trace.cl \
	shared/triangle.h \
	shared/vec.h \
	shared/walk.cl \
	shared/warp.h

# Installed with the program: OpenCL builds its programs from them.
shareddir = $(pkgdatadir)/shared
dist_shared_DATA = $(SHARED_FILES)
