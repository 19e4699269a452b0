libtwinlight_host_la_SOURCES += \
	host/film/film.c host/film/film.h \
	host/film/film_add.c \
	host/film/film_archive.c \
	host/film/film_resolve.c \
	host/film/film_words.c host/film/film_words.h \
	host/film/pixel_order.c host/film/pixel_order.h \
	host/film/pixel_series.c host/film/pixel_series.h
