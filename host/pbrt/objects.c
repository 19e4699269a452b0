/* ObjectBegin, ObjectEnd and ObjectInstance. */
#include "pbrt/errors.h"
#include "pbrt/readers.h"
#include "pbrt/shape_add.h"
#include "pbrt/state.h"

#include <string.h>

bool import_object_begin(PbrtImport *im, const char *name, SourcePlace name_place)
{
    if (im->open_object >= 0) {
        error_at(im->error, im->place, "ObjectBegin is inside an object definition");
        return error_fix(im->error, "close the other with ObjectEnd first; objects do not nest");
    }
    if (name_table_find(&im->objects, name) != NONE) {
        error_at(im->error, name_place, "the object \"%s\" is defined twice", name);
        return error_fix(im->error, "rename one of the two");
    }
    uint index = (uint)im->object_definitions.count;
    const char *kept = arena_text(&im->arena, name, strlen(name), im->error);
    ImportObject *object = kept ? array_grow(&im->object_definitions, 1, im->error) : NULL;
    if (!object || !scene_object_begin(im->scene, &object->object, im->error) ||
        !name_table_add(&im->objects, kept, index, im->error))
        return false;
    object->box = box_empty();
    im->open_object = (int)index;
    im->object_first_primitive = im->scene->primitives.count;
    return state_push(im, "ObjectBegin");
}

bool import_object_end(PbrtImport *im)
{
    if (!state_pop(im, "ObjectBegin", "ObjectEnd"))
        return false;
    ImportObject *object = &ARRAY_AT(&im->object_definitions, ImportObject, im->open_object);
    object->empty = im->scene->primitives.count == im->object_first_primitive;
    im->open_object = -1;
    return scene_object_end(im->scene, im->error);
}

bool import_object_instance(PbrtImport *im, const char *name, SourcePlace name_place)
{
    Matrix ctm, inverse;
    if (im->open_object >= 0) {
        error_at(im->error, im->place, "ObjectInstance is inside an object definition");
        return error_fix(im->error, "place instances after ObjectEnd; objects do not nest");
    }
    uint index = name_table_find(&im->objects, name);
    if (index == NONE) {
        char known[400];
        name_table_list(&im->objects, known, sizeof known);
        errors_missing(im);
        error_at(im->error, name_place, "unknown object \"%s\"", name);
        return error_fix(im->error, "define it before this line; defined so far: %s", known);
    }
    if (!import_ctm_inverse(im, im->place, false, &ctm, &inverse))
        return false;
    const ImportObject *object = &ARRAY_AT(&im->object_definitions, ImportObject, index);
    for (const EmissiveShape *shape = object->emissive; shape; shape = shape->next)
        if (!emissive_shape_add(im, shape, &ctm))
            return false;
    if (!box_is_empty(&object->box)) {
        Box placed = box_transform(&object->box, matrix_affine(ctm.m));
        box_join(&im->world, &placed);
    }
    return object->empty || scene_add_instance(im->scene, object->object, ctm.m, inverse.m, im->error);
}
