SHARED_FILES += \
	shared/math/elementary.h \
	shared/math/noise.h \
	shared/math/platform.h \
	shared/math/platform_double.h \
	shared/math/rng.h \
	shared/math/scaled.h \
	shared/math/sobol.h \
	shared/math/sobol_tables.h \
	shared/math/vec.h \
	shared/math/warp.h
