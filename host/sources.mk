noinst_LTLIBRARIES += libtwinlight_host.la
libtwinlight_host_la_SOURCES = \
	host/array.c host/array.h \
	host/backend.h \
	host/distribution.c host/distribution.h \
	host/error.c host/error.h \
	host/log.c host/log.h \
	host/scene.c host/scene.h \
	host/scene_finish.c
libtwinlight_host_la_LIBADD = $(EXR_LIBS) $(OPENEXR_LIBS) $(PNG_LIBS) $(ZLIB_LIBS) $(STB_LIBS) -lm

bin_PROGRAMS += twinlight
twinlight_SOURCES = host/main.c
twinlight_LDADD = libtwinlight_cpu.la libtwinlight_host.la $(EMBREE_LIBS)
