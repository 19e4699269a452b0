/* A chart with two logarithmic axes as inline SVG. Colours are the page's: classes s0 ... s7 for lines, and others that
 * report_style.c lists. */
#ifndef TWINLIGHT_BENCH_SVG_CHART_H
#define TWINLIGHT_BENCH_SVG_CHART_H

#include <stdbool.h>
#include <stdio.h>

#define CHART_POINTS_MAX 16
#define CHART_STYLES 8

typedef struct ChartPoint {
    double x, low, middle, high; /* > 0 */
} ChartPoint;

typedef struct ChartLine {
    const char *name;
    char note[32]; /* behind the name */
    int style; /* colour and shape of the marks, modulo CHART_STYLES */
    bool dashed;
    int count;
    ChartPoint points[CHART_POINTS_MAX];
} ChartLine;

typedef struct Chart {
    const char *title, *x_label, *y_label;
    double level; /* a level of y to show across; 0 or NaN: none */
    const char *level_label;
    const ChartLine *lines;
    int count;
} Chart;

/* Every line: a band from low to high, whiskers, marks at the middle, name and note at its end. */
void chart_write(FILE *stream, const Chart *chart);

#endif
