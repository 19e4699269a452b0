/* The density with which light subpaths start should be in proportion to what they bring. Of densities that are
 * constant in the areas a[i] of groups of rays that bring parts p[i] of the light, the likeliest given the rays is
 * p[i] / a[i], with the log-likelihood sum p[i] log(p[i] / a[i]). So the search is for rectangles, in planes
 * perpendicular to an axis, by which that grows most: at first all rays are in a group whose area is that of the
 * disc, and then, time and again, the best rectangle for a part of any group makes a group of its own. */
#include "render/opening_fit.h"

#include <math.h>
#include <stdlib.h>

/* Groups at a time; by how much the log-likelihood per ray must grow by a rectangle, and by how much by all. */
#define GROUPS_MAX 16
#define GAIN_MIN 0.05
#define GAIN_ALL_MIN 1.0

/* How often the rectangles are chosen anew. */
#define RENEWALS 2

/* At least this part of the rays are as without openings, for light that no ray of the sample brought. */
#define REST_MIN 0.15

/* An opening has an outer side if no more than this part of its light comes from the other. */
#define INNER_MAX 0.02

typedef struct Fit {
    RaySample sample;
    RayGroup groups[GROUPS_MAX]; /* the first has the rays that no rectangle has */
    size_t group_count;
} Fit;

/* Makes the rays that cross the best rectangle of group `from` those of group `to`. */
static void group_divide(Fit *fit, size_t from, size_t to)
{
    Rectangle rectangle = fit->groups[from].next;
    double weight = 0.0, projected = 0.0;
    for (size_t i = 0; i < fit->sample.count; ++i) {
        double place[2];
        FarRay *ray = &fit->sample.rays[i];
        if (!ray_group_crosses(&fit->groups[from], ray, &rectangle, place))
            continue;
        weight += (double)ray->weight;
        projected += (double)ray->weight * fabs(vec3_along(ray->direction, rectangle.axis));
        ray->group = (uint)to;
    }
    double area = (rectangle.high[0] - rectangle.low[0]) * (rectangle.high[1] - rectangle.low[1]);
    fit->groups[to] = (RayGroup){.number = (uint)to, .area = area * (projected / weight), .rectangle = rectangle};
    group_search(&fit->sample, &fit->groups[from]);
    group_search(&fit->sample, &fit->groups[to]);
}

/* Whether the group's best rectangle is worth having. */
static bool group_divides(const Fit *fit, const RayGroup *group)
{
    return group->weight * group->next.gain > GAIN_MIN * fit->sample.weight;
}

/* Divides the groups, at first one, while the likelihood grows enough. */
static void groups_divide(Fit *fit)
{
    while (fit->group_count < GROUPS_MAX) {
        size_t best = 0;
        for (size_t i = 1; i < fit->group_count; ++i)
            if (fit->groups[i].weight * fit->groups[i].next.gain >
                fit->groups[best].weight * fit->groups[best].next.gain)
                best = i;
        if (!group_divides(fit, &fit->groups[best]))
            break;
        group_divide(fit, best, fit->group_count++);
    }
}

/* Gives the group's rays to the first group. */
static void group_dissolve(Fit *fit, size_t group)
{
    for (size_t i = 0; i < fit->sample.count; ++i)
        if (fit->sample.rays[i].group == group)
            fit->sample.rays[i].group = 0;
}

/* Chooses every rectangle anew for its rays and those that are left, now that the others are known. */
static void groups_renew(Fit *fit)
{
    for (size_t i = 1; i < fit->group_count; ++i) {
        group_dissolve(fit, i);
        fit->groups[i].weight = 0.0;
        group_search(&fit->sample, &fit->groups[0]);
        if (group_divides(fit, &fit->groups[0]))
            group_divide(fit, 0, i);
    }
}

/* The log-likelihood of the group's rays, times their weight, as a group or, instead, in an area that brings
 * `weight`. */
static double group_likelihood(const RayGroup *group, double weight, double area)
{
    return group->weight > 0.0 ? group->weight * log(weight / area) : 0.0;
}

