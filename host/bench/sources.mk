libtwinlight_host_la_SOURCES += \
	host/bench/analysis.c host/bench/analysis.h \
	host/bench/bench.h \
	host/bench/chains.c \
	host/bench/figures.c \
	host/bench/html.c host/bench/html.h \
	host/bench/options.c host/bench/options.h \
	host/bench/pictures.c \
	host/bench/record.c host/bench/record.h \
	host/bench/renderings.c host/bench/renderings.h \
	host/bench/report.c host/bench/report.h \
	host/bench/style.c \
	host/bench/svg_chart.c host/bench/svg_chart.h \
	host/bench/tables.c host/bench/tables.h \
	host/bench/task.c host/bench/task.h
