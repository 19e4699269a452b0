noinst_LTLIBRARIES += libtwinlight_host.la
libtwinlight_host_la_SOURCES = \
	host/array.c host/array.h \
	host/backend.h \
	host/camera_setup.c host/camera_setup.h \
	host/distribution.c host/distribution.h \
	host/error.c host/error.h \
	host/filter_setup.c host/filter_setup.h \
	host/light_setup.c host/light_setup.h \
	host/film.h \
	host/integrator_pt.c \
	host/log.c host/log.h \
	host/render.h \
	host/scene.c host/scene.h \
	host/scene_finish.c
libtwinlight_host_la_LIBADD = $(EXR_LIBS) $(OPENEXR_LIBS) $(PNG_LIBS) $(ZLIB_LIBS) $(STB_LIBS) -lm

bin_PROGRAMS += twinlight
twinlight_SOURCES = host/main.c
twinlight_LDADD = libtwinlight_cpu.la libtwinlight_host.la $(EMBREE_LIBS)
