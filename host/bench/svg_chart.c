#include "bench/svg_chart.h"

#include "bench/html.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 620.0
#define HEIGHT 380.0
#define LEFT 64.0
#define RIGHT_MIN 60.0
#define CHARACTER 7.4 /* approximate width of a character in a name */
#define TOP 34.0
#define BOTTOM 48.0
#define LABEL_STEP 16.0
#define LABELS_MAX 64
#define NUMBERS_LEAST 3 /* fewer on an axis: evenly spaced lines instead */

/* An axis: its range in log10, and its ends on the page. */
typedef struct Axis {
    double low, high;
    double from, to;
} Axis;

static double place(const Axis *axis, double value)
{
    return axis->from + (log10(value) - axis->low) / (axis->high - axis->low) * (axis->to - axis->from);
}

static void axis_include(Axis *axis, double value)
{
    if (!(value > 0.0) || !isfinite(value))
        return;
    axis->low = fmin(axis->low, log10(value));
    axis->high = fmax(axis->high, log10(value));
}

/* Adds a margin on both sides, at least a quarter of a decade each if the range is less than a tenth of one. */
static void axis_finish(Axis *axis)
{
    if (!(axis->low <= axis->high))
        axis->low = axis->high = 0.0;
    double margin = fmax(0.06 * (axis->high - axis->low), axis->high - axis->low < 0.1 ? 0.25 : 0.0);
    axis->low -= margin;
    axis->high += margin;
}

/* Whether the grid line at `step` times a power of ten has a number, on an axis of this many decades. */
static bool step_has_number(int step, double decades)
{
    if (step == 1)
        return true;
    if (decades > 2.2)
        return false;
    return step == 2 || step == 5 || (decades < 0.9 && (step == 3 || step == 4 || step == 7));
}

/* digits: of its number; 0: no number. */
static void grid_line(FILE *stream, const Axis *x, const Axis *y, bool vertical, bool fine, double value, int digits)
{
    double at = place(vertical ? y : x, value);
    char text[64];
    fprintf(stream, "<line class=\"%s\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>", fine ? "grid fine" : "grid",
            vertical ? x->from : at, vertical ? at : y->from, vertical ? x->to : at, vertical ? at : y->to);
    if (digits == 0)
        return;
    html_number_text(text, sizeof text, value, digits);
    fprintf(stream, "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n",
            vertical ? x->from - 7.0 : at, vertical ? at + 4.0 : y->from + 17.0, vertical ? "end" : "middle", text);
}

/* Draws grid lines at and between powers of ten, fewer on axes of many decades; draws nothing if `stream` is NULL.
 * Returns how many have numbers. */
static int grid_decades(FILE *stream, const Axis *x, const Axis *y, bool vertical)
{
    const Axis *axis = vertical ? y : x;
    double decades = axis->high - axis->low;
    int numbers = 0;
    for (int decade = (int)floor(axis->low); decade <= (int)ceil(axis->high); ++decade)
        for (int step = 1; step < 10; ++step) {
            double value = step * pow(10.0, decade);
            bool wanted = step == 1 || decades < 2.2 || (decades < 4.0 && (step == 2 || step == 5));
            if (!wanted || log10(value) < axis->low || log10(value) > axis->high)
                continue;
            bool number = step_has_number(step, decades);
            numbers += number;
            if (stream)
                grid_line(stream, x, y, vertical, step != 1, value, number ? 1 : 0);
        }
    return numbers;
}

/* Draws about four evenly spaced lines at round values, for an axis of a fraction of a decade. */
static void grid_even(FILE *stream, const Axis *x, const Axis *y, bool vertical)
{
    const Axis *axis = vertical ? y : x;
    double low = pow(10.0, axis->low), high = pow(10.0, axis->high);
    double apart = (high - low) / 4.0, unit = pow(10.0, floor(log10(apart))), part = apart / unit;
    double step = unit * (part < 1.5 ? 1.0 : part < 3.5 ? 2.0 : part < 7.5 ? 5.0 : 10.0);
    int digits = (int)floor(log10(high)) - (int)floor(log10(step)) + 1;
    int first = (int)ceil(low / step), last = (int)floor(high / step);
    for (int k = first; k <= last; ++k)
        grid_line(stream, x, y, vertical, false, k * step, digits > 1 ? digits : 1);
}

