# Shared kernels and what they use: headers of the common subset of C11 and OpenCL C 1.2, and kernel files (.cl).
# Installed with the program: OpenCL builds its programs from them.
SHARED_ROOMS = math layout geometry bsdf light camera path chain kernels
SHARED_FILES = shared/kernels.cl
include shared/math/sources.mk
include shared/layout/sources.mk
include shared/geometry/sources.mk
include shared/bsdf/sources.mk
include shared/light/sources.mk
include shared/camera/sources.mk
include shared/path/sources.mk
include shared/chain/sources.mk
include shared/kernels/sources.mk
nobase_dist_pkgdata_DATA = $(SHARED_FILES)
