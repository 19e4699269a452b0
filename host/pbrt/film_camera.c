/* Film, PixelFilter and Camera. */
#include "base/log.h"
#include "film/film.h"
#include "image/color.h"
#include "pbrt/errors.h"
#include "pbrt/media_places.h"
#include "pbrt/readers.h"
#include "pbrt/state.h"
#include "scene/filter_setup.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool list_end(PbrtImport *im, ParamList *list)
{
    bool good = param_list_finish(list, im->options.lenient);
    param_list_destroy(list);
    return good;
}

static int side_read(ParamList *list, const char *name, int fallback)
{
    int side = param_integer(list, name, fallback);
    if (side < 1 || side > IMPORT_FILM_MAX)
        param_error(list, name, "\"%s\" of a film must be from 1 to %d", name, IMPORT_FILM_MAX);
    return side;
}

static bool crop_check(ParamList *list, const char *name, const int crop[4])
{
    if (crop[0] < crop[2] && crop[1] < crop[3])
        return true;
    param_error(list, name, "\"%s\" leaves no pixel of the film", name);
    return false;
}

/* Reads x0 x1 y0 y1 in pixels, clamped to the film. */
static void pixel_bounds_read(ParamList *list, const SceneSettings *film, int crop[4])
{
    size_t count;
    const int *b = param_integers(list, "pixelbounds", &count);
    if (!b)
        return;
    if (count != 4) {
        param_error(list, "pixelbounds", "\"pixelbounds\" takes 4 values: x0 x1 y0 y1");
        return;
    }
    const int limits[2] = {film->width, film->height};
    for (int k = 0; k < 2; ++k) {
        int low = b[2 * k] < b[2 * k + 1] ? b[2 * k] : b[2 * k + 1];
        int high = b[2 * k] < b[2 * k + 1] ? b[2 * k + 1] : b[2 * k];
        if (low < 0 || high > limits[k])
            log_message_at(LOG_WARNING, param_place(list, "pixelbounds"), "\"pixelbounds\" is clipped to the film");
        crop[k] = low > 0 ? low : 0;
        crop[2 + k] = high < limits[k] ? high : limits[k];
    }
    crop_check(list, "pixelbounds", crop);
}

/* Reads x0 x1 y0 y1 in [0, 1]; overrides pixelbounds, as in pbrt. */
static void crop_window_read(ParamList *list, const SceneSettings *film, int crop[4])
{
    size_t count;
    const float *w = param_floats(list, "cropwindow", PARAM_FLOAT, &count);
    if (!w)
        return;
    if (count != 4) {
        param_error(list, "cropwindow", "\"cropwindow\" takes 4 values: x0 x1 y0 y1");
        return;
    }
    const int sides[2] = {film->width, film->height};
    for (int k = 0; k < 2; ++k) {
        float low = float_min(w[2 * k], w[2 * k + 1]), high = float_max(w[2 * k], w[2 * k + 1]);
        crop[k] = (int)ceilf((float)sides[k] * float_clamp(low, 0.0f, 1.0f));
        crop[2 + k] = (int)ceilf((float)sides[k] * float_clamp(high, 0.0f, 1.0f));
    }
    crop_check(list, "cropwindow", crop);
}

/* The sensors that pbrt knows beside cie1931. */
static const char *const SENSORS[] = {
    "cie1931",       "canon_eos_100d",     "canon_eos_1dx_mkii", "canon_eos_200d",    "canon_eos_200d_mkii",
    "canon_eos_5d",  "canon_eos_5d_mkii",  "canon_eos_5d_mkiii", "canon_eos_5d_mkiv", "canon_eos_5ds",
    "canon_eos_m",   "hasselblad_l1d_20c", "nikon_d810",         "nikon_d850",        "sony_ilce_6400",
    "sony_ilce_7m3", "sony_ilce_7rm3",     "sony_ilce_9"};
#define SENSOR_COUNT (sizeof SENSORS / sizeof *SENSORS)

