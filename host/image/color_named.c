/* pbrt's named spectra as RGB constants, so that the measured spectra need not be shipped.
 *
 * The numbers were computed once, at 1 nm over 360-830 nm, from the measurements that pbrt-v4 distributes under these
 * names (illuminants of CIE 15:2004 and the ACES D60; metals' n and k; glasses' n from refractiveindex.info), by the
 * rules of image/color.h: an index is averaged over each channel's response, a light has its colour at luminance 1. The
 * exception is D50: pbrt's table of that name has chromaticity (0.3368, 0.3540) instead of D50's (0.3457, 0.3585), so
 * the CIE daylight formula at 5003 K was used instead.
 *
 * Metals: averaging n and k separately would not reproduce the colour of the metal's reflectance. So n is the average,
 * and k solves F0 = ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2), where F0 is the colour under D65 of the spectral reflectance
 * at normal incidence, at most 0.999 (gold's red lies outside sRGB: 1.022). For materials without absorption (k below
 * 0.01: MgO, TiO2) k is 0 and n = (1 + sqrt F0) / (1 - sqrt F0). */
#include "image/color.h"

#include <string.h>

typedef struct NamedSpectrum {
    const char *name;
    ColorRole role;
    float rgb[3];
} NamedSpectrum;

static const NamedSpectrum NAMED_SPECTRA[] = {
    {"metal-Ag-eta", COLOR_INDEX, {0.12897f, 0.12636f, 0.14821f}},
    {"metal-Ag-k", COLOR_INDEX, {4.1028f, 3.3689f, 2.3836f}},
    {"metal-Al-eta", COLOR_INDEX, {1.2146f, 0.92064f, 0.62927f}},
    {"metal-Al-k", COLOR_INDEX, {7.1451f, 6.5746f, 5.5374f}},
    {"metal-Au-eta", COLOR_INDEX, {0.28264f, 0.47938f, 1.4353f}},
    {"metal-Au-k", COLOR_INDEX, {33.599f, 2.574f, 1.6772f}},
    {"metal-Cu-eta", COLOR_INDEX, {0.43115f, 0.96402f, 1.1625f}},
    {"metal-Cu-k", COLOR_INDEX, {6.0454f, 2.6043f, 2.3221f}},
    {"metal-CuZn-eta", COLOR_INDEX, {0.49285f, 0.56526f, 1.0603f}},
    {"metal-CuZn-k", COLOR_INDEX, {4.4262f, 2.7832f, 1.7616f}},
    {"metal-MgO-eta", COLOR_INDEX, {1.7337f, 1.7409f, 1.7535f}},
    {"metal-MgO-k", COLOR_INDEX, {0.0f, 0.0f, 0.0f}},
    {"metal-TiO2-eta", COLOR_INDEX, {2.8604f, 2.9569f, 3.1857f}},
    {"metal-TiO2-k", COLOR_INDEX, {0.0f, 0.0f, 0.0f}},
    {"glass-BK7", COLOR_INDEX, {1.5165f, 1.5192f, 1.5252f}},
    {"glass-BAF10", COLOR_INDEX, {1.6696f, 1.6743f, 1.6851f}},
    {"glass-FK51A", COLOR_INDEX, {1.4864f, 1.4883f, 1.4925f}},
    {"glass-LASF9", COLOR_INDEX, {1.8496f, 1.8581f, 1.879f}},
    {"glass-SF5", COLOR_INDEX, {1.6722f, 1.6789f, 1.6954f}},
    {"glass-F5", COLOR_INDEX, {1.6722f, 1.6789f, 1.6954f}},
    {"glass-SF10", COLOR_INDEX, {1.7277f, 1.7359f, 1.7563f}},
    {"glass-F10", COLOR_INDEX, {1.7277f, 1.7359f, 1.7563f}},
    {"glass-SF11", COLOR_INDEX, {1.784f, 1.7938f, 1.8185f}},
    {"glass-F11", COLOR_INDEX, {1.784f, 1.7938f, 1.8185f}},
    {"stdillum-A", COLOR_ILLUMINANT, {1.845f, 0.82607f, 0.23337f}},
    {"stdillum-D50", COLOR_ILLUMINANT, {1.176f, 0.97571f, 0.722f}},
    {"stdillum-D65", COLOR_ILLUMINANT, {1.0f, 1.0f, 1.0f}},
    {"stdillum-F1", COLOR_ILLUMINANT, {0.95426f, 1.0193f, 0.94367f}},
    {"stdillum-F2", COLOR_ILLUMINANT, {1.3401f, 0.94299f, 0.56285f}},
    {"stdillum-F3", COLOR_ILLUMINANT, {1.5764f, 0.89107f, 0.38089f}},
    {"stdillum-F4", COLOR_ILLUMINANT, {1.8063f, 0.8342f, 0.26707f}},
    {"stdillum-F5", COLOR_ILLUMINANT, {0.91539f, 1.0362f, 0.89032f}},
    {"stdillum-F6", COLOR_ILLUMINANT, {1.3161f, 0.95783f, 0.4865f}},
    {"stdillum-F7", COLOR_ILLUMINANT, {1.0003f, 1.0002f, 0.9974f}},
    {"stdillum-F8", COLOR_ILLUMINANT, {1.1767f, 0.97572f, 0.72009f}},
    {"stdillum-F9", COLOR_ILLUMINANT, {1.3768f, 0.9314f, 0.56935f}},
    {"stdillum-F10", COLOR_ILLUMINANT, {1.1776f, 0.97562f, 0.71836f}},
    {"stdillum-F11", COLOR_ILLUMINANT, {1.4121f, 0.92473f, 0.53156f}},
    {"stdillum-F12", COLOR_ILLUMINANT, {1.7684f, 0.84507f, 0.27085f}},
    {"illum-acesD60", COLOR_ILLUMINANT, {1.0469f, 0.99457f, 0.91553f}},
};

