/* Pictures of a scene. Each is embedded in the page once, as an image in a store. Everything shown is a window on the
 * store, so patches and the full-window viewer add no data. */
#include "bench/analysis.h"
#include "bench/html.h"
#include "bench/report.h"
#include "compare/error_image.h"
#include "image/png_write.h"
#include "image/rendering_file.h"

#include <math.h>
#include <stdlib.h>

/* Numbers in the store: 0 is the reference; series s has 1 + 3 s, its picture, 2 + 3 s, its relative error, and 3 + 3
 * s, its FLIP map. */
#define PICTURE(series) (1 + 3 * (series))
#define ERROR(series) (2 + 3 * (series))
#define FLIP(series) (3 + 3 * (series))

#define LEGEND_WIDTH 512
#define ROW_MOST 5 /* pictures per row */

typedef struct Pictures {
    const Bench *bench;
    const BenchScene *scene;
    int number; /* number of the scene */
    int time; /* index of the time whose runs are shown */
    FILE *stream;
} Pictures;

/* ---- the store -------------------------------------------------------------------------------------------------- */

static bool image_store(const Pictures *pictures, int id, const float *rgb, double exposure, Error *error)
{
    const BenchScene *scene = pictures->scene;
    unsigned char *bytes = NULL;
    size_t size = 0;
    if (!png_memory(rgb, scene->width, scene->height, (float)exposure, &bytes, &size, error))
        return false;
    fprintf(pictures->stream, "<image id=\"i%d-%d\" width=\"%d\" height=\"%d\" href=\"", pictures->number, id,
            scene->width, scene->height);
    html_png(pictures->stream, bytes, size);
    fputs("\"/>\n", pictures->stream);
    free(bytes);
    return true;
}

/* The FLIP map: where the pictures look different. */
static bool flip_store(const Pictures *pictures, int id, const Rendering *image, const Rendering *reference, float *rgb,
                       Error *error)
{
    const DisplaySettings *display = &pictures->bench->options.display;
    size_t pixels = (size_t)image->width * (size_t)image->height;
    double mean = 0.0;
    float *shown = malloc(7 * pixels * sizeof *shown);
    if (!shown)
        return error_memory(error, 7 * pixels * sizeof *shown, "an error image");
    float *map = shown + 6 * pixels;
    display_linear(image->rgb, 3 * pixels, display->exposure, shown);
    display_linear(reference->rgb, 3 * pixels, display->exposure, shown + 3 * pixels);
    bool good = flip_compute(shown, shown + 3 * pixels, image->width, image->height, display->pixels_per_degree, map,
                             &mean, error);
    for (size_t i = 0; i < pixels && good; ++i)
        magnitude_color(map[i], rgb + 3 * i);
    free(shown);
    return good && image_store(pictures, id, rgb, 0.0, error);
}

static bool series_store(const Pictures *pictures, int series, const Rendering *reference, float *map, Error *error)
{
    const BenchRun *run = pictures->scene->series[series].groups[pictures->time].typical;
    Rendering image;
    if (!rendering_load(run->image, &image, error))
        return false;
    bool good = image_store(pictures, PICTURE(series), image.rgb, pictures->bench->options.display.exposure, error) &&
                error_image_rgb(image.rgb, reference->rgb, image.width, image.height, map, error) &&
                image_store(pictures, ERROR(series), map, 0.0, error) &&
                flip_store(pictures, FLIP(series), &image, reference, map, error);
    rendering_destroy(&image);
    return good;
}

static bool store_write(const Pictures *pictures, Error *error)
{
    const BenchScene *scene = pictures->scene;
    size_t values = 3 * (size_t)scene->width * (size_t)scene->height;
    Rendering reference;
    float *map = malloc(values * sizeof *map);
    if (!map)
        return error_memory(error, values * sizeof *map, "an error image");
    bool good = rendering_load(scene->reference.path, &reference, error);
    fputs("<svg class=\"store\" aria-hidden=\"true\"><defs>\n", pictures->stream);
    good = good && image_store(pictures, 0, reference.rgb, pictures->bench->options.display.exposure, error);
    for (int s = 0; s < scene->series_count && good; ++s)
        good = series_store(pictures, s, &reference, map, error);
    fputs("</defs></svg>\n", pictures->stream);
    rendering_destroy(&reference);
    free(map);
    return good;
}

/* ---- windows on it ---------------------------------------------------------------------------------------------- */

