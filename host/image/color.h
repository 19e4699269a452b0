/* Conversion of spectra to linear sRGB (Rec. 709 primaries, white D65 = (1, 1, 1)) while a scene is read: Twinlight
 * renders in RGB. */
#ifndef TWINLIGHT_IMAGE_COLOR_H
#define TWINLIGHT_IMAGE_COLOR_H

#include "base/error.h"

#include <stddef.h>

/* What a spectrum describes, which decides how it is converted:
 *
 * COLOR_REFLECTANCE: colour under D65; a spectrum of 1 everywhere gives (1, 1, 1). Clamped to [0, largest sample], so
 *   that reflectances below 1 stay below 1.
 * COLOR_ILLUMINANT: colour of a light, normalised to luminance 1 like pbrt's lights, whose brightness is their `scale`.
 *   Components outside the gamut are clamped to 0 before that.
 * COLOR_INDEX: index of refraction or extinction; averaged over each channel's response. */
typedef enum ColorRole { COLOR_REFLECTANCE, COLOR_ILLUMINANT, COLOR_INDEX } ColorRole;

/* Colour of a black body for the CIE 1931 observer (Planck's law), at luminance 1. `kelvin` must be finite and above 0;
 * temperatures below 400 K, which are invisible, have the colour of 400 K. */
void color_blackbody(float kelvin, float rgb[3]);

/* The same of a black body whose spectral radiance has the maximum 1, in the unit in which pbrt's film has it:
 * luminance is the sum over wavelengths, 1 nm apart, of radiance times the observer's response. 0 below 100 K, like
 * pbrt. */
void color_blackbody_relative(float kelvin, float rgb[3]);

/* Colour of daylight of that correlated colour temperature, from 4000 to 25000 K, at luminance 1 (CIE 15, daylight
 * locus); below 4000 K that of a black body. */
void color_daylight(float kelvin, float rgb[3]);

/* pbrt's named spectra: metal-{Ag,Al,Au,Cu,CuZn,MgO,TiO2}-{eta,k}, glass-{BK7,BAF10,FK51A,LASF9,SF5,SF10,SF11} (also as
 * F5, F10, F11), stdillum-{A,D50,D65,F1 ... F12}, illum-acesD60. Metals are chosen such that the RGB Fresnel
 * reflectance at normal incidence equals the colour of the spectral reflectance. Fails for unknown names, camera
 * sensors, and names that do not fit `role`. */
bool color_named_spectrum(const char *name, ColorRole role, float rgb[3], Error *error);

/* Converts a spectrum of n (wavelength in nm, value) pairs with increasing wavelengths, linear in between and 0
 * outside, as pbrt does; for COLOR_INDEX the first and last values extend outside. Fails for n = 0, wavelengths that do
 * not increase, numbers that are not finite, negative values, and a light without visible emission. */
bool color_from_samples(const float *wavelength_value_pairs, size_t n, ColorRole role, float rgb[3], Error *error);

/* The same from a pbrt .spd file: pairs of numbers; # begins a comment to the end of the line. */
bool color_spectrum_file(const char *path, ColorRole role, float rgb[3], Error *error);

/* The sRGB transfer function (IEC 61966-2-1), decoding and encoding. Negative values are mapped by odd symmetry. */
double color_srgb_decode(double encoded);
double color_srgb_encode(double linear);

#endif