/* Without spectra, all sensors see what the CIE 1931 observer does. */
static void sensor_name_read(PbrtImport *im, ParamList *list)
{
    const char *sensor = param_string(list, "sensor", SENSORS[0]);
    size_t i = 0;
    while (i < SENSOR_COUNT && strcmp(sensor, SENSORS[i]) != 0)
        ++i;
    if (i == SENSOR_COUNT && !list->failed)
        list->failed = !import_unknown(im, param_place(list, "sensor"), "sensor", sensor, SENSORS, SENSOR_COUNT);
    else if (i > 0)
        log_message_at(LOG_WARNING, param_place(list, "sensor"),
                       "the sensor \"%s\" counts as cie1931: its spectral response needs spectra, and is left out",
                       sensor);
}

/* Temperatures of white balance: below, black bodies have no blue in sRGB; above, daylight is not defined. */
#define BALANCE_KELVIN_MIN 2000.0f
#define BALANCE_KELVIN_MAX 25000.0f

/* Sets the factors of red, green and blue that make daylight of the temperature white, at the same luminance. */
static void white_balance_read(PbrtImport *im, ParamList *list)
{
    float kelvin = param_float(list, "whitebalance", 0.0f), white[3];
    if (kelvin == 0.0f)
        return;
    if (!(kelvin >= BALANCE_KELVIN_MIN && kelvin <= BALANCE_KELVIN_MAX)) {
        param_error(list, "whitebalance", "\"whitebalance\" must be 0 or from 2000 to 25000 kelvin");
        return;
    }
    color_daylight(kelvin, white);
    im->balance = vec3(1.0f / white[0], 1.0f / white[1], 1.0f / white[2]);
}

static void sensor_read(PbrtImport *im, ParamList *list)
{
    sensor_name_read(im, list);
    white_balance_read(im, list);
    im->iso = param_float(list, "iso", 100.0f);
    im->exposure_time = param_float(list, "exposuretime", 0.0f);
    if (!(im->iso > 0.0f))
        param_error(list, "iso", "\"iso\" must be above 0");
    if (im->exposure_time < 0.0f)
        param_error(list, "exposuretime", "\"exposuretime\" is negative");
    if (param_float(list, "maxcomponentvalue", 0.0f) != 0.0f)
        log_message_at(LOG_WARNING, param_place(list, "maxcomponentvalue"),
                       "\"maxcomponentvalue\" is ignored: samples are not clamped");
}

static void kind_params_ignore(ParamList *list, const char *kind)
{
    param_ignore(list, "savefp16");
    param_ignore(list, "diagonal"); /* for pbrt's realistic camera */
    if (strcmp(kind, "gbuffer") == 0)
        param_ignore(list, "coordinatesystem");
    if (strcmp(kind, "spectral") == 0) {
        param_ignore(list, "nbuckets");
        param_ignore(list, "lambdamin");
        param_ignore(list, "lambdamax");
    }
}

bool import_film(PbrtImport *im, const char *kind)
{
    static const char *const KNOWN[] = {"rgb", "gbuffer", "spectral"};
    SceneSettings *film = &im->scene->settings;
    ParamList list;
    if (strcmp(kind, "rgb") != 0 && strcmp(kind, "gbuffer") != 0 && strcmp(kind, "spectral") != 0)
        return import_unknown(im, im->place, "film", kind, KNOWN, 3);
    if (kind[0] != 'r')
        log_message_at(LOG_INFO, im->place, "the film \"%s\" is written as rgb", kind);
    import_list(im, &list, "the film", -1);
    film->width = side_read(&list, "xresolution", 1280);
    film->height = side_read(&list, "yresolution", 720);
    if ((int64_t)film->width * film->height > (int64_t)FILM_PIXELS_MAX)
        param_error(&list, "yresolution", "a film of %d x %d pixels is too large: 2^29 - 1 pixels at most", film->width,
                    film->height);
    int crop[4] = {0, 0, film->width, film->height};
    if (!list.failed) {
        pixel_bounds_read(&list, film, crop);
        crop_window_read(&list, film, crop);
    }
    memcpy(film->crop, crop, sizeof crop);
    const char *file = param_string(&list, "filename", "");
    if (strlen(file) >= sizeof film->output)
        param_error(&list, "filename", "the film's file name is too long");
    snprintf(film->output, sizeof film->output, "%s", file);
    sensor_read(im, &list);
    kind_params_ignore(&list, kind);
    return list_end(im, &list);
}

