#include "image/color.h"

#include "base/array.h"
#include "base/input_files.h"
#include "base/text_number.h"
#include "image/color_tables.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SPECTRUM_SIZE (CIE_LAST - CIE_FIRST + 1)
#define BLACKBODY_KELVIN_MIN 400.0
#define SPECTRUM_NUMBERS_MAX (1 << 20)

/* XYZ (white has Y = 1) to linear sRGB: inverse of the matrix whose columns are the ITU-R BT.709 primaries, scaled to
 * add up to the white point of the D65 table. */
static const double RGB_FROM_XYZ[3][3] = {{3.2404442914, -1.5371338305, -0.4985298910},
                                          {-0.9692667526, 1.8760122430, 0.0415560485},
                                          {0.0556435197, -0.2040262388, 1.0572268738}};

/* Luminance of linear sRGB: the Y row of the inverse of RGB_FROM_XYZ. */
static const double LUMINANCE[3] = {0.2126729, 0.7151522, 0.0721750};

/* Table entry at an integer wavelength, interpolated linearly between rows. */
static double cie_value(int nanometre, int column)
{
    int row = (nanometre - CIE_FIRST) / CIE_STEP;
    double t = (nanometre - CIE_FIRST - row * CIE_STEP) / (double)CIE_STEP;
    double low = (double)CIE_TABLE[row][column];
    return t > 0.0 ? low + t * ((double)CIE_TABLE[row + 1][column] - low) : low;
}

/* Response of channel c of linear sRGB to 1 nm. */
static double rgb_sensitivity(int nanometre, int c)
{
    double sum = 0.0;
    for (int k = 0; k < 3; ++k)
        sum += RGB_FROM_XYZ[c][k] * cie_value(nanometre, k);
    return sum;
}

/* The colour of a surface of reflectance `spectrum` (1 nm steps) under D65. Dividing by the response to white maps a
 * reflectance of 1 everywhere to exactly (1, 1, 1). */
static void spectrum_reflectance(const double *spectrum, double rgb[3])
{
    for (int c = 0; c < 3; ++c) {
        double sum = 0.0, white = 0.0;
        for (int i = 0; i < SPECTRUM_SIZE; ++i) {
            double weight = rgb_sensitivity(CIE_FIRST + i, c) * cie_value(CIE_FIRST + i, 3);
            sum += weight * spectrum[i];
            white += weight;
        }
        rgb[c] = sum / white;
    }
}

/* Average of the spectrum over each channel's response under D65. The negative lobes of the responses are clamped: an
 * index is not a light, and negative weights would extrapolate beyond its range. */
static void spectrum_index(const double *spectrum, double rgb[3])
{
    for (int c = 0; c < 3; ++c) {
        double sum = 0.0, total = 0.0;
        for (int i = 0; i < SPECTRUM_SIZE; ++i) {
            double weight = rgb_sensitivity(CIE_FIRST + i, c) * cie_value(CIE_FIRST + i, 3);
            sum += fmax(weight, 0.0) * spectrum[i];
            total += fmax(weight, 0.0);
        }
        rgb[c] = sum / total;
    }
}

/* A light's colour at luminance 1; false if the light emits nothing visible. */
static bool spectrum_illuminant(const double *spectrum, double rgb[3])
{
    double luminance = 0.0;
    for (int c = 0; c < 3; ++c) {
        double sum = 0.0, white = 0.0;
        for (int i = 0; i < SPECTRUM_SIZE; ++i) {
            double weight = rgb_sensitivity(CIE_FIRST + i, c);
            sum += weight * spectrum[i];
            white += weight * cie_value(CIE_FIRST + i, 3);
        }
        rgb[c] = fmax(sum / white, 0.0);
        luminance += LUMINANCE[c] * rgb[c];
    }
    if (!(luminance > 0.0))
        return false;
    for (int c = 0; c < 3; ++c)
        rgb[c] /= luminance;
    return true;
}

/* Second radiation constant h c / k in m K (CODATA 2018). */
#define RADIATION_CONSTANT 1.438776877e-2

/* Planck's law, lambda^-5 / (e^x - 1), relative to the longest wavelength, so that neither very low nor very high
 * temperatures over- or underflow. */
