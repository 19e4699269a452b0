noinst_LTLIBRARIES += libtwinlight_host.la
libtwinlight_host_la_SOURCES =
include host/base/sources.mk
include host/image/sources.mk
include host/film/sources.mk
include host/backend/sources.mk
include host/ranks/sources.mk
include host/compare/sources.mk
include host/scene/sources.mk
include host/pbrt/sources.mk
include host/gltf/sources.mk
include host/render/sources.mk
include host/mmlt/sources.mk
include host/serve/sources.mk
include host/bench/sources.mk
include host/command/sources.mk
libtwinlight_host_la_LIBADD = $(EMBREE_LIBS) $(EXR_LIBS) $(OPENEXR_LIBS) $(PNG_LIBS) $(ZLIB_LIBS) $(ZSTD_LIBS) $(STB_LIBS) $(MICROHTTPD_LIBS) $(MPI_LIBS) $(ASSIMP_LIBS) -lm

# The commit goes into reports of measurements; the file changes only when that does.
host/base/build_info.lo: build_commit.h
.PHONY: commit
commit:
build_commit.h: commit
	@commit=`git -C $(srcdir) describe --always --dirty 2>/dev/null || echo unknown`; \
	  echo "#define BUILD_COMMIT \"$$commit\"" >$@.new; \
	  if cmp -s $@.new $@; then rm $@.new; else mv $@.new $@; fi
CLEANFILES += build_commit.h

bin_PROGRAMS += twinlight
twinlight_SOURCES = host/main.c
twinlight_LDADD = libtwinlight_cpu.la $(OCL_LIBRARY) libtwinlight_host.la $(EMBREE_LIBS)
