SHARED_FILES += \
	shared/layout/aov_list.h \
	shared/layout/diagnostics.h \
	shared/layout/distribution.h \
	shared/layout/frame_params.h \
	shared/layout/item.h \
	shared/layout/kernel_list.h \
	shared/layout/material_list.h \
	shared/layout/pass_data.h \
	shared/layout/path_types.h \
	shared/layout/openings.h \
	shared/layout/photon_map.h \
	shared/layout/scene_types.h \
	shared/layout/scene_view.h \
	shared/layout/state.h \
	shared/layout/struct_members.h
