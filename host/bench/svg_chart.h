/* A chart with two logarithmic axes as inline SVG. Colours come from the page: classes s0 ... s7 for lines, and others
 * in bench/style.c. */
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
    char note[32]; /* follows the name */
    int style; /* colour and mark, modulo CHART_STYLES */
    bool dashed;
    int count;
    ChartPoint points[CHART_POINTS_MAX];
} ChartLine;

typedef struct Chart {
    const char *title, *x_label, *y_label;
    double level; /* y of a horizontal line; 0 or NaN: none */
    const char *level_label;
    const ChartLine *lines;
    int count;
} Chart;

/* Writes the chart. Each line has a band from low to high, whiskers, marks at the middle, and name and note at its
 * end. */
void chart_write(FILE *stream, const Chart *chart);

#endif
