/* Portals: rectangles through which alone an infinite light is seen, as a window does for a room (Bitterli, Novak and
 * Jarosz, "Portal-masked environment map sampling", 2015; pbrt-v4's portals).
 *
 * Directions on the far side of the portal are rectified: uv are the angles of their projections to the planes (t, n)
 * and (b, n) of the portal's axes, over pi. Seen from any point, the portal is then a rectangle along u and v, the
 * window. The host tabulates the environment's light over uv (host/scene/portal_setup.h); sums over all cells with
 * smaller indices give the light of any window, and the light of part of one, by which a point in it is drawn. Sums are
 * integers, so that differences are exact. */
#ifndef TWINLIGHT_LIGHT_PORTAL_H
#define TWINLIGHT_LIGHT_PORTAL_H

#include "layout/distribution.h"
#include "layout/scene_view.h"
#include "math/elementary.h"

/* ---- geometry ---------------------------------------------------------------------------------------------------- */

/* Whether the line through p along d crosses the portal, if d points to the side that the light comes from. */
SHARED_FUNCTION_APART bool portal_crossed(const Portal *portal, Vec3 p, Vec3 d)
{
    Vec3 w = frame_to_local(portal->axes, d), corner = frame_to_local(portal->axes, vec3_sub(portal->corner, p));
    float x = corner.z * w.x - corner.x * w.z, y = corner.z * w.y - corner.y * w.z;
    return w.z > 0.0f && x >= 0.0f && x <= portal->width * w.z && y >= 0.0f && y <= portal->height * w.z;
}

/* Whether p is on the side of the portal that is lit. */
SHARED_FUNCTION bool portal_lights(const Portal *portal, Vec3 p)
{
    return vec3_dot(portal->axes.n, vec3_sub(portal->corner, p)) > 0.0f;
}

/* Density, per area perpendicular to d, of lines along d through a uniform point of the portal. d: as in
 * portal_crossed. */
SHARED_FUNCTION float portal_pdf_p(const Portal *portal, Vec3 d)
{
    return 1.0f / (portal->width * portal->height * vec3_dot(portal->axes.n, d));
}

SHARED_FUNCTION float portal_angle(float across, float ahead)
{
    return float_clamp(float_atan2(across, ahead) * INV_PI + 0.5f, 0.0f, 1.0f);
}

/* Solid angle per area of the square at the unit direction w, in the portal's axes, w.z > 0. */
SHARED_FUNCTION float portal_stretch(Vec3 w)
{
    float z2 = w.z * w.z;
    return PI * PI * ((w.x * w.x + z2) * (w.y * w.y + z2)) / w.z;
}

/* The point of the square of the unit direction d; false if d points to the lit side. *stretch: portal_stretch. */
SHARED_FUNCTION_APART bool portal_uv(const Portal *portal, Vec3 d, Vec2 *uv, float *stretch)
{
    Vec3 w = frame_to_local(portal->axes, d);
    if (!(w.z > 0.0f))
        return false;
    *uv = vec2(portal_angle(w.x, w.z), portal_angle(w.y, w.z));
    *stretch = portal_stretch(w);
    return true;
}

/* The unit direction of a point of the square. *stretch: portal_stretch. */
SHARED_FUNCTION Vec3 portal_direction(const Portal *portal, Vec2 uv, float *stretch)
{
    float sin_u, cos_u, sin_v, cos_v;
    float_sincos(PI * (uv.x - 0.5f), &sin_u, &cos_u);
    float_sincos(PI * (uv.y - 0.5f), &sin_v, &cos_v);
    Vec3 w = vec3_normalize(vec3(sin_u * cos_v, cos_u * sin_v, cos_u * cos_v));
    *stretch = portal_stretch(w);
    return frame_to_world(portal->axes, w);
}

/* ---- windows ----------------------------------------------------------------------------------------------------- */

/* A part of an axis of the square, in cells: from `low` in cell `first` to cell `last`; head and tail: how much of
 * these two. If they are one cell, its part is `head`. */
typedef struct PortalSpan {
    uint first, last;
    float low, head, tail;
} PortalSpan;

typedef struct PortalWindow {
    PortalSpan u, v;
} PortalWindow;

SHARED_FUNCTION PortalSpan portal_span(float low, float high, uint count)
{
    PortalSpan span;
    span.first = distribution_cell_of(low, count);
    span.last = distribution_cell_of(high, count);
    span.low = low * (float)count;
    bool one = span.first == span.last;
    span.head = float_max((one ? high * (float)count : (float)(span.first + 1u)) - span.low, 0.0f);
    span.tail = one ? 0.0f : high * (float)count - (float)span.last;
    return span;
}

/* All of one cell. */
SHARED_FUNCTION PortalSpan portal_span_cell(uint cell)
{
    PortalSpan span;
    span.first = cell;
    span.last = cell;
    span.low = (float)cell;
    span.head = 1.0f;
    span.tail = 0.0f;
    return span;
}

/* The window of the portal as seen from p; false if it is not seen. */
SHARED_FUNCTION bool portal_window(const Portal *portal, Vec3 p, PortalWindow *window)
{
    Vec3 corner = frame_to_local(portal->axes, vec3_sub(portal->corner, p));
    if (!(corner.z > 0.0f))
        return false;
    window->u = portal_span(portal_angle(corner.x, corner.z), portal_angle(corner.x + portal->width, corner.z),
                            portal->columns);
    window->v =
        portal_span(portal_angle(corner.y, corner.z), portal_angle(corner.y + portal->height, corner.z), portal->rows);
    return true;
}

