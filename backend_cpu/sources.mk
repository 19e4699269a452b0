noinst_LTLIBRARIES += libtwinlight_cpu.la
libtwinlight_cpu_la_SOURCES = \
	backend_cpu/backend_cpu.c backend_cpu/backend_cpu.h
libtwinlight_cpu_la_LIBADD = $(EMBREE_LIBS)