static const struct {
    const char *name;
    uint kind;
    float radius;
} FILTERS[] = {{"box", PIXEL_FILTER_BOX, 0.5f},
               {"triangle", PIXEL_FILTER_TRIANGLE, 2.0f},
               {"gaussian", PIXEL_FILTER_GAUSSIAN, 1.5f},
               {"mitchell", PIXEL_FILTER_MITCHELL, 2.0f},
               {"sinc", PIXEL_FILTER_SINC, 4.0f}};
#define FILTER_COUNT (sizeof FILTERS / sizeof *FILTERS)

static float positive_read(ParamList *list, const char *name, float fallback)
{
    float value = param_float(list, name, fallback);
    if (!(value > 0.0f))
        param_error(list, name, "\"%s\" of %s must be above 0", name, list->owner);
    return value;
}

static float radius_read(ParamList *list, const char *name, float fallback)
{
    float radius = positive_read(list, name, fallback);
    if (radius > 64.0f)
        param_error(list, name, "\"%s\" of a filter must not exceed 64 pixels", name);
    return radius;
}

/* Reports parameters for which the filter's integral is not positive, while their place is known. */
static void filter_check(ParamList *list, const FilterSettings *filter)
{
    Error error = {{0}, {0}};
    Array lookup;
    PixelFilter unused;
    array_init(&lookup, sizeof(float));
    if (!filter_setup(filter, &lookup, &unused, &error)) {
        error_at(list->error, list->place, "%s", error_text(&error));
        error_fix(list->error, "%s", error.fix);
        list->failed = true;
    }
    array_destroy(&lookup);
}

bool import_filter(PbrtImport *im, const char *kind)
{
    const char *names[FILTER_COUNT];
    ParamList list;
    size_t i = 0;
    while (i < FILTER_COUNT && strcmp(FILTERS[i].name, kind) != 0)
        ++i;
    if (i == FILTER_COUNT) {
        for (size_t k = 0; k < FILTER_COUNT; ++k)
            names[k] = FILTERS[k].name;
        return import_unknown(im, im->place, "filter", kind, names, FILTER_COUNT);
    }
    import_list(im, &list, "the filter", -1);
    FilterSettings *filter = &im->scene->filter_settings;
    *filter = (FilterSettings){.kind = FILTERS[i].kind};
    filter->radius_x = radius_read(&list, "xradius", FILTERS[i].radius);
    filter->radius_y = radius_read(&list, "yradius", FILTERS[i].radius);
    if (filter->kind == PIXEL_FILTER_GAUSSIAN)
        filter->sigma = positive_read(&list, "sigma", 0.5f);
    if (filter->kind == PIXEL_FILTER_MITCHELL) {
        filter->b = param_float(&list, "B", 1.0f / 3.0f);
        filter->c = param_float(&list, "C", 1.0f / 3.0f);
    }
    if (filter->kind == PIXEL_FILTER_SINC)
        filter->tau = positive_read(&list, "tau", 3.0f);
    if (!list.failed)
        filter_check(&list, filter);
    return list_end(im, &list);
}

static void screen_window_read(ParamList *list, CameraSettings *camera)
{
    size_t count;
    const float *window = param_floats(list, "screenwindow", PARAM_FLOAT, &count);
    camera->has_screen_window = window != NULL;
    if (!window)
        return;
    if (count != 4) {
        param_error(list, "screenwindow", "\"screenwindow\" takes 4 values: x0 x1 y0 y1");
        return;
    }
    memcpy(camera->screen_window, window, sizeof camera->screen_window);
    if (!(window[0] != window[1] && window[2] != window[3]))
        param_error(list, "screenwindow", "\"screenwindow\" is empty");
}

static void lens_read(ParamList *list, CameraSettings *camera)
{
    camera->lens_radius = param_float(list, "lensradius", 0.0f);
    camera->focal_distance = positive_read(list, "focaldistance", 1e6f);
    if (camera->lens_radius < 0.0f)
        param_error(list, "lensradius", "\"lensradius\" is negative");
    camera->frame_aspect = 0.0f;
    if (param_ignore(list, "frameaspectratio"))
        camera->frame_aspect = positive_read(list, "frameaspectratio", 1.0f);
}

static void shutter_read(PbrtImport *im, ParamList *list)
{
    im->shutter_open = param_float(list, "shutteropen", 0.0f);
    im->shutter_close = param_float(list, "shutterclose", 1.0f);
    if (!(im->shutter_close > im->shutter_open))
        param_error(list, param_ignore(list, "shutterclose") ? "shutterclose" : "shutteropen",
                    "the shutter closes before it opens: the image would be black");
}

