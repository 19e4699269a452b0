libtwinlight_host_la_SOURCES += \
	host/gltf/gltf.h \
	host/gltf/load.c host/gltf/load.h

GLTF_WITH_ASSIMP = \
	host/gltf/accessor_values.c \
	host/gltf/accessors.c host/gltf/accessors.h \
	host/gltf/container.c \
	host/gltf/convert.c \
	host/gltf/document.h \
	host/gltf/emission.c host/gltf/emission.h \
	host/gltf/extensions.c \
	host/gltf/images.c host/gltf/images.h \
	host/gltf/import.c \
	host/gltf/json_value.c host/gltf/json_value.h \
	host/gltf/materials.c \
	host/gltf/memory_files.c host/gltf/memory_files.h \
	host/gltf/meshes.c host/gltf/meshes.h \
	host/gltf/nodes.c \
	host/gltf/poses.c \
	host/gltf/skin.c host/gltf/skin.h \
	host/gltf/translate.c host/gltf/translate.h \
	host/gltf/translate_materials.c \
	host/gltf/uv_transform.c host/gltf/uv_transform.h
if HAVE_ASSIMP
libtwinlight_host_la_SOURCES += $(GLTF_WITH_ASSIMP)
else
libtwinlight_host_la_SOURCES += host/gltf/gltf_absent.c
endif
