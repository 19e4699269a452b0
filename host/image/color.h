/* Spectra to linear sRGB (Rec. 709 primaries, white D65 = (1, 1, 1)), once, while a scene is read: Twinlight renders in
 * RGB. */
#ifndef TWINLIGHT_IMAGE_COLOR_H
#define TWINLIGHT_IMAGE_COLOR_H

#include "base/error.h"

#include <stddef.h>

/* What a spectrum stands for, which decides how it becomes three numbers.
 *
 * COLOR_REFLECTANCE: its colour under D65; a spectrum that is 1 everywhere gives (1, 1, 1). Kept within 0 ... the
 *   largest sample, so that what was below 1 stays below 1.
 * COLOR_ILLUMINANT: its colour as a light, normalised to luminance 1 as pbrt's lights are (their brightness is their
 *   `scale`). Components outside the gamut are 0 and the others scaled to luminance 1.
 * COLOR_INDEX: an index of refraction or extinction: the average over the wavelengths each channel sees. */
typedef enum ColorRole { COLOR_REFLECTANCE, COLOR_ILLUMINANT, COLOR_INDEX } ColorRole;

/* Planck's law seen by the CIE 1931 observer, at luminance 1. kelvin must be finite and above 0; what is below 400 K
 * (invisible) has the colour of 400 K. */
void color_blackbody(float kelvin, float rgb[3]);

/* pbrt's named spectra: metal-{Ag,Al,Au,Cu,CuZn,MgO,TiO2}-{eta,k}, glass-{BK7,BAF10,FK51A,LASF9,SF5,SF10,SF11}
 * (also as F5, F10, F11), stdillum-{A,D50,D65,F1 ... F12}, illum-acesD60. Metals are chosen such that the RGB Fresnel
 * reflectance at normal incidence is the colour of the spectral one. Fails for an unknown name, a camera's sensor and
 * a name that does not fit the role. */
bool color_named_spectrum(const char *name, ColorRole role, float rgb[3], Error *error);

/* A spectrum of n (wavelength in nm, value) pairs, wavelengths increasing, linear in between and 0 outside, as pbrt's.
 * For COLOR_INDEX the first and last value go on outside. Fails for n = 0, wavelengths that do not increase, numbers
 * that are not finite, values below 0, and a light without any visible emission. */
bool color_from_samples(const float *wavelength_value_pairs, size_t n, ColorRole role, float rgb[3], Error *error);

/* The same from pbrt's .spd text: pairs of numbers, # starts a comment that ends with the line. */
bool color_spectrum_file(const char *path, ColorRole role, float rgb[3], Error *error);

/* The sRGB transfer function (IEC 61966-2-1) and its inverse, in double. Odd for negative numbers. */
double color_srgb_decode(double encoded);
double color_srgb_encode(double linear);

#endif
