libtwinlight_host_la_SOURCES += \
	host/ranks/greeting.c host/ranks/greeting.h \
	host/ranks/launcher.c host/ranks/launcher.h \
	host/ranks/messages.h \
	host/ranks/pass_cache.c host/ranks/pass_cache.h \
	host/ranks/ranks.h \
	host/ranks/slice.c host/ranks/slice.h

RANKS_WITH_MPI = \
	host/ranks/communicator.c host/ranks/communicator.h \
	host/ranks/ranks.c \
	host/ranks/ranks_backend.c host/ranks/ranks_backend.h \
	host/ranks/scene_copy.c host/ranks/scene_copy.h \
	host/ranks/serve.c
if HAVE_MPI
libtwinlight_host_la_SOURCES += $(RANKS_WITH_MPI)
else
libtwinlight_host_la_SOURCES += host/ranks/ranks_absent.c
endif