static void grid_write(FILE *stream, const Axis *x, const Axis *y)
{
    for (int vertical = 0; vertical < 2; ++vertical)
        if (grid_decades(NULL, x, y, vertical == 1) < NUMBERS_LEAST)
            grid_even(stream, x, y, vertical == 1);
        else
            grid_decades(stream, x, y, vertical == 1);
}

/* Marks differ in shape as well as colour. */
static void mark_write(FILE *stream, int style, double x, double y)
{
    switch (style % 4) {
    case 0:
        fprintf(stream, "<circle class=\"mark\" cx=\"%.1f\" cy=\"%.1f\" r=\"4.2\">", x, y);
        break;
    case 1:
        fprintf(stream, "<path class=\"mark\" d=\"M%.1f %.1fh7.6v7.6h-7.6z\">", x - 3.8, y - 3.8);
        break;
    case 2:
        fprintf(stream, "<path class=\"mark\" d=\"M%.1f %.1fl5 8.6h-10z\">", x, y - 5.4);
        break;
    default:
        fprintf(stream, "<path class=\"mark\" d=\"M%.1f %.1fl5.2 5.2-5.2 5.2-5.2-5.2z\">", x, y - 5.2);
        break;
    }
}

static void mark_end(FILE *stream, int style, const ChartLine *line, const ChartPoint *point)
{
    char texts[4][64];
    const double values[4] = {point->x, point->middle, point->low, point->high};
    for (int i = 0; i < 4; ++i)
        html_number_text(texts[i], sizeof texts[i], values[i], 3);
    fputs("<title>", stream);
    html_text(stream, line->name);
    fprintf(stream, ": %s at %s; 10 to 90 %%: %s to %s</title>%s\n", texts[1], texts[0], texts[2], texts[3],
            style % 4 == 0 ? "</circle>" : "</path>");
}

static void line_write(FILE *stream, const ChartLine *line, const Axis *x, const Axis *y)
{
    int style = line->style % CHART_STYLES;
    fprintf(stream, "<g class=\"s%d\">", style);
    if (line->count > 1) {
        fputs("<path class=\"band\" d=\"", stream);
        for (int i = 0; i < line->count; ++i)
            fprintf(stream, "%c%.1f %.1f", i == 0 ? 'M' : 'L', place(x, line->points[i].x),
                    place(y, line->points[i].high));
        for (int i = line->count; i-- > 0;)
            fprintf(stream, "L%.1f %.1f", place(x, line->points[i].x), place(y, line->points[i].low));
        fprintf(stream, "z\"/><path class=\"line%s\" d=\"", line->dashed ? " dashed" : "");
        for (int i = 0; i < line->count; ++i)
            fprintf(stream, "%c%.1f %.1f", i == 0 ? 'M' : 'L', place(x, line->points[i].x),
                    place(y, line->points[i].middle));
        fputs("\"/>", stream);
    }
    for (int i = 0; i < line->count; ++i) {
        const ChartPoint *point = &line->points[i];
        double at = place(x, point->x);
        fprintf(stream, "<line class=\"whisker\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>", at,
                place(y, point->low), at, place(y, point->high));
        mark_write(stream, style, at, place(y, point->middle));
        mark_end(stream, style, line, point);
    }
    fputs("</g>\n", stream);
}

typedef struct Label {
    const ChartLine *line;
    double y;
} Label;

static int label_compare(const void *a, const void *b)
{
    double x = ((const Label *)a)->y, y = ((const Label *)b)->y;
    return (x > y) - (x < y);
}

