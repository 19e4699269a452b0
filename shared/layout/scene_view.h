/* Typed pointers into the scene's buffers. On a device a SceneView lives in private memory and is made at the start of
 * every kernel; pointers that a kernel does not use cost nothing there. */
#ifndef TWINLIGHT_LAYOUT_SCENE_VIEW_H
#define TWINLIGHT_LAYOUT_SCENE_VIEW_H

#include "layout/frame_params.h"

typedef struct SceneView {
    __global const FrameParams *frame;
    __global const Guide *guide; /* NULL in kernels without one */
    __global const uint *photons; /* BUFFER_PHOTONS; NULL in kernels without them */
    ulong features;
    /* geometry */
    __global const Vec3 *positions;
    __global const Vec3 *normals;
    __global const Vec2 *uvs;
    __global const Primitive *primitives;
    __global const Shape *shapes;
    __global const Patch *patches;
    __global const Quadric *quadrics;
    __global const Curve *curves;
    __global const Object *objects;
    __global const Instance *instances;
    /* tables */
    __global const Material *materials;
    __global const TextureOp *texture_ops;
    __global const TextureImage *images;
    __global const Light *lights;
    __global const LightDetail *light_details;
    __global const AliasBucket *light_alias;
    __global const LightTree *light_tree; /* one */
    __global const LightNode *light_nodes;
    __global const uint *light_leaves; /* the lights in the order of leaves */
    __global const uint *infinite_lights;
    __global const Portal *portals;
    __global const Aim *aims;
    __global const Distribution2D *distributions2d;
    __global const float *lookup;
    __global const Medium *media;
    __global const MediumGrid *grids;
    __global const uint *texels;
} SceneView;

/* A device program is built with the scene's feature mask as a constant. C reads it at run time, of the features that
 * FEATURES_KNOWN has: a translation unit may be compiled for scenes without the others. */
#ifndef FEATURES_KNOWN
#define FEATURES_KNOWN (~(ulong)0)
#endif
#ifdef TWINLIGHT_FEATURES
#define SCENE_HAS(scene, feature) ((void)(scene), (TWINLIGHT_FEATURES & (feature)) != 0u)
#else
#define SCENE_HAS(scene, feature) (((scene)->features & FEATURES_KNOWN & (feature)) != 0u)
#endif

/* The floats of `tables`: distributions, filters, coats. */
SHARED_FUNCTION __global const float *scene_lookup(const __global FrameParams *frame, __global const uint *tables)
{
    return (__global const float *)(tables + frame->scene.layout.lookup);
}

SHARED_FUNCTION SceneView scene_view(__global const FrameParams *frame, __global const uint *geometry,
                                     __global const uint *tables, __global const uint *texels)
{
    __global const SceneLayout *layout = &frame->scene.layout;
    SceneView view;
    view.frame = frame;
    view.guide = 0;
    view.photons = 0;
    view.features = frame_features(frame);
    view.positions = (__global const Vec3 *)(geometry + layout->positions);
    view.normals = (__global const Vec3 *)(geometry + layout->normals);
    view.uvs = (__global const Vec2 *)(geometry + layout->uvs);
    view.primitives = (__global const Primitive *)(geometry + layout->primitives);
    view.shapes = (__global const Shape *)(geometry + layout->shapes);
    view.patches = (__global const Patch *)(geometry + layout->patches);
    view.quadrics = (__global const Quadric *)(geometry + layout->quadrics);
    view.curves = (__global const Curve *)(geometry + layout->curves);
    view.objects = (__global const Object *)(geometry + layout->objects);
    view.instances = (__global const Instance *)(geometry + layout->instances);
    view.materials = (__global const Material *)(tables + layout->materials);
    view.texture_ops = (__global const TextureOp *)(tables + layout->texture_ops);
    view.images = (__global const TextureImage *)(tables + layout->images);
    view.lights = (__global const Light *)(tables + layout->lights);
    view.light_details = (__global const LightDetail *)(tables + layout->light_details);
    view.light_alias = (__global const AliasBucket *)(tables + layout->light_alias);
    view.light_tree = (__global const LightTree *)(tables + layout->light_tree);
    view.light_nodes = (__global const LightNode *)(tables + layout->light_nodes);
    view.light_leaves = tables + layout->light_leaves;
    view.infinite_lights = (__global const uint *)(tables + layout->infinite_lights);
    view.portals = (__global const Portal *)(tables + layout->portals);
    view.aims = (__global const Aim *)(tables + layout->aims);
    view.distributions2d = (__global const Distribution2D *)(tables + layout->distributions2d);
    view.lookup = scene_lookup(frame, tables);
    view.media = (__global const Medium *)(tables + layout->media);
    view.grids = (__global const MediumGrid *)(tables + layout->grids);
    view.texels = texels;
    return view;
}

/* LIGHT_*. */
SHARED_FUNCTION uint light_kind(__global const Light *light)
{
    return light->flags & LIGHT_KIND_MASK;
}

/* Number of leaves before it in the tree of lights; LIGHTS_MAX: it has no power. */
SHARED_FUNCTION uint light_leaf(__global const Light *light)
{
    return light->flags >> LIGHT_LEAF_SHIFT;
}

/* Of a light that is no area light. */
SHARED_FUNCTION __global const LightDetail *light_detail(const SceneView *scene, __global const Light *light)
{
    return scene->light_details + light->primitive;
}

/* Goes at the start of a kernel: declares `scene`, a pointer to its view. The loops of the CPU backend define it
 * beforehand, to make one view for all items (backend_cpu/kernel_loop.h). */
#ifndef KERNEL_SCENE
#define KERNEL_SCENE(frame, geometry, tables, texels)                                                                  \
    SceneView scene_made = scene_view(frame, geometry, tables, texels);                                                \
    const SceneView *scene = &scene_made
#define KERNEL_SCENE_GUIDED(frame, guided_by, geometry, tables, texels)                                                \
    SceneView scene_made = scene_view(frame, geometry, tables, texels);                                                \
    scene_made.guide = guided_by;                                                                                      \
    const SceneView *scene = &scene_made
#define KERNEL_SCENE_PHOTONS(frame, guided_by, photon_map, geometry, tables, texels)                                   \
    SceneView scene_made = scene_view(frame, geometry, tables, texels);                                                \
    scene_made.guide = guided_by;                                                                                      \
    scene_made.photons = photon_map;                                                                                   \
    const SceneView *scene = &scene_made
#endif

#endif