static const char *const ROLE_NAMES[] = {"reflectance", "light", "index of refraction"};

/* Camera sensors known to pbrt, recognised by the prefixes of their names. */
static bool is_camera(const char *name)
{
    static const char *const MAKERS[] = {"canon_", "nikon_",   "sony_",      "hasselblad_", "fujifilm_",
                                         "leica_", "olympus_", "panasonic_", "cie1931"};
    for (size_t i = 0; i < sizeof MAKERS / sizeof *MAKERS; ++i)
        if (strncmp(name, MAKERS[i], strlen(MAKERS[i])) == 0)
            return true;
    return false;
}

bool color_named_spectrum(const char *name, ColorRole role, float rgb[3], Error *error)
{
    for (size_t i = 0; i < sizeof NAMED_SPECTRA / sizeof *NAMED_SPECTRA; ++i) {
        const NamedSpectrum *spectrum = &NAMED_SPECTRA[i];
        if (strcmp(name, spectrum->name) != 0)
            continue;
        if (role != spectrum->role) {
            error_set(error, "the spectrum \"%s\" describes: %s; needed here: %s", name, ROLE_NAMES[spectrum->role],
                      ROLE_NAMES[role]);
            return error_fix(error, "use a spectrum of that kind, or rgb");
        }
        memcpy(rgb, spectrum->rgb, sizeof spectrum->rgb);
        return true;
    }
    if (is_camera(name)) {
        error_set(error, "the spectrum \"%s\" is a camera's sensor, which is not supported", name);
        return error_fix(error, "leave the parameter out");
    }
    error_set(error, "unknown spectrum \"%s\"", name);
    return error_fix(error, "use metal-{Ag,Al,Au,Cu,CuZn,MgO,TiO2}-{eta,k}, "
                            "glass-{BK7,BAF10,FK51A,LASF9,SF5,SF10,SF11}, stdillum-{A,D50,D65,F1 ... F12}, "
                            "illum-acesD60, or the path of an .spd file");
}