static void blackbody_spectrum(double kelvin, double spectrum[SPECTRUM_SIZE])
{
    double x_last = RADIATION_CONSTANT / (CIE_LAST * 1e-9 * kelvin);
    for (int i = 0; i < SPECTRUM_SIZE; ++i) {
        double ratio = (CIE_FIRST + i) / (double)CIE_LAST, x = x_last / ratio;
        spectrum[i] = exp(x_last - x) * expm1(-x_last) / expm1(-x) / pow(ratio, 5.0);
    }
}

void color_blackbody(float kelvin, float rgb[3])
{
    double spectrum[SPECTRUM_SIZE], color[3];
    blackbody_spectrum(fmax((double)kelvin, BLACKBODY_KELVIN_MIN), spectrum);
    spectrum_illuminant(spectrum, color);
    for (int c = 0; c < 3; ++c)
        rgb[c] = (float)color[c];
}

void color_blackbody_relative(float kelvin, float rgb[3])
{
    /* Where x e^x / (e^x - 1) = 5, the spectrum has its maximum. */
    const double X_PEAK = 4.965114231744276;
    double spectrum[SPECTRUM_SIZE], x_last = RADIATION_CONSTANT / (CIE_LAST * 1e-9 * fmax((double)kelvin, 100.0));
    double last = pow(x_last / X_PEAK, 5.0) * expm1(X_PEAK) / expm1(x_last), luminance = 0.0;
    color_blackbody(kelvin, rgb);
    blackbody_spectrum(fmax((double)kelvin, 100.0), spectrum);
    for (int i = 0; i < SPECTRUM_SIZE; ++i)
        luminance += cie_value(CIE_FIRST + i, 1) * spectrum[i];
    for (int c = 0; c < 3; ++c)
        rgb[c] = kelvin > 100.0f ? (float)((double)rgb[c] * luminance * last) : 0.0f;
}

void color_daylight(float kelvin, float rgb[3])
{
    double t = (double)kelvin, x, y;
    if (t < 4000.0) {
        color_blackbody(kelvin, rgb);
        return;
    }
    if (t <= 7000.0)
        x = ((-4.6070e9 / t + 2.9678e6) / t + 0.09911e3) / t + 0.244063;
    else
        x = ((-2.0064e9 / t + 1.9018e6) / t + 0.24748e3) / t + 0.237040;
    y = (-3.0 * x + 2.870) * x - 0.275;
    const double xyz[3] = {x / y, 1.0, (1.0 - x - y) / y};
    for (int c = 0; c < 3; ++c)
        rgb[c] = (float)(RGB_FROM_XYZ[c][0] * xyz[0] + RGB_FROM_XYZ[c][1] * xyz[1] + RGB_FROM_XYZ[c][2] * xyz[2]);
}

static bool samples_check(const float *pairs, size_t n, Error *error)
{
    if (n == 0) {
        error_set(error, "a spectrum without samples");
        return error_fix(error, "give pairs of wavelength in nm and value");
    }
    for (size_t i = 0; i < n; ++i) {
        double wavelength = (double)pairs[2 * i], value = (double)pairs[2 * i + 1];
        if (!isfinite(wavelength) || !isfinite(value)) {
            error_set(error, "sample %zu of a spectrum is not a finite number", i + 1);
            return error_fix(error, "give pairs of wavelength in nm and value");
        }
        if (value < 0.0) {
            error_set(error, "sample %zu of a spectrum, at %g nm, is negative: %g", i + 1, wavelength, value);
            return error_fix(error, "values of a spectrum are 0 or above");
        }
        if (i > 0 && wavelength <= (double)pairs[2 * i - 2]) {
            error_set(error, "wavelengths of a spectrum must increase: sample %zu at %g nm follows %g nm", i + 1,
                      wavelength, (double)pairs[2 * i - 2]);
            return error_fix(error, "sort the samples by wavelength, each once");
        }
    }
    return true;
}

/* Resamples to 1 nm steps. Outside the given range: the first or last value if `extend`, else 0. */
static void samples_resample(const float *pairs, size_t n, bool extend, double *spectrum)
{
    size_t next = 0; /* first pair at or beyond the wavelength */
    for (int i = 0; i < SPECTRUM_SIZE; ++i) {
        double wavelength = CIE_FIRST + i;
        while (next < n && (double)pairs[2 * next] < wavelength)
            ++next;
        if (next < n && (next > 0 || (double)pairs[0] == wavelength)) {
            size_t previous = next > 0 ? next - 1 : 0;
            double x0 = (double)pairs[2 * previous], x1 = (double)pairs[2 * next];
            double t = x1 > x0 ? (wavelength - x0) / (x1 - x0) : 0.0;
            spectrum[i] = (1.0 - t) * (double)pairs[2 * previous + 1] + t * (double)pairs[2 * next + 1];
        } else {
            spectrum[i] = extend ? (double)pairs[next == 0 ? 1 : 2 * n - 1] : 0.0;
        }
    }
}

