libtwinlight_host_la_SOURCES += \
	host/backend/backend.h \
	host/backend/bvh.c host/backend/bvh.h \
	host/backend/bvh_tree.c host/backend/bvh_tree.h \
	host/backend/choice.c host/backend/choice.h \
	host/backend/film_sink.c host/backend/film_sink.h \
	host/backend/group.c host/backend/group.h \
	host/backend/instance_bounds.h \
	host/backend/ray_reach.c host/backend/ray_reach.h \
	host/backend/shares.c host/backend/shares.h \
	host/backend/step_recorder.c host/backend/step_recorder.h \
	host/backend/table.h \
	host/backend/trace_output.c host/backend/trace_output.h
