/* Pictures side by side with a line of text over each. */
#ifndef TWINLIGHT_IMAGE_CONTACT_SHEET_H
#define TWINLIGHT_IMAGE_CONTACT_SHEET_H

#include "base/error.h"

/* A sheet of `columns` x `rows` cells; linear RGB, dark grey where nothing is put. */
typedef struct ContactSheet {
    int cell_width, cell_height; /* pixels of a picture */
    int columns, rows;
    int width, height; /* of the whole sheet */
    float *rgb;
} ContactSheet;

bool contact_sheet_init(ContactSheet *sheet, int cell_width, int cell_height, int columns, int rows, Error *error);
void contact_sheet_destroy(ContactSheet *sheet);

/* Puts a picture (3 floats a pixel) times `scale` into a cell, and `text` over it: of digits and the characters
 * "st=,dx.", others are blanks; what does not fit is cut. */
void contact_sheet_put(ContactSheet *sheet, int column, int row, const float *rgb, float scale, const char *text);

#endif