bool color_from_samples(const float *wavelength_value_pairs, size_t n, ColorRole role, float rgb[3], Error *error)
{
    double spectrum[SPECTRUM_SIZE], color[3], largest = 0.0;
    if (!samples_check(wavelength_value_pairs, n, error))
        return false;
    samples_resample(wavelength_value_pairs, n, role == COLOR_INDEX, spectrum);
    for (size_t i = 0; i < n; ++i)
        largest = fmax(largest, (double)wavelength_value_pairs[2 * i + 1]);
    if (role == COLOR_INDEX) {
        spectrum_index(spectrum, color);
    } else if (role == COLOR_REFLECTANCE) {
        spectrum_reflectance(spectrum, color);
    } else if (!spectrum_illuminant(spectrum, color)) {
        error_set(error, "the light's spectrum has no power between %d and %d nm", CIE_FIRST, CIE_LAST);
        return error_fix(error, "wavelengths are in nanometres; to have no light, leave it out");
    }
    for (int c = 0; c < 3; ++c) {
        double kept = role == COLOR_REFLECTANCE ? fmin(fmax(color[c], 0.0), largest) : color[c];
        rgb[c] = (float)kept;
    }
    return true;
}

#define SPACES " \t\r\n\f\v"

/* Reads the numbers of one line; # begins a comment. */
static bool line_read(char *line, SourcePlace place, Array *numbers, Error *error)
{
    line[strcspn(line, "#")] = '\0';
    for (char *text = line + strspn(line, SPACES); *text; text += strspn(text, SPACES)) {
        size_t length = strcspn(text, SPACES);
        float value = 0.0f;
        place.column = (int)(text - line) + 1;
        if (number_float(text, length, &value) != NUMBER_OK) {
            error_at(error, place, "expected a number, not \"%.*s\"", length < 40 ? (int)length : 40, text);
            return error_fix(error, "a spectrum file holds pairs of wavelength in nm and value, and # comments");
        }
        if (numbers->count >= SPECTRUM_NUMBERS_MAX) {
            error_at(error, place, "more than %d numbers in a spectrum", SPECTRUM_NUMBERS_MAX);
            return error_fix(error, "use fewer samples: one every 5 nm is plenty");
        }
        float *to = array_grow(numbers, 1, error);
        if (!to)
            return false;
        *to = value;
        text += length;
    }
    return true;
}

static bool numbers_read(const char *path, Array *numbers, Error *error)
{
    char *line = NULL;
    size_t line_size = 0;
    FILE *file = fopen(path, "r");
    if (!file) {
        error_errno(error, "open the spectrum", path);
        return error_fix(error, "check the name; it is relative to the scene's folder");
    }
    input_file_note(fileno(file));
    bool good = true;
    for (int number = 1; good && getline(&line, &line_size, file) >= 0; ++number)
        good = line_read(line, (SourcePlace){path, number, 0}, numbers, error);
    if (good && ferror(file))
        good = error_errno(error, "read", path);
    free(line);
    fclose(file);
    return good;
}

bool color_spectrum_file(const char *path, ColorRole role, float rgb[3], Error *error)
{
    Array numbers;
    Error inner;
    SourcePlace place = {path, 0, 0};
    array_init(&numbers, sizeof(float));
    bool good = numbers_read(path, &numbers, error);
    if (good && numbers.count % 2 != 0) {
        good = error_at(error, place, "a spectrum needs pairs of numbers, but has %zu", numbers.count);
        error_fix(error, "complete the last pair, or delete it");
    }
    if (good && !color_from_samples(numbers.data, numbers.count / 2, role, rgb, &inner)) {
        good = error_at(error, place, "%s", error_text(&inner));
        error_fix(error, "%s", inner.fix);
    }
    array_destroy(&numbers);
    return good;
}

double color_srgb_decode(double encoded)
{
    double x = fabs(encoded);
    double linear = x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
    return copysign(linear, encoded);
}

double color_srgb_encode(double linear)
{
    double x = fabs(linear);
    double encoded = x <= 0.0031308 ? x * 12.92 : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
    return copysign(encoded, linear);
}
