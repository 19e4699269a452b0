libtwinlight_host_la_SOURCES += \
	host/command/cmd_bench.c \
	host/command/cmd_compare.c host/command/cmd_compare.h \
	host/command/cmd_convert.c \
	host/command/cmd_devices.c \
	host/command/cmd_info.c \
	host/command/cmd_merge.c \
	host/command/cmd_pyramid.c \
	host/command/cmd_render.c \
	host/command/command.h \
	host/command/mlt_option.c host/command/mlt_option.h \
	host/command/output_check.c host/command/output_check.h \
	host/command/part_output.c host/command/part_output.h \
	host/command/render_job.h \
	host/command/render_names.c \
	host/command/render_option_specs.c host/command/render_option_specs.h \
	host/command/render_options.c host/command/render_options.h \
	host/command/render_output.c host/command/render_output.h \
	host/command/render_results.c \
	host/command/render_settings.c host/command/render_settings.h \
	host/command/render_verify.c host/command/render_verify.h
