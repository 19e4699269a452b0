if HAVE_OPENCL
noinst_LTLIBRARIES += libtwinlight_ocl.la
OCL_LIBRARY = libtwinlight_ocl.la
endif
libtwinlight_ocl_la_SOURCES = \
	backend_ocl/backend_ocl.c backend_ocl/backend_ocl.h \
	backend_ocl/batch.c backend_ocl/batch.h \
	backend_ocl/device_film.c backend_ocl/device_film.h \
	backend_ocl/device_memory.c backend_ocl/device_memory.h \
	backend_ocl/devices.c backend_ocl/devices.h \
	backend_ocl/film_adders.c backend_ocl/film_adders.h \
	backend_ocl/inspect.c backend_ocl/inspect.h \
	backend_ocl/ocl_status.c backend_ocl/ocl_status.h \
	backend_ocl/pass_data.c backend_ocl/pass_data.h \
	backend_ocl/program.c backend_ocl/program.h \
	backend_ocl/program_cache.c backend_ocl/program_cache.h \
	backend_ocl/program_source.c backend_ocl/program_source.h \
	backend_ocl/rounding_probe.c backend_ocl/rounding_probe.h \
	backend_ocl/timeline.c backend_ocl/timeline.h
libtwinlight_ocl_la_CPPFLAGS = $(AM_CPPFLAGS) -DKERNELS_INSTALLED='"$(pkgdatadir)/shared"' \
	-DKERNELS_BUILD='"$(abs_top_srcdir)/shared"' -DPROGRAM_FOLDER='"$(bindir)"'
libtwinlight_ocl_la_LIBADD = $(OPENCL_LIBS)
