/* Images of a glTF file, and what the scene needs of them. */
#ifndef TWINLIGHT_GLTF_IMAGES_H
#define TWINLIGHT_GLTF_IMAGES_H

#include "gltf/document.h"

/* Decodes image `index` of the file: PNG or JPEG in a buffer, a data URI or a file. */
bool gltf_image_read(Gltf *gltf, int index, Image *image, Error *error);

/* The index in gltf->derived of an image like this, added unless there is one; -1 if its source cannot be read. */
int gltf_derived_add(Gltf *gltf, GltfReader *reader, DerivedImage image);

/* The ending of the file name of derived image `image`: ".png" or ".exr". */
const char *gltf_derived_ending(const Gltf *gltf, int image);

/* Makes an image: bytes if the source has bytes, encoded as sRGB for DERIVED_COLOR and linear otherwise; floats in
 * linear encoding if it has 16 bits. Three channels for DERIVED_COLOR and DERIVED_NORMAL, else one. */
bool gltf_derived_make(Gltf *gltf, const DerivedImage *derived, Image *image, Error *error);

/* The reflectance of a base such that under a coat that reflects this part of diffuse light back inside the albedo of
 * what gets through the coat is `albedo`, as in glTF: light between base and coat is part of pbrt's coateddiffuse, but
 * not of glTF's model. */
double gltf_coat_base(double albedo, double internal);

#endif