/* Names beside the ends of their lines, moved apart so as not to overlap. */
static void labels_write(FILE *stream, const Chart *chart, const Axis *x, const Axis *y)
{
    Label labels[LABELS_MAX] = {{NULL, 0.0}};
    int count = 0;
    for (int i = 0; i < chart->count && count < LABELS_MAX; ++i) {
        const ChartLine *line = &chart->lines[i];
        if (line->count > 0)
            labels[count++] = (Label){line, place(y, line->points[line->count - 1].middle)};
    }
    qsort(labels, (size_t)count, sizeof labels[0], label_compare);
    for (int i = 1; i < count; ++i)
        labels[i].y = fmax(labels[i].y, labels[i - 1].y + LABEL_STEP);
    for (int i = count; i-- > 0;)
        labels[i].y = fmin(labels[i].y, i + 1 < count ? labels[i + 1].y - LABEL_STEP : y->from - 4.0);
    for (int i = 0; i < count; ++i) {
        const ChartLine *line = labels[i].line;
        fprintf(stream, "<g class=\"s%d\">", line->style % CHART_STYLES);
        mark_write(stream, line->style % CHART_STYLES, x->to + 14.0, labels[i].y);
        fputs(line->style % 4 == 0 ? "</circle>" : "</path>", stream);
        fprintf(stream, "<text class=\"name\" x=\"%.1f\" y=\"%.1f\">", x->to + 24.0, labels[i].y + 4.0);
        html_text(stream, line->name);
        fprintf(stream, " <tspan class=\"note\">%s</tspan></text></g>\n", line->note);
    }
}

/* Space for the longest name and its note. */
static double right_margin(const Chart *chart)
{
    size_t longest = 0;
    for (int i = 0; i < chart->count; ++i) {
        size_t length = strlen(chart->lines[i].name) + strlen(chart->lines[i].note) + 1;
        longest = length > longest ? length : longest;
    }
    return fmin(fmax(RIGHT_MIN, 30.0 + CHARACTER * (double)longest), 0.5 * WIDTH);
}

static void axes_fit(const Chart *chart, Axis *x, Axis *y)
{
    *x = (Axis){HUGE_VAL, -HUGE_VAL, LEFT, WIDTH - right_margin(chart)};
    *y = (Axis){HUGE_VAL, -HUGE_VAL, HEIGHT - BOTTOM, TOP};
    for (int i = 0; i < chart->count; ++i) {
        for (int p = 0; p < chart->lines[i].count; ++p) {
            const ChartPoint *point = &chart->lines[i].points[p];
            axis_include(x, point->x);
            axis_include(y, point->low);
            axis_include(y, point->high);
        }
    }
    axis_include(y, chart->level);
    axis_finish(x);
    axis_finish(y);
}

void chart_write(FILE *stream, const Chart *chart)
{
    Axis x, y;
    axes_fit(chart, &x, &y);
    fprintf(stream, "<svg class=\"chart\" viewBox=\"0 0 %g %g\" role=\"img\" aria-label=\"", WIDTH, HEIGHT);
    html_text(stream, chart->title);
    fprintf(stream, "\">\n<text class=\"title\" x=\"%g\" y=\"18\">", LEFT);
    html_text(stream, chart->title);
    fputs("</text>\n", stream);
    grid_write(stream, &x, &y);
    fprintf(stream, "<rect class=\"frame\" x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\"/>\n", x.from, y.to,
            x.to - x.from, y.from - y.to);
    if (chart->level > 0.0) {
        double at = place(&y, chart->level);
        fprintf(stream,
                "<line class=\"level\" x1=\"%g\" y1=\"%.1f\" x2=\"%g\" y2=\"%.1f\"/><text class=\"tick\" x=\"%g\" "
                "y=\"%.1f\">",
                x.from, at, x.to, at, x.from + 6.0, at - 5.0);
        html_text(stream, chart->level_label);
        fputs("</text>\n", stream);
    }
    for (int i = 0; i < chart->count; ++i)
        line_write(stream, &chart->lines[i], &x, &y);
    labels_write(stream, chart, &x, &y);
    fprintf(stream, "<text class=\"label\" x=\"%g\" y=\"%g\" text-anchor=\"middle\">", 0.5 * (x.from + x.to),
            HEIGHT - 10.0);
    html_text(stream, chart->x_label);
    fprintf(stream, "</text><text class=\"label\" transform=\"translate(14 %g) rotate(-90)\" text-anchor=\"middle\">",
            0.5 * (y.from + y.to));
    html_text(stream, chart->y_label);
    fputs("</text></svg>\n", stream);
}