static void patches_mark(const Pictures *pictures)
{
    const BenchOptions *options = &pictures->bench->options;
    static const char *const CLASSES[] = {"patch-dark", "patch"};
    for (int i = 0; i < options->patch_count; ++i)
        for (int k = 0; k < 2; ++k)
            fprintf(pictures->stream, "<rect class=\"%s\" x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\"/>", CLASSES[k],
                    options->patches[i].x, options->patches[i].y, options->patches[i].width,
                    options->patches[i].height);
}

/* A picture that links to its viewer. */
static void window_write(const Pictures *pictures, int id, const char *kind, bool marked)
{
    const BenchScene *scene = pictures->scene;
    fprintf(pictures->stream,
            "<a href=\"#v%d-%d\"><svg class=\"picture %s\" viewBox=\"0 0 %d %d\"><use href=\"#i%d-%d\"/>",
            pictures->number, id, kind, scene->width, scene->height, pictures->number, id);
    if (marked)
        patches_mark(pictures);
    fputs("</svg></a>\n", pictures->stream);
}

static void caption_figures(const Pictures *pictures, const BenchSeries *series)
{
    const BenchRun *run = series->groups[pictures->time].typical;
    fprintf(pictures->stream, "<b class=\"s%d\">", (int)(series - pictures->scene->series) % 8);
    html_text(pictures->stream, series->name);
    fputs("</b> ", pictures->stream);
    html_number(pictures->stream, run->record.seconds, 3);
    fputs(" s, ", pictures->stream);
    html_number(pictures->stream, run->record.samples_per_pixel, 3);
    fputs(" samples per pixel<br/>relMSE <b>", pictures->stream);
    html_number(pictures->stream, run->figures.rel_mse, 3);
    fputs("</b>, FLIP <b>", pictures->stream);
    html_number(pictures->stream, run->figures.flip, 3);
    fputs("</b>", pictures->stream);
}

/* ---- legends ----------------------------------------------------------------------------------------------------- */

static bool legend_write(const Pictures *pictures, const char *name, const float *rgb, const char *ticks, Error *error)
{
    unsigned char *bytes = NULL;
    size_t size = 0;
    if (!png_memory(rgb, LEGEND_WIDTH, 1, 0.0f, &bytes, &size, error))
        return false;
    fprintf(pictures->stream, "<div class=\"legend\">%s<img alt=\"colour scale of %s, from lowest to highest\" src=\"",
            name, name);
    html_png(pictures->stream, bytes, size);
    fprintf(pictures->stream, "\"/><div>%s</div></div>\n", ticks);
    free(bytes);
    return true;
}

static bool legends_write(const Pictures *pictures, Error *error)
{
    float relative[3 * LEGEND_WIDTH], magnitude[3 * LEGEND_WIDTH];
    for (int i = 0; i < LEGEND_WIDTH; ++i) {
        float place = ((float)i + 0.5f) / LEGEND_WIDTH, side = 2.0f * place - 1.0f; /* three decades on either side */
        error_color(copysignf(powf(10.0f, 3.0f * (fabsf(side) - 1.0f)), side), relative + 3 * i);
        magnitude_color(place, magnitude + 3 * i);
    }
    return legend_write(pictures, "relative error of a pixel", relative,
                        "<span>\u2212100 %</span><span>\u221210</span><span>\u22121</span><span>0</span><span>1</span>"
                        "<span>10</span><span>100 %</span>",
                        error) &&
           legend_write(pictures, "FLIP", magnitude,
                        "<span>0</span><span>0.25</span><span>0.5</span><span>0.75</span><span>1</span>", error);
}

static bool pictures_write(const Pictures *pictures, Error *error)
{
    /* One row of up to ROW_MOST pictures, otherwise two rows of about equal length. */
    int count = pictures->scene->series_count + 1, columns = count <= ROW_MOST ? count : (count + 1) / 2;
    fprintf(pictures->stream, "<div class=\"pictures\" style=\"--n:%d\">\n<figure>",
            columns < ROW_MOST ? columns : ROW_MOST);
    window_write(pictures, 0, "", true);
    fputs("<figcaption><b>reference</b><br/>", pictures->stream);
    html_text(pictures->stream, pictures->scene->reference.origin);
    fputs("</figcaption>", pictures->stream);
    if (!legends_write(pictures, error))
        return false;
    fputs("</figure>\n", pictures->stream);
    for (int s = 0; s < pictures->scene->series_count; ++s) {
        fputs("<figure>", pictures->stream);
        window_write(pictures, PICTURE(s), "", true);
        window_write(pictures, ERROR(s), "error", true);
        window_write(pictures, FLIP(s), "error", true);
        fputs("<figcaption>", pictures->stream);
        caption_figures(pictures, &pictures->scene->series[s]);
        fputs("</figcaption></figure>\n", pictures->stream);
    }
    fputs("</div>\n", pictures->stream);
    return true;
}