/* By how much that is larger than without the group. */
static double group_worth(const RayGroup *group, const RayGroup *disc)
{
    return group_likelihood(group, group->weight, group->area) -
           group_likelihood(group, group->weight + disc->weight, disc->area);
}

/* Dissolves the groups of rectangles that are not worth having, until at most `most` are left besides the first
 * group. */
static void groups_prune(Fit *fit, size_t most)
{
    RayGroup *groups = fit->groups;
    while (fit->group_count > 1) {
        size_t least = 1, last = fit->group_count - 1;
        for (size_t i = 2; i <= last; ++i)
            if (group_worth(&groups[i], &groups[0]) < group_worth(&groups[least], &groups[0]))
                least = i;
        if (last <= most && group_worth(&groups[least], &groups[0]) > GAIN_MIN * fit->sample.weight)
            break;
        group_dissolve(fit, least);
        groups[0].weight += groups[least].weight;
        for (size_t i = 0; i < fit->sample.count; ++i)
            if (fit->sample.rays[i].group == last)
                fit->sample.rays[i].group = (uint)least;
        groups[least] = groups[last];
        groups[least].number = (uint)least;
        --fit->group_count;
    }
}

/* ---- the result -------------------------------------------------------------------------------------------------- */

static float side_of(const Fit *fit, const RayGroup *group)
{
    double above = 0.0;
    for (size_t i = 0; i < fit->sample.count; ++i)
        if (fit->sample.rays[i].group == group->number &&
            vec3_along(fit->sample.rays[i].direction, group->rectangle.axis) > 0.0)
            above += (double)fit->sample.rays[i].weight;
    return above < INNER_MAX * group->weight ? -1.0f : above > (1.0 - INNER_MAX) * group->weight ? 1.0f : 0.0f;
}

/* By how much the log-likelihood per ray has grown. */
static double fit_gain(const Fit *fit)
{
    double gain = 0.0;
    for (size_t i = 0; i < fit->group_count; ++i)
        gain += group_likelihood(&fit->groups[i], fit->groups[i].weight, fit->groups[i].area) -
                group_likelihood(&fit->groups[i], fit->sample.weight, fit->groups[0].area);
    return gain / fit->sample.weight;
}

static Opening group_opening(const Fit *fit, const RayGroup *group, double share)
{
    const Rectangle *rectangle = &group->rectangle;
    return (Opening){.axis = (uint)rectangle->axis,
                     .at = (float)rectangle->at,
                     .u_low = (float)rectangle->low[0],
                     .v_low = (float)rectangle->low[1],
                     .u_high = (float)rectangle->high[0],
                     .v_high = (float)rectangle->high[1],
                     .side = side_of(fit, group),
                     .share = (float)share};
}

bool openings_fit(FarRay *rays, size_t ray_count, float radius, Opening *openings, size_t capacity, size_t *count,
                  Error *error)
{
    Fit fit = {.sample = {rays, ray_count, 0.0, malloc((ray_count + 1) * sizeof(double))},
               .groups = {{.area = M_PI * (double)radius * (double)radius}},
               .group_count = 1};
    *count = 0;
    if (!fit.sample.values)
        return error_memory(error, (ray_count + 1) * sizeof *fit.sample.values, "openings");
    for (size_t i = 0; i < ray_count; ++i) {
        rays[i].group = 0;
        fit.sample.weight += (double)rays[i].weight;
    }
    group_search(&fit.sample, &fit.groups[0]);
    groups_divide(&fit);
    for (int i = 0; i < RENEWALS; ++i)
        groups_renew(&fit);
    groups_prune(&fit, capacity);
    free(fit.sample.values);
    if (!(fit.sample.weight > 0.0 && fit_gain(&fit) > GAIN_ALL_MIN))
        return true;
    double left = fit.groups[0].weight / fit.sample.weight, part = (1.0 - fmax(REST_MIN, left)) / (1.0 - left);
    for (size_t i = 1; i < fit.group_count; ++i)
        openings[(*count)++] = group_opening(&fit, &fit.groups[i], part * fit.groups[i].weight / fit.sample.weight);
    return true;
}