/* Light of the cells x0 <= x < x1, y0 <= y < y1. */
SHARED_FUNCTION float portal_cells(const SceneView *scene, const Portal *portal, uint x0, uint x1, uint y0, uint y1)
{
    __global const uint *sums = scene->texels + portal->sums;
    uint width = portal->columns + 1u;
    return (float)((sums[y1 * width + x1] - sums[y1 * width + x0]) - (sums[y0 * width + x1] - sums[y0 * width + x0]));
}

/* Light of the cells from <= i < to along an axis (0: u, 1: v) within `across` of the other. */
SHARED_FUNCTION float portal_strip(const SceneView *scene, const Portal *portal, uint axis, uint from, uint to,
                                   PortalSpan across)
{
    float sum = 0.0f;
    for (uint part = 0u; part < 3u; ++part) {
        uint first = part == 0u ? across.first : part == 1u ? across.first + 1u : across.last;
        uint end = part == 0u ? first + 1u : part == 1u ? across.last : across.last + 1u;
        float share = part == 0u ? across.head : part == 1u ? 1.0f : across.tail;
        if (first >= end || !(share > 0.0f) || (part > 0u && across.first == across.last))
            continue;
        sum += share * (axis == 0u ? portal_cells(scene, portal, from, to, first, end)
                                   : portal_cells(scene, portal, first, end, from, to));
    }
    return sum;
}

/* The part of a cell of the span. */
SHARED_FUNCTION float portal_span_share(PortalSpan span, uint cell)
{
    return cell == span.first ? span.head : cell == span.last ? span.tail : 1.0f;
}

/* Light within the span, up to and with `cell`. */
SHARED_FUNCTION float portal_sum(const SceneView *scene, const Portal *portal, uint axis, PortalSpan along,
                                 PortalSpan across, uint cell)
{
    float sum = along.head * portal_strip(scene, portal, axis, along.first, along.first + 1u, across);
    if (cell == along.first)
        return sum;
    bool ends = cell == along.last;
    uint end = ends ? cell : cell + 1u;
    if (end > along.first + 1u)
        sum += portal_strip(scene, portal, axis, along.first + 1u, end, across);
    return ends ? sum + along.tail * portal_strip(scene, portal, axis, cell, cell + 1u, across) : sum;
}

/* Draws a place in `along` in proportion to the light there, in cells. *cell: its cell. */
SHARED_FUNCTION float portal_draw(const SceneView *scene, const Portal *portal, uint axis, PortalSpan along,
                                  PortalSpan across, float u, uint *cell)
{
    float target = u * portal_sum(scene, portal, axis, along, across, along.last);
    uint low = along.first, high = along.last;
    while (low < high) {
        uint middle = (low + high) >> 1;
        if (portal_sum(scene, portal, axis, along, across, middle) > target)
            high = middle;
        else
            low = middle + 1u;
    }
    *cell = low;
    float share = portal_span_share(along, low);
    float own = share * portal_strip(scene, portal, axis, low, low + 1u, across);
    float before = low > along.first ? portal_sum(scene, portal, axis, along, across, low - 1u) : 0.0f;
    float fraction = own > 0.0f ? float_clamp((target - before) / own, 0.0f, 0.99999994f) : 0.0f;
    return (low == along.first ? along.low : (float)low) + fraction * share;
}

/* Density over the square of the points that portal_sample draws, in one of the window's cells. */
SHARED_FUNCTION float portal_cell_pdf(const SceneView *scene, const Portal *portal, const PortalWindow *window, uint x,
                                      uint y)
{
    float all = portal_sum(scene, portal, 0u, window->u, window->v, window->u.last);
    float own = portal_cells(scene, portal, x, x + 1u, y, y + 1u);
    return all > 0.0f ? own / all * ((float)portal->columns * (float)portal->rows) : 0.0f;
}

/* Draws a point of the window in proportion to the light there; *pdf: its density over the square. */
SHARED_FUNCTION Vec2 portal_sample(const SceneView *scene, const Portal *portal, const PortalWindow *window, Vec2 u,
                                   float *pdf)
{
    uint x, y;
    float across = portal_draw(scene, portal, 0u, window->u, window->v, u.x, &x);
    float along = portal_draw(scene, portal, 1u, window->v, portal_span_cell(x), u.y, &y);
    *pdf = portal_cell_pdf(scene, portal, window, x, y);
    return vec2(across / (float)portal->columns, along / (float)portal->rows);
}

/* Density per solid angle with which portal_sample draws the direction d (unit) for p; 0 if d does not pass the
 * portal. */
SHARED_FUNCTION_APART float portal_pdf_w(const SceneView *scene, const Portal *portal, Vec3 p, Vec3 d)
{
    PortalWindow window;
    Vec2 uv;
    float stretch;
    if (!portal_crossed(portal, p, d) || !portal_window(portal, p, &window) || !portal_uv(portal, d, &uv, &stretch))
        return 0.0f;
    return portal_cell_pdf(scene, portal, &window, distribution_cell_of(uv.x, portal->columns),
                           distribution_cell_of(uv.y, portal->rows)) /
           stretch;
}

#endif
