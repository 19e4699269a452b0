SHARED_FILES += \
	shared/path/bd_connect.h \
	shared/path/bd_random.h \
	shared/path/bd_start.h \
	shared/path/bd_state.h \
	shared/path/bd_vertex.h \
	shared/path/bd_walk.h \
	shared/path/bd_weight.h \
	shared/path/caustic.h \
	shared/path/caustic_rest.h \
	shared/path/ib_weight.h \
	shared/path/mis.h \
	shared/path/partition.h \
	shared/path/passage.h \
	shared/path/path_gather.h \
	shared/path/path_random.h \
	shared/path/path_state.h \
	shared/path/photon.h \
	shared/path/photon_cells.h \
	shared/path/opening_path.h \
	shared/path/photon_path.h \
	shared/path/strategy.h
