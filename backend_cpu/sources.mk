noinst_LTLIBRARIES += libtwinlight_cpu.la
libtwinlight_cpu_la_SOURCES = \
	backend_cpu/backend_cpu.c backend_cpu/backend_cpu.h \
	backend_cpu/kernel_loop.h \
	backend_cpu/kernels.c backend_cpu/kernels.h \
	backend_cpu/kernels_bd.c \
	backend_cpu/kernels_mlt.c \
	backend_cpu/kernels_others.c \
	backend_cpu/rays_embree.c backend_cpu/rays_embree.h \
	backend_cpu/triangle_cluster.c backend_cpu/triangle_cluster.h
libtwinlight_cpu_la_LIBADD = $(EMBREE_LIBS)
