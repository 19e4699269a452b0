libtwinlight_host_la_SOURCES += \
	host/base/archive.c host/base/archive.h \
	host/base/archive_file.c host/base/archive_file.h \
	host/base/arena.c host/base/arena.h \
	host/base/array.c host/base/array.h \
	host/base/build_info.c host/base/build_info.h \
	host/base/error.c host/base/error.h \
	host/base/exit_status.h \
	host/base/file_read.c host/base/file_read.h \
	host/base/gzip.c host/base/gzip.h \
	host/base/frame_name.c host/base/frame_name.h \
	host/base/hash.h \
	host/base/input_files.c host/base/input_files.h \
	host/base/interrupt.c host/base/interrupt.h \
	host/base/json.c host/base/json.h \
	host/base/key_sort.c host/base/key_sort.h \
	host/base/largest_values.c host/base/largest_values.h \
	host/base/log.c host/base/log.h \
	host/base/matrix.c host/base/matrix.h \
	host/base/name_table.c host/base/name_table.h \
	host/base/option_values.c host/base/option_values.h \
	host/base/options.c host/base/options.h \
	host/base/output_file.c host/base/output_file.h \
	host/base/parallel.c host/base/parallel.h \
	host/base/path_name.c host/base/path_name.h \
	host/base/processors.c host/base/processors.h \
	host/base/sample_statistics.c host/base/sample_statistics.h \
	host/base/startup.c host/base/startup.h \
	host/base/student.c host/base/student.h \
	host/base/temporary_file.c host/base/temporary_file.h \
	host/base/text_number.c host/base/text_number.h \
	host/base/text_window.c host/base/text_window.h \
	host/base/timing.c host/base/timing.h \
	host/base/zeros.c host/base/zeros.h
