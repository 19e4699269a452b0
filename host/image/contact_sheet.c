#include "image/contact_sheet.h"

#include <stdlib.h>
#include <string.h>

#define MARGIN 6
#define GLYPH_WIDTH 3
#define GLYPH_HEIGHT 5
#define GLYPH_SCALE 2
#define TEXT_HEIGHT (GLYPH_HEIGHT * GLYPH_SCALE + 4)
#define BACKGROUND 0.03f
#define INK 0.8f

/* Rows of three pixels from top to bottom; the highest bit is the left pixel. */
static const struct Glyph {
    char character;
    unsigned char rows[GLYPH_HEIGHT];
} GLYPHS[] = {
    {'0', {7, 5, 5, 5, 7}}, {'1', {2, 6, 2, 2, 7}}, {'2', {7, 1, 7, 4, 7}}, {'3', {7, 1, 7, 1, 7}},
    {'4', {5, 5, 7, 1, 1}}, {'5', {7, 4, 7, 1, 7}}, {'6', {7, 4, 7, 5, 7}}, {'7', {7, 1, 1, 2, 2}},
    {'8', {7, 5, 7, 5, 7}}, {'9', {7, 5, 7, 1, 7}}, {'s', {0, 3, 6, 3, 6}}, {'t', {2, 7, 2, 2, 3}},
    {'=', {0, 7, 0, 7, 0}}, {',', {0, 0, 0, 2, 4}}, {'d', {1, 1, 7, 5, 7}}, {'x', {0, 5, 2, 5, 0}},
    {'.', {0, 0, 0, 0, 2}},
};

bool contact_sheet_init(ContactSheet *sheet, int cell_width, int cell_height, int columns, int rows, Error *error)
{
    *sheet = (ContactSheet){.cell_width = cell_width, .cell_height = cell_height, .columns = columns, .rows = rows};
    long long width = MARGIN + (long long)columns * (cell_width + MARGIN);
    long long height = MARGIN + (long long)rows * (cell_height + TEXT_HEIGHT + MARGIN);
    if (width > 65535 || height > 65535) {
        error_set(error, "a sheet of %lld x %lld pixels is too large", width, height);
        return error_fix(error, "choose a smaller --resolution");
    }
    sheet->width = (int)width;
    sheet->height = (int)height;
    size_t values = 3 * (size_t)width * (size_t)height;
    sheet->rgb = malloc(values * sizeof *sheet->rgb);
    if (!sheet->rgb)
        return error_memory(error, values * sizeof *sheet->rgb, "the sheet");
    for (size_t i = 0; i < values; ++i)
        sheet->rgb[i] = BACKGROUND;
    return true;
}

void contact_sheet_destroy(ContactSheet *sheet)
{
    free(sheet->rgb);
    *sheet = (ContactSheet){0};
}

static void dot_put(ContactSheet *sheet, int x, int y)
{
    for (int j = y; j < y + GLYPH_SCALE; ++j)
        for (int i = x; i < x + GLYPH_SCALE; ++i)
            for (int c = 0; c < 3; ++c)
                sheet->rgb[3 * ((size_t)j * (size_t)sheet->width + (size_t)i) + (size_t)c] = INK;
}

static void glyph_put(ContactSheet *sheet, int x, int y, char character)
{
    for (size_t g = 0; g < sizeof GLYPHS / sizeof GLYPHS[0]; ++g) {
        if (GLYPHS[g].character != character)
            continue;
        for (int j = 0; j < GLYPH_HEIGHT; ++j)
            for (int i = 0; i < GLYPH_WIDTH; ++i)
                if (GLYPHS[g].rows[j] & (4 >> i))
                    dot_put(sheet, x + i * GLYPH_SCALE, y + j * GLYPH_SCALE);
    }
}

void contact_sheet_put(ContactSheet *sheet, int column, int row, const float *rgb, float scale, const char *text)
{
    int x0 = MARGIN + column * (sheet->cell_width + MARGIN);
    int y0 = MARGIN + row * (sheet->cell_height + TEXT_HEIGHT + MARGIN);
    int step = (GLYPH_WIDTH + 1) * GLYPH_SCALE;
    for (int i = 0; text[i] != '\0' && (i + 1) * step <= sheet->cell_width; ++i)
        glyph_put(sheet, x0 + i * step, y0, text[i]);
    for (int y = 0; y < sheet->cell_height; ++y) {
        const float *from = rgb + 3 * (size_t)y * (size_t)sheet->cell_width;
        float *to = sheet->rgb + 3 * ((size_t)(y0 + TEXT_HEIGHT + y) * (size_t)sheet->width + (size_t)x0);
        for (int i = 0; i < 3 * sheet->cell_width; ++i)
            to[i] = scale * from[i];
    }
}
