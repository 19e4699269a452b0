#include "scene/aim_setup.h"

#include "scene/smooth_boxes.h"

#include <math.h>

/* Groups are divided along each axis in this many slices. */
#define SLICES 16

/* A group of boxes, first ... first + count - 1, and their best division: those whose center is below `at`. */
typedef struct Group {
    size_t first, count;
    Box box;
    int axis;
    double at;
    double gain; /* by how much the squared radii of the two parts add up to less; 0: none is worth it */
} Group;

static double box_radius2(const Box *box)
{
    double square = 0.0;
    for (int k = 0; k < 3 && !box_is_empty(box); ++k)
        square += pow(0.5 * ((double)box->high[k] - (double)box->low[k]), 2.0);
    return square;
}

static double box_middle(const Box *box, int axis)
{
    return 0.5 * ((double)box->low[axis] + (double)box->high[axis]);
}

static int slice_of(const Group *group, const Box *box, int axis)
{
    double low = (double)group->box.low[axis], width = (double)group->box.high[axis] - low;
    int slice = (int)((box_middle(box, axis) - low) / width * SLICES);
    return slice < 0 ? 0 : slice >= SLICES ? SLICES - 1 : slice;
}

/* Finds the group's best division between slices of one axis. */
static void group_try(Group *group, const Box *boxes, int axis)
{
    Box slices[SLICES], above[SLICES + 1], below = box_empty();
    double low = (double)group->box.low[axis], width = (double)group->box.high[axis] - low;
    if (!(width > 0.0))
        return;
    for (int i = 0; i < SLICES; ++i)
        slices[i] = box_empty();
    for (size_t i = group->first; i < group->first + group->count; ++i)
        box_join(&slices[slice_of(group, &boxes[i], axis)], &boxes[i]);
    above[SLICES] = box_empty();
    for (int i = SLICES; i-- > 0;) {
        above[i] = above[i + 1];
        box_join(&above[i], &slices[i]);
    }
    for (int i = 1; i < SLICES; ++i) {
        box_join(&below, &slices[i - 1]);
        double gain = box_radius2(&group->box) - box_radius2(&below) - box_radius2(&above[i]);
        if (box_is_empty(&below) || box_is_empty(&above[i]) || gain <= group->gain)
            continue;
        group->gain = gain;
        group->axis = axis;
        group->at = low + width * i / SLICES;
    }
}

static Group group_make(const Box *boxes, size_t first, size_t count)
{
    Group group = {.first = first, .count = count, .box = box_empty()};
    for (size_t i = first; i < first + count; ++i)
        box_join(&group.box, &boxes[i]);
    for (int axis = 0; axis < 3; ++axis)
        group_try(&group, boxes, axis);
    return group;
}

/* Divides the group, and puts the upper part into *upper. False if rounding leaves one of them empty. */
static bool group_divide(Group *group, Group *upper, Box *boxes)
{
    size_t first = group->first, end = first + group->count, middle = first;
    for (size_t i = first; i < end; ++i)
        if (box_middle(&boxes[i], group->axis) < group->at) {
            Box box = boxes[i];
            boxes[i] = boxes[middle];
            boxes[middle++] = box;
        }
    group->gain = 0.0;
    if (middle == first || middle == end)
        return false;
    *upper = group_make(boxes, middle, end - middle);
    *group = group_make(boxes, first, middle - first);
    return true;
}

/* The sphere around the middle of the group's box that contains all its boxes. */
static Aim group_aim(const Group *group, const Box *boxes)
{
    double square = 0.0;
    for (size_t i = group->first; i < group->first + group->count; ++i) {
        double far = 0.0;
        for (int k = 0; k < 3; ++k) {
            double middle = box_middle(&group->box, k);
            far += pow(fmax((double)boxes[i].high[k] - middle, middle - (double)boxes[i].low[k]), 2.0);
        }
        square = fmax(square, far);
    }
    return (Aim){box_center(&group->box), (float)(sqrt(square) * 1.0001)};
}

/* Groups of nearby boxes; how many. */
static size_t groups_make(Group groups[AIMS_MAX], Box *boxes, size_t box_count)
{
    size_t count = 1;
    groups[0] = group_make(boxes, 0, box_count);
    while (count < AIMS_MAX) {
        size_t best = 0;
        for (size_t i = 1; i < count; ++i)
            if (groups[i].gain > groups[best].gain)
                best = i;
        if (!(groups[best].gain > 0.0))
            break;
        count += group_divide(&groups[best], &groups[count], boxes);
    }
    return count;
}

bool aim_setup(Scene *scene, const SceneView *view, Error *error)
{
    SmoothBoxes boxes;
    Group groups[AIMS_MAX];
    scene->aims.count = 0;
    bool done = smooth_boxes_init(&boxes, scene, view, error);
    size_t count = done && boxes.count > 0 ? groups_make(groups, boxes.each, boxes.count) : 0;
    for (size_t i = 0; done && i < count; ++i) {
        Aim aim = group_aim(&groups[i], boxes.each);
        if (!(aim.radius > 0.0f && isfinite(aim.radius)))
            continue;
        Aim *out = array_grow(&scene->aims, 1, error);
        done = out != NULL;
        if (out)
            *out = aim;
    }
    smooth_boxes_destroy(&boxes);
    scene->frame.scene.aim_count = (uint)scene->aims.count;
    return done;
}