static void patch_cell(const Pictures *pictures, const BenchPatch *patch, int id, const char *name, double rel_mse,
                       bool best)
{
    fprintf(pictures->stream,
            "<figure><svg class=\"picture crop\" viewBox=\"%d %d %d %d\"><use href=\"#i%d-%d\"/></svg><figcaption>",
            patch->x, patch->y, patch->width, patch->height, pictures->number, id);
    html_text(pictures->stream, name);
    if (!isnan(rel_mse)) {
        fputs(best ? "<br/><b>relMSE " : "<br/>relMSE ", pictures->stream);
        html_number(pictures->stream, rel_mse, 3);
        fputs(best ? "</b>" : "", pictures->stream);
    }
    fputs("</figcaption></figure>\n", pictures->stream);
}

static void patches_write(const Pictures *pictures)
{
    const BenchOptions *options = &pictures->bench->options;
    const BenchScene *scene = pictures->scene;
    if (options->patch_count == 0)
        return;
    fprintf(pictures->stream, "<h3>Patches</h3>\n<div class=\"patches\" style=\"--n:%d\">\n", scene->series_count + 1);
    for (int i = 0; i < options->patch_count; ++i) {
        const BenchPatch *patch = &options->patches[i];
        double least = HUGE_VAL;
        for (int s = 0; s < scene->series_count; ++s)
            least = fmin(least, scene->series[s].groups[pictures->time].typical->figures.patches[i]);
        fputs("<h4>", pictures->stream);
        html_text(pictures->stream, patch->name);
        fprintf(pictures->stream, " <span class=\"soft\">%d,%d,%d,%d</span></h4>\n", patch->x, patch->y, patch->width,
                patch->height);
        patch_cell(pictures, patch, 0, "reference", (double)NAN, false);
        for (int s = 0; s < scene->series_count; ++s) {
            double rel_mse = scene->series[s].groups[pictures->time].typical->figures.patches[i];
            patch_cell(pictures, patch, PICTURE(s), scene->series[s].name, rel_mse, rel_mse == least);
        }
    }
    fputs("</div>\n", pictures->stream);
}

/* ---- the viewer ------------------------------------------------------------------------------------------------- */

static void viewer_link(const Pictures *pictures, int id, int here, const char *name, const char *suffix)
{
    fprintf(pictures->stream, "<a href=\"#v%d-%d\"%s>", pictures->number, id, id == here ? " class=\"here\"" : "");
    html_text(pictures->stream, name);
    fprintf(pictures->stream, "%s</a>", suffix);
}

/* One viewer per picture, all with the same layout: switching shows only what differs. */
static void viewers_write(const Pictures *pictures)
{
    const BenchScene *scene = pictures->scene;
    for (int id = 0; id <= 3 * scene->series_count; ++id) {
        fprintf(pictures->stream, "<div class=\"viewer\" id=\"v%d-%d\"><nav><a href=\"#pictures%d\">close</a>",
                pictures->number, id, pictures->number);
        viewer_link(pictures, 0, id, "reference", "");
        for (int s = 0; s < scene->series_count; ++s)
            viewer_link(pictures, PICTURE(s), id, scene->series[s].name, "");
        for (int s = 0; s < scene->series_count; ++s)
            viewer_link(pictures, ERROR(s), id, scene->series[s].name, ": error");
        for (int s = 0; s < scene->series_count; ++s)
            viewer_link(pictures, FLIP(s), id, scene->series[s].name, ": FLIP");
        fprintf(pictures->stream, "</nav><svg viewBox=\"0 0 %d %d\"><use href=\"#i%d-%d\"/></svg></div>\n",
                scene->width, scene->height, pictures->number, id);
    }
}

/* ---- all of it -------------------------------------------------------------------------------------------------- */

bool bench_pictures_write(const Bench *bench, int scene, FILE *stream, Error *error)
{
    const Pictures pictures = {bench, &bench->scenes[scene], scene,
                               bench_common_time(&bench->options, &bench->scenes[scene]), stream};
    if (pictures.time < 0)
        return true;
    fprintf(stream, "<h3 id=\"pictures%d\">Pictures after %g s</h3>\n", scene, bench->options.times[pictures.time]);
    fputs("<p class=\"soft\">Of each integrator the run with the median relMSE; below it the relative error of each "
          "pixel (red to yellow: too bright; blue to cyan: too dark) and FLIP. Click a picture to see it alone; "
          "further clicks show the others in the same place.</p>\n",
          stream);
    if (!store_write(&pictures, error) || !pictures_write(&pictures, error))
        return false;
    patches_write(&pictures);
    viewers_write(&pictures);
    return true;
}
