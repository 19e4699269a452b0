SHARED_FILES += \
	shared/camera/camera.h \
	shared/camera/film_axis.h \
	shared/camera/film_splat.h \
	shared/camera/film_spread.h \
	shared/camera/film_sum.h \
	shared/camera/pixel_filter.h \
	shared/camera/spherical.h \
	shared/camera/splat_offset.h \
	shared/camera/view.h
