# libtwinlight_kernels: what is compiled with the arithmetic of the kernels, float, or double with --enable-double.
# libtwinlight_cpu: the rest, which uses the host's structs.
noinst_LTLIBRARIES += libtwinlight_cpu.la libtwinlight_kernels.la
libtwinlight_cpu_la_SOURCES = \
	backend_cpu/backend_cpu.c backend_cpu/backend_cpu.h \
	backend_cpu/chunk.h \
	backend_cpu/worker.c backend_cpu/worker.h
libtwinlight_cpu_la_LIBADD = libtwinlight_kernels.la $(EMBREE_LIBS)
libtwinlight_kernels_la_SOURCES = \
	backend_cpu/kernel_loop.h \
	backend_cpu/kernel_scene.h \
	backend_cpu/kernels.c backend_cpu/kernels.h \
	backend_cpu/kernels_bd.c \
	backend_cpu/kernels_caustic.c \
	backend_cpu/kernels_mlt.c \
	backend_cpu/kernels_opening.c \
	backend_cpu/kernels_others.c \
	backend_cpu/kernels_pt.c \
	backend_cpu/plain_kernels.h \
	backend_cpu/curve_cluster.h \
	backend_cpu/rays_embree.c backend_cpu/rays_embree.h \
	backend_cpu/rays_embree_build.c \
	backend_cpu/rays_embree_callbacks.c \
	backend_cpu/rays_embree_scene.h \
	backend_cpu/triangle_cluster.c backend_cpu/triangle_cluster.h
libtwinlight_kernels_la_CPPFLAGS = $(AM_CPPFLAGS) $(KERNEL_CPPFLAGS)
libtwinlight_kernels_la_CFLAGS = $(AM_CFLAGS) $(KERNEL_CFLAGS) $(INLINE_CFLAGS)
if ENABLE_DOUBLE
libtwinlight_kernels_la_SOURCES += backend_cpu/kernel_scene_double.c
else
libtwinlight_kernels_la_SOURCES += backend_cpu/curve_cluster.c backend_cpu/kernel_scene.c
endif
if PLAIN_KERNELS
libtwinlight_kernels_la_SOURCES += \
	backend_cpu/kernels_bd_plain.c \
	backend_cpu/kernels_mlt_plain.c \
	backend_cpu/kernels_pt_plain.c
endif
if WIDE_KERNELS
noinst_LTLIBRARIES += libtwinlight_wide.la
libtwinlight_wide_la_SOURCES = backend_cpu/kernels_mlt_wide.c
if PLAIN_KERNELS
libtwinlight_wide_la_SOURCES += backend_cpu/kernels_mlt_wide_plain.c
endif
libtwinlight_wide_la_CPPFLAGS = $(libtwinlight_kernels_la_CPPFLAGS)
libtwinlight_wide_la_CFLAGS = $(libtwinlight_kernels_la_CFLAGS) $(WIDE_CFLAGS)
libtwinlight_kernels_la_LIBADD = libtwinlight_wide.la
endif
