/* Contact sheet: a grid of images with a line of text above each. */
#ifndef TWINLIGHT_IMAGE_CONTACT_SHEET_H
#define TWINLIGHT_IMAGE_CONTACT_SHEET_H

#include "base/error.h"

/* A sheet of `columns` x `rows` cells; linear RGB, dark grey where empty. */
typedef struct ContactSheet {
    int cell_width, cell_height; /* of one image, pixels */
    int columns, rows;
    int width, height; /* of the whole sheet, pixels */
    float *rgb;
} ContactSheet;

/* Allocates an empty sheet; fails if a side would exceed 65535 pixels or when out of memory. */
bool contact_sheet_init(ContactSheet *sheet, int cell_width, int cell_height, int columns, int rows, Error *error);
void contact_sheet_destroy(ContactSheet *sheet);

/* Puts an image (3 floats per pixel), multiplied by `scale`, into a cell and `text` above it. The font has digits and
 * "st=,dx."; other characters become blanks. Text that does not fit is cut. */
void contact_sheet_put(ContactSheet *sheet, int column, int row, const float *rgb, float scale, const char *text);

#endif
