SHARED_FILES += \
	shared/light/light_guide.h \
	shared/light/light_tree.h \
	shared/light/opening.h \
	shared/light/aim.h \
	shared/light/area.h \
	shared/light/delta.h \
	shared/light/intensity_image.h \
	shared/light/position.h \
	shared/light/emission.h \
	shared/light/emit.h \
	shared/light/infinite.h \
	shared/light/light.h \
	shared/light/portal.h
