libtwinlight_host_la_SOURCES += \
	host/compare/display_error.c host/compare/display_error.h \
	host/compare/error_image.c host/compare/error_image.h \
	host/compare/flip.c \
	host/compare/metrics.c host/compare/metrics.h \
	host/compare/print.c host/compare/print.h \
	host/compare/ssim.c \
	host/compare/z_test.c host/compare/z_test.h
