libtwinlight_host_la_SOURCES += \
	host/image/color.c host/image/color.h \
	host/image/color_named.c \
	host/image/color_tables.h \
	host/image/contact_sheet.c host/image/contact_sheet.h \
	host/image/decode_exr.c \
	host/image/decode_exr_dwa.c \
	host/image/decode_pfm.c \
	host/image/decode_stb.c \
	host/image/decoders.h \
	host/image/despeckle.c host/image/despeckle.h \
	host/image/exr.c host/image/exr.h \
	host/image/image.c host/image/image.h \
	host/image/plane_filter.c host/image/plane_filter.h \
	host/image/png_write.c host/image/png_write.h \
	host/image/read.c host/image/read.h \
	host/image/rendering_file.c host/image/rendering_file.h