static const char *const CAMERAS[] = {"perspective", "orthographic", "spherical"};
#define CAMERA_COUNT (sizeof CAMERAS / sizeof *CAMERAS)

static bool camera_known(const char *kind)
{
    size_t i = 0;
    while (i < CAMERA_COUNT && strcmp(kind, CAMERAS[i]) != 0)
        ++i;
    return i < CAMERA_COUNT;
}

/* Handles cameras that are not supported. */
static bool camera_other(PbrtImport *im, const char *kind, bool *substitute)
{
    *substitute = false;
    if (strcmp(kind, "realistic") != 0)
        return import_unknown(im, im->place, "camera", kind, CAMERAS, CAMERA_COUNT);
    *substitute =
        import_unsupported(im, im->place, "the camera \"realistic\"", "a perspective camera of 90 degrees", NULL);
    return *substitute;
}

static bool camera_transform_set(PbrtImport *im, CameraSettings *camera)
{
    Matrix ctm, inverse;
    if (!import_ctm_inverse(im, im->place, false, &ctm, &inverse))
        return false;
    memcpy(camera->camera_from_world, ctm.m, sizeof ctm.m);
    memcpy(camera->world_from_camera, inverse.m, sizeof inverse.m);
    Matrix named[2] = {inverse, inverse};
    return state_coordinate_system(im, "camera", named);
}

static void mapping_read(ParamList *list, CameraSettings *camera)
{
    const char *mapping = param_string(list, "mapping", "equalarea");
    camera->kind = CAMERA_EQUAL_AREA;
    if (strcmp(mapping, "equirectangular") == 0)
        camera->kind = CAMERA_EQUIRECTANGULAR;
    else if (strcmp(mapping, "equalarea") != 0) {
        param_error(list, "mapping", "unknown mapping \"%s\" of a spherical camera", mapping);
        error_fix(list->error, "use equalarea or equirectangular");
    }
}

static void camera_params_read(PbrtImport *im, const char *kind, ParamList *list, CameraSettings *camera)
{
    lens_read(list, camera);
    screen_window_read(list, camera);
    shutter_read(im, list);
    if (strcmp(kind, "orthographic") == 0) {
        camera->kind = CAMERA_ORTHOGRAPHIC;
    } else if (strcmp(kind, "spherical") == 0) {
        mapping_read(list, camera);
        camera->lens_radius = 0.0f; /* as in pbrt, lens and window have no effect */
    } else {
        camera->kind = CAMERA_PERSPECTIVE;
        camera->fov = param_float(list, "fov", 90.0f);
        if (!(camera->fov > 0.0f && camera->fov < 180.0f))
            param_error(list, "fov", "\"fov\" must be above 0 and below 180 degrees");
    }
}

bool import_camera(PbrtImport *im, const char *kind)
{
    CameraSettings *camera = &im->scene->camera_settings;
    ParamList list;
    char owner[96];
    bool known = camera_known(kind), substitute = false;
    if (!camera_transform_set(im, camera) || (!known && !camera_other(im, kind, &substitute)))
        return false;
    camera->medium = im->state.outside;
    if (!media_places_camera(im))
        return false;
    if (substitute)
        return true;
    snprintf(owner, sizeof owner, "the %s camera", kind);
    import_list(im, &list, owner, -1);
    camera_params_read(im, kind, &list, camera);
    return list_end(im, &list);
}

/* Sets the film's scale to pbrt's imaging ratio, exposure time x ISO / 100; by default the exposure time is the
 * camera's shutter time. */
bool import_settings_finish(PbrtImport *im)
{
    float time = im->exposure_time > 0.0f ? im->exposure_time : im->shutter_close - im->shutter_open;
    im->scene->settings.film_scale = time * im->iso / 100.0f;
    if (float_finite(im->scene->settings.film_scale) && im->scene->settings.film_scale > 0.0f)
        return true;
    error_at(im->error, im->place, "the exposure, shutter time x iso / 100, is out of range");
    return error_fix(im->error, "check \"iso\" and \"exposuretime\" of the Film and the Camera's shutter");
}
