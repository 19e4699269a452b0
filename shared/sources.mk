# Shared kernels and what they use: headers of the common subset of C11 and OpenCL C 1.2, and kernel files (.cl).
SHARED_FILES = \
	shared/distribution.h \
	shared/elementary.h \
	shared/path_types.h \
	shared/platform.h \
	shared/rng.h \
	shared/scene_types.h \
	shared/scene_view.h \
	shared/state.h \
	shared/texture.h \
	shared/vec.h
	shared/vec.h \
	shared/warp.h

# Installed with the program: OpenCL builds its programs from them.
shareddir = $(pkgdatadir)/shared
dist_shared_DATA = $(SHARED_FILES)
