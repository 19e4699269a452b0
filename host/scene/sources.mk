libtwinlight_host_la_SOURCES += \
	host/scene/warnings.c host/scene/warnings.h \
	host/scene/grid_build.c host/scene/grid_build.h \
	host/scene/light_bounds.c host/scene/light_bounds.h \
	host/scene/light_guide_setup.c host/scene/light_guide_setup.h \
	host/scene/camera_setup.c host/scene/camera_setup.h \
	host/scene/center.c host/scene/center.h \
	host/scene/coat_base_table.c host/scene/coat_base_table.h \
	host/scene/coat_medium.c host/scene/coat_medium.h \
	host/scene/coat_table.c host/scene/coat_table.h \
	host/scene/distribution_build.c host/scene/distribution_build.h \
	host/scene/far_lights.c host/scene/far_lights.h \
	host/scene/filter_setup.c host/scene/filter_setup.h \
	host/scene/finish.c \
	host/scene/format.c host/scene/format.h \
	host/scene/light_node.c host/scene/light_node.h \
	host/scene/light_setup.c host/scene/light_setup.h \
	host/scene/light_tree.c host/scene/light_tree.h \
	host/scene/media_setup.c host/scene/media_setup.h \
	host/scene/pack.c host/scene/pack.h \
	host/scene/portal_setup.c host/scene/portal_setup.h \
	host/scene/aim_setup.c host/scene/aim_setup.h \
	host/scene/scene.c host/scene/scene.h \
	host/scene/separations.c host/scene/separations.h \
	host/scene/smooth_boxes.c host/scene/smooth_boxes.h \
	host/scene/summary.c host/scene/summary.h \
	host/scene/texture_image.c host/scene/texture_image.h
