/* Warnings about a finished picture. */
#ifndef TWINLIGHT_RENDER_REPORT_H
#define TWINLIGHT_RENDER_REPORT_H

#include "render/render.h"

/* Logs a warning for every kind of problem. scale: factor on every pixel of the film. */
void render_report(const RenderResult *result, const Film *film, float scale);

#endif
