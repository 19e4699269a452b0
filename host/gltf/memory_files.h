/* Files that Assimp reads from memory. */
#ifndef TWINLIGHT_GLTF_MEMORY_FILES_H
#define TWINLIGHT_GLTF_MEMORY_FILES_H

#include "gltf/document.h"

#include <assimp/cfileio.h>

/* Name of the document; buffer N has the name N.bin. There are no other files. */
#define DOCUMENT_NAME "twinlight.gltf"

/* Assimp wants a whole stride for the last element, too, which files need not have: buffers get so many zeros more. */
#define BUFFER_PADDING 256

typedef struct MemoryFiles {
    const char *document; /* JSON */
    const GltfBytes *buffers;
    size_t buffer_count;
} MemoryFiles;

/* For aiImportFileEx. `files` must stay where it is meanwhile. */
struct aiFileIO memory_files_io(MemoryFiles *files);

#endif
