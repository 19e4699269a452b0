/* The plain-data structs that host and device share. Every member is a 4-byte uint, int or float (or a struct of them),
 * so the layouts of C and OpenCL C are the same; tests compare the sizes.
 *
 * A scene reaches the kernels as four buffers: the frame's parameters, `geometry`, `tables` and `texels`. The last
 * three are arrays of 32-bit words into which the host packed the arrays named in SceneLayout; layout/scene_view.h
 * turns them back into typed pointers. */
#ifndef TWINLIGHT_LAYOUT_SCENE_TYPES_H
#define TWINLIGHT_LAYOUT_SCENE_TYPES_H

#include "layout/material_list.h"
#include "math/vec.h"

/* ---- what a scene uses: the feature mask ---------------------------------------------------------------------- */

/* Features, at most 64: X(NAME, name, text, 0u). Between the two lists come the BSDFs, whose bits are in the order of
 * their kinds. */
#define FEATURE_LIST_BEFORE(X)                                                                                         \
    X(TRIANGLE, triangle, "triangle", 0u)                                                                              \
    X(BILINEAR, bilinear, "bilinear", 0u)                                                                              \
    X(SPHERE, sphere, "sphere", 0u)                                                                                    \
    X(DISK, disk, "disk", 0u)                                                                                          \
    X(CYLINDER, cylinder, "cylinder", 0u)                                                                              \
    X(CURVE, curve, "curve", 0u)                                                                                       \
    X(INSTANCE, instance, "instance", 0u)                                                                              \
    X(ALPHA, alpha, "alpha", 0u) /* alpha-textured shapes */                                                           \
    X(NORMALS, normals, "normals", 0u) /* per-vertex normals */                                                        \
    X(TEXTURE, texture, "texture", 0u) /* any parameter that is not constant */                                        \
    X(BUMP, bump, "bump", 0u) /* normal maps or displacement */                                                        \
    X(MIX, mix, "mix", 0u) /* mix materials */
#define FEATURE_LIST_AFTER(X)                                                                                          \
    X(PROCEDURAL, procedural, "procedural texture", 0u) /* TEXTURE_FBM and those after it */                           \
    X(ROUGH, rough, "rough", 0u) /* a microfacet lobe that is not a delta */                                           \
    X(AREA_LIGHT, area_light, "area light", 0u)                                                                        \
    X(INFINITE_LIGHT, infinite_light, "infinite light", 0u)                                                            \
    X(PORTAL, portal, "portal", 0u) /* an infinite light that is seen through a portal */                              \
    X(DELTA_LIGHT, delta_light, "delta light", 0u) /* those of LIGHT_LIST_DELTA */                                     \
    X(LIGHT_TREE, light_tree, "several lights", 0u) /* in different places or directions */                            \
    X(LENS, lens, "lens", 0u) /* a camera with a lens of non-zero radius */                                            \
    X(TANGENTS, tangents, "tangents", 0u) /* dpdu and dpdv matter: bump, normal maps, anisotropic roughness */         \
    X(MEDIUM, medium, "medium", 0u) /* participating media */                                                          \
    X(SCATTERING, scattering, "scattering medium", 0u)                                                                 \
    X(MEDIUM_EMISSION, medium_emission, "emissive medium", 0u)                                                         \
    X(MEDIUM_GRID, medium_grid, "medium of a grid", 0u)                                                                \
    X(INTENSITY_IMAGE, intensity_image, "image of a light's intensity", 0u) /* goniometric, projection */              \
    X(SPHERICAL_CAMERA, spherical_camera, "spherical camera", 0u)
#define FEATURE_LIST(X) FEATURE_LIST_BEFORE(X) BSDF_LIST(X) FEATURE_LIST_AFTER(X)

#define FEATURE_NUMBER(NAME, name, text, traits) FEATURE_NUMBER_##NAME,
enum { FEATURE_LIST(FEATURE_NUMBER) FEATURE_COUNT };
#undef FEATURE_NUMBER
/* Macros, because constants of an enum are ints. Names are only for features that code asks for one by one. */
#define FEATURE_BIT(NAME) ((ulong)1 << FEATURE_NUMBER_##NAME)
#define FEATURE_TRIANGLE FEATURE_BIT(TRIANGLE)
#define FEATURE_BILINEAR FEATURE_BIT(BILINEAR)
#define FEATURE_SPHERE FEATURE_BIT(SPHERE)
#define FEATURE_DISK FEATURE_BIT(DISK)
#define FEATURE_CYLINDER FEATURE_BIT(CYLINDER)
#define FEATURE_CURVE FEATURE_BIT(CURVE)
#define FEATURE_INSTANCE FEATURE_BIT(INSTANCE)
#define FEATURE_ALPHA FEATURE_BIT(ALPHA)
#define FEATURE_NORMALS FEATURE_BIT(NORMALS)
#define FEATURE_TEXTURE FEATURE_BIT(TEXTURE)
#define FEATURE_BUMP FEATURE_BIT(BUMP)
#define FEATURE_MIX FEATURE_BIT(MIX)
#define FEATURE_DIFFUSE FEATURE_BIT(DIFFUSE)
#define FEATURE_CONDUCTOR FEATURE_BIT(CONDUCTOR)
#define FEATURE_DIELECTRIC FEATURE_BIT(DIELECTRIC)
#define FEATURE_THIN_DIELECTRIC FEATURE_BIT(THIN_DIELECTRIC)
#define FEATURE_COATED_DIFFUSE FEATURE_BIT(COATED_DIFFUSE)
#define FEATURE_COATED_CONDUCTOR FEATURE_BIT(COATED_CONDUCTOR)
#define FEATURE_DIFFUSE_TRANSMISSION FEATURE_BIT(DIFFUSE_TRANSMISSION)
#define FEATURE_HAIR FEATURE_BIT(HAIR)
#define FEATURE_PROCEDURAL FEATURE_BIT(PROCEDURAL)
#define FEATURE_ROUGH FEATURE_BIT(ROUGH)
#define FEATURE_AREA_LIGHT FEATURE_BIT(AREA_LIGHT)
#define FEATURE_INFINITE_LIGHT FEATURE_BIT(INFINITE_LIGHT)
#define FEATURE_PORTAL FEATURE_BIT(PORTAL)
#define FEATURE_DELTA_LIGHT FEATURE_BIT(DELTA_LIGHT)
#define FEATURE_LIGHT_TREE FEATURE_BIT(LIGHT_TREE)
#define FEATURE_LENS FEATURE_BIT(LENS)
#define FEATURE_TANGENTS FEATURE_BIT(TANGENTS)
#define FEATURE_MEDIUM FEATURE_BIT(MEDIUM)
#define FEATURE_SCATTERING FEATURE_BIT(SCATTERING)
#define FEATURE_MEDIUM_EMISSION FEATURE_BIT(MEDIUM_EMISSION)
#define FEATURE_MEDIUM_GRID FEATURE_BIT(MEDIUM_GRID)
#define FEATURE_INTENSITY_IMAGE FEATURE_BIT(INTENSITY_IMAGE)
#define FEATURE_SPHERICAL_CAMERA FEATURE_BIT(SPHERICAL_CAMERA)

/* All but those that few scenes have: the CPU's kernels are also compiled for scenes that have no others. */
#define FEATURES_PLAIN                                                                                                 \
    (~(FEATURE_CYLINDER | FEATURE_COATED_CONDUCTOR | FEATURE_PROCEDURAL | FEATURE_PORTAL | FEATURE_MEDIUM |            \
       FEATURE_SCATTERING | FEATURE_MEDIUM_EMISSION | FEATURE_MEDIUM_GRID | FEATURE_INTENSITY_IMAGE |                  \
       FEATURE_SPHERICAL_CAMERA | FEATURE_CURVE | FEATURE_HAIR))
#define FEATURES_QUADRIC (FEATURE_SPHERE | FEATURE_DISK | FEATURE_CYLINDER)

/* ---- geometry -------------------------------------------------------------------------------------------------- */

#define PRIMITIVE_TRIANGLE 0u /* a, b, c: vertices */
#define PRIMITIVE_BILINEAR 1u /* a: index into `patches`, four vertices p00 p10 p01 p11 as in pbrt */
#define PRIMITIVE_SPHERE 2u /* a: index into `quadrics` */
#define PRIMITIVE_DISK 3u /* a: index into `quadrics` */
#define PRIMITIVE_CYLINDER 4u /* a: index into `quadrics` */
#define PRIMITIVE_CURVE 5u /* a: index into `curves`; b: its piece, as CURVE_PIECE; c: CURVE_FLAT or CURVE_ROUND */
#define PRIMITIVE_KINDS 6

#define PRIMITIVE_IS_QUADRIC(kind) ((kind) >= PRIMITIVE_SPHERE && (kind) <= PRIMITIVE_CYLINDER)

/* `shape_and_kind`: bits 0-27 the index into `shapes`, bit 28 set when the shape has an alpha texture, bits 29-31 the
 * kind. Kept in the primitive so that the intersection test of an opaque triangle reads no Shape. */
typedef struct Primitive {
    uint a, b, c;
    uint shape_and_kind;
} Primitive;

#define PRIMITIVE_SHAPE_MASK 0x0fffffffu
#define PRIMITIVE_ALPHA_BIT 0x10000000u
#define PRIMITIVE_KIND_SHIFT 29

/* Shape flags. */
/* ReverseOrientation xor a transform that swaps handedness: the geometric normal is negated. For quadrics and meshes
 * without vertex normals; see geometry/surface.h for the others. */
#define SHAPE_FLIP_NORMAL 0x1u
#define SHAPE_REVERSE 0x2u /* ReverseOrientation alone */
#define SHAPE_HAS_NORMALS 0x4u
#define SHAPE_HAS_UV 0x8u
#define SHAPE_INTERFACE 0x10u /* no material: rays pass, and only their medium changes */
/* The other bits: the media inside and outside, as media_bits (geometry/medium.h) has them; the same number twice: the
 * surface does not separate media. */

/* What all primitives of one Shape directive share. Vertices index `positions`; the vertex normal of vertex v is
 * normals[v - first_vertex + first_normal], its texture coordinate uvs[v - first_vertex + first_uv]. */
typedef struct Shape {
    uint material; /* index into `materials`; NONE with SHAPE_INTERFACE */
    uint alpha; /* texture program of the alpha texture, NONE when opaque */
    uint first_light; /* the light of primitive i is first_light + i - first_primitive; NONE when it emits nothing */
    uint first_primitive;
    uint first_vertex;
    uint first_normal;
    uint first_uv;
    uint flags;
} Shape;

/* Four vertices of a bilinear patch: p00, p10, p01, p11 at (u,v) = (0,0), (1,0), (0,1), (1,1). */
typedef struct Patch {
    uint v[4];
} Patch;

/* A sphere, disk or cylinder in its object space, pbrt's parametrisation.
 * Sphere: radius, z_min, z_max (clipping heights, equal to -+radius when whole), phi_max in radians.
 * Disk: radius, inner_radius, z_min = height, phi_max.
 * Cylinder: radius, z_min < z_max, phi_max. */
typedef struct Quadric {
    Affine world_from_object;
    Affine object_from_world;
    float radius;
    float inner_radius;
    float z_min;
    float z_max;
    float phi_max;
    uint whole; /* 1: a full sphere under a similarity transform, so it is a sphere in world space too; not if it is a
                   light whose far side shines as well (scene_add_quadric) */
    Vec3 center; /* of a `whole` sphere, in world space */
    float world_radius; /* of a `whole` sphere */
} Quadric;

/* A cubic Bezier segment with a width that changes linearly with the parameter: 56 bytes. Seen from anywhere it is a
 * band of that width that faces the ray (geometry/curve.h). */
typedef struct Curve {
    Vec3 p[4]; /* control points */
    float width[2]; /* at parameters 0 and 1 */
} Curve;

/* A segment is divided into 2^levels primitives over equal intervals of its parameter, whose boxes are smaller. */
#define CURVE_LEVELS_MAX 6
#define CURVE_LEVELS_DEFAULT 3 /* as in pbrt-v4 */
#define CURVE_PIECE_SHIFT 8
#define CURVE_PIECE(levels, index) ((levels) | (index) << CURVE_PIECE_SHIFT)
#define CURVE_LEVELS(piece) ((piece)&0xffu)
#define CURVE_INDEX(piece) ((piece) >> CURVE_PIECE_SHIFT)

#define CURVE_FLAT 0u /* its shading normal faces the ray */
#define CURVE_ROUND 1u /* pbrt's "cylinder": the normal turns by half a turn across the width */

/* Object 0 is the world's own geometry; the others exist through instances only. */
typedef struct Object {
    uint first_primitive;
    uint primitive_count;
} Object;

typedef struct Instance {
    Affine world_from_object;
    Affine object_from_world;
    uint object;
} Instance;

/* ---- textures -------------------------------------------------------------------------------------------------- */

/* A texture expression is a program in postfix order for a stack of TEXTURE_STACK colours: no recursion, bounded
 * depth. The program of index i starts at texture_ops[i] and ends with TEXTURE_END. */
#define TEXTURE_STACK 8

#define TEXTURE_END 0u
#define TEXTURE_CONSTANT 1u /* push value */
#define TEXTURE_IMAGE 2u /* push image `index` at the mapped (u,v), times `scale` (or 1 - it when `invert`) */
#define TEXTURE_SCALE 3u /* b a -> a b */
#define TEXTURE_MIX 4u /* amount a b -> (1 - amount) a + amount b; amount is the mean of its channels */
#define TEXTURE_CHECKERBOARD 5u /* a b -> a on even squares, b on odd */
#define TEXTURE_IMAGE_FLOAT 6u /* TEXTURE_IMAGE inside a float texture: grey, the mean of RGB, or the A of RGBA */
/* Those that follow make FEATURE_PROCEDURAL (geometry/texture_procedural.h). */
#define TEXTURE_FBM 7u /* push noise of `index` octaves and roughness uv_map[0] at the point in the texture's space */
#define TEXTURE_WRINKLED 8u /* the same, of absolute values */
#define TEXTURE_WINDY 9u
#define TEXTURE_MARBLE 10u /* a colour; octaves as above, of the point times `scale`, times the variation uv_map[1] */
#define TEXTURE_DOTS 11u /* a b -> a inside of dots, b outside */
#define TEXTURE_DIRECTION_MIX 12u /* a b -> w a + (1 - w) b, w = |n . value| with the geometric normal n */
#define TEXTURE_BILERP 13u /* v00 v10 v01 v11 -> their bilinear interpolation at the mapped (u,v) */

#define WRAP_REPEAT 0u
#define WRAP_BLACK 1u
#define WRAP_CLAMP 2u
#define WRAP_OCTAHEDRAL 3u

#define MAPPING_UV 0u /* (su u + du, sv v + dv) */
#define MAPPING_PLANAR 1u /* (ds + p.vs, dt + p.vt) in the texture's space */
#define MAPPING_SPHERICAL 2u
#define MAPPING_CYLINDRICAL 3u
#define MAPPING_3D 4u /* a point of the texture's space: checkerboard of dimension 3, noise */

typedef struct TextureOp {
    uint code;
    uint index; /* image */
    uint mapping;
    uint invert;
    Vec3 value; /* constant; direction mix: a unit direction in world space */
    float scale;
    float uv_map[8]; /* UV: su sv du dv. planar: vs.xyz ds vt.xyz dt. noise: roughness, variation */
    Affine texture_from_world; /* planar, spherical, cylindrical, 3D */
} TextureOp;

#define FILTER_BILINEAR 0u
#define FILTER_POINT 1u

#define TEXEL_U8 0u /* four texels per word for one channel, else one word per texel (3 or 4 channels) */
#define TEXEL_F32 1u

/* An image of 1, 3 or 4 channels in `texels`, row 0 at v = 1 (the top), as pbrt has it. */
typedef struct TextureImage {
    uint width, height, channels;
    uint format;
    uint first_word; /* in texels */
    uint wrap;
    uint filter;
    uint lut; /* first of 256 floats in `lookup` that decode a byte; NONE for F32 */
} TextureImage;

/* A colour or number of a material: a constant, or a texture program when `program` is not NONE. */
typedef struct ColorParam {
    Vec3 value;
    uint program;
} ColorParam;

typedef struct FloatParam {
    float value;
    uint program;
} FloatParam;

/* ---- materials ------------------------------------------------------------------------------------------------- */

#define MATERIAL_REMAP_ROUGHNESS 0x1u
#define MATERIAL_CONDUCTOR_REFLECTANCE                                                                                 \
    0x2u /* also of a coated one: color0 is reflectance at normal incidence; else eta color0, k color1 */

#define MATERIAL_HAIR_COLOR 0x4u /* hair: color0 is the colour that it is to have */
#define MATERIAL_HAIR_MELANIN 0x8u /* hair: base_u and base_v are concentrations of eumelanin and pheomelanin */

/* color0: diffuse, coated diffuse, transmission: reflectance. conductor, coated or not: eta or reflectance. color1:
 * conductor: k. diffuse transmission: transmittance. coated diffuse: x the coat's optical thickness along its normal
 * (pbrt's "thickness"), y what scene_finish makes of it: the transmittance of one internal round trip (bsdf/coat.h).
 * roughness_u/v: as given in the scene, of a coat that of its interface, base_u/v that of the conductor below; alpha =
 * roughness, or pbrt's sqrt(roughness) when MATERIAL_REMAP_ROUGHNESS. hair: color0: absorption, roughness_u/v: beta_m
 * and beta_n, amount: alpha in degrees. mix: `mix_a` where the random number is >= amount, `mix_b` where it is
 * below. */
typedef struct Material {
    uint kind;
    uint flags;
    ColorParam color0;
    ColorParam color1;
    FloatParam roughness_u;
    FloatParam roughness_v;
    FloatParam amount; /* mix */
    FloatParam displacement; /* program NONE: no bump */
    FloatParam base_u; /* coated conductor */
    FloatParam base_v;
    float eta; /* dielectric, coated: relative index of refraction, inside over outside */
    float scale; /* diffuse transmission; coated conductor: optical thickness of the coat */
    uint normal_map; /* index into `images`, NONE without */
    uint mix_a, mix_b;
    uint
        coat_table; /* coated diffuse: first float in `lookup` of the coat's table (bsdf/coat.h), NONE when smooth; coated
                        conductor: of its record (bsdf/coated_conductor.h) */
} Material;

/* ---- media ----------------------------------------------------------------------------------------------------- */

/* A participating medium; coefficients per unit of length of the world, of media with a grid those where its factors
 * are 1. Number 0 is empty space. Scenes without media have no such table. */
typedef struct Medium {
    Vec3 extinction; /* sigma_t: absorption and scattering */
    Vec3 scattering; /* sigma_s */
    Vec3 emission; /* emitted radiance per length: sigma_a Le */
    float g; /* of the phase function of Henyey and Greenstein: mean cosine between old and new direction */
    uint grid; /* 1 + index into `grids`; 0: homogeneous */
} Medium;

/* Factors of a medium's coefficients, from 0 to 1, on a grid (geometry/medium_grid.h). */
typedef struct MediumGrid {
    Affine grid_from_world;
    uint size_x, size_y, size_z; /* samples */
    float low; /* its box: along each axis, coordinates from low to low + size */
    uint words; /* of a sample: GRID_COLORS */
    uint bricks; /* first word, in texels, of a table: for each brick, x fastest, its samples' first word or NONE */
    uint emission; /* 1 + index of the grid of the medium's emission (geometry/grid_emission.h); 0: emission has the
                      factor of extinction */
    /* Of a grid of emission: */
    uint aligned; /* 1: its samples are at those of extinction, up to a shift by whole cells; 0: somewhere else */
    uint table; /* first float in `lookup` of the colours of black bodies; NONE: there are no temperatures */
    float kelvin_scale, kelvin_offset; /* temperature: scale times factor, plus offset */
} MediumGrid;

/* Numbers of media are below this. */
#define MEDIA_MAX 4096u

/* ---- lights ---------------------------------------------------------------------------------------------------- */

/* X(NAME, name, text, feature, position): LIGHT_NAME; its name in `twinlight info`; the group of lights that it is
 * dispatched with; whether LightDetail.position is its place. Delta lights have functions light_name_sample, _emit,
 * _emit_pdf_w and _emitted (light/delta.h), name_power (host/scene/light_setup.c) and name_read (host/pbrt/lights.c, by
 * `text`). */
#define LIGHT_LIST_DELTA(X)                                                                                            \
    X(POINT, point, "point", FEATURE_DELTA_LIGHT, 1u)                                                                  \
    X(SPOT, spot, "spot", FEATURE_DELTA_LIGHT, 1u)                                                                     \
    X(GONIOMETRIC, goniometric, "goniometric", (FEATURE_DELTA_LIGHT | FEATURE_INTENSITY_IMAGE), 1u)                    \
    X(PROJECTION, projection, "projection", (FEATURE_DELTA_LIGHT | FEATURE_INTENSITY_IMAGE), 1u)                       \
    X(DISTANT, distant, "distant", FEATURE_DELTA_LIGHT, 0u)

/* All lights. Those at infinity, DISTANT and after, follow those at a point. Those of FEATURE_INFINITE_LIGHT come last;
 * LIGHT_INFINITE is a constant environment, LIGHT_PORTAL one that is constant or an image, and is seen through a portal
 * alone (light/portal.h). */
#define LIGHT_LIST(X)                                                                                                  \
    X(AREA, area, "area", FEATURE_AREA_LIGHT, 0u)                                                                      \
    LIGHT_LIST_DELTA(X)                                                                                                \
    X(INFINITE, infinite, "infinite", FEATURE_INFINITE_LIGHT, 0u)                                                      \
    X(INFINITE_IMAGE, infinite_image, "infinite image", FEATURE_INFINITE_LIGHT, 0u)                                    \
    X(PORTAL, portal, "infinite portal", (FEATURE_INFINITE_LIGHT | FEATURE_PORTAL), 0u)

#define LIGHT_ENUMERATE(NAME, name, text, feature, position) LIGHT_##NAME,
enum { LIGHT_LIST(LIGHT_ENUMERATE) LIGHT_KINDS };
#undef LIGHT_ENUMERATE

/* Light.flags: the kind in the lowest bits (light_kind), and: */
#define LIGHT_KIND_MASK 0xfu
#define LIGHT_TWO_SIDED 0x10u
#define LIGHT_EQUIRECTANGULAR 0x20u /* infinite image: latitude-longitude; else pbrt's equal-area octahedral map */
#define LIGHT_INVISIBLE                                                                                                \
    0x40u /* area: its shape has alpha 0, so that no ray hits it, and the light its whole emission */
#define LIGHT_LEAF_SHIFT 7 /* from here on: number of leaves before it in the tree of lights (light_leaf) */

/* Scenes have no more lights than this; as a leaf: the light has no power. */
#define LIGHTS_MAX 0x1ffffffu

/* 28 bytes, as emissive triangles come in millions. Beside them a light takes 36 in three other tables: a bucket of the
 * alias table, and of the tree a leaf and a node. */
typedef struct Light {
    uint flags;
    uint primitive; /* of an area light; of the others: index into `light_details` (light_detail) */
    /* area, infinite: radiance. point, spot, goniometric, projection: intensity. distant: irradiance on a plane facing
     * it. With an image: its scale */
    Vec3 emission;
    float area; /* area: surface area in world space */
    float select_pdf; /* probability of choosing this light (host/scene/light_setup.h) */
} Light;

/* What area lights do not have. */
typedef struct LightDetail {
    uint image; /* infinite image, goniometric, projection; portal: NONE if its environment is constant */
    /* of light subpaths; infinite image, portal, goniometric, projection: index into `distributions2d` */
    uint distribution;
    uint portal; /* portal: index into `portals` */
    uint medium; /* around it */
    Vec3 position; /* of lights at a point */
    Vec3 direction; /* spot, projection: axis. distant: direction in which the light travels. unit */
    float cos_total; /* spot, projection: no light outside this angle */
    float cos_falloff; /* spot: full intensity inside this angle; projection: cos_total */
    Affine world_from_light; /* infinite, goniometric, projection: of directions, scaled to a determinant of 1 or -1 */
    Affine light_from_world;
} LightDetail;

/* A piecewise-constant density over [0,1)^2 in `lookup`: the marginal CDF of height + 1 floats at first_marginal, then
 * one conditional CDF of width + 1 floats per row, consecutive from first_conditional. The density of cell (x,y) over
 * the unit square is the product of the two CDF steps times width and height. */
typedef struct Distribution2D {
    uint width, height;
    uint first_marginal;
    uint first_conditional;
} Distribution2D;

/* The rectangle through which alone an infinite light is seen: corner + x axes.t + y axes.b with 0 <= x <= width and 0
 * <= y <= height. axes.n points away from the side that is lit. `sums`: index in `texels` of the first of (columns + 1)
 * x (rows + 1) sums, modulo 2^32, over all cells of the rectified environment with smaller indices (light/portal.h). */
typedef struct Portal {
    Vec3 corner;
    float width, height;
    Frame axes;
    uint columns, rows;
    uint sums;
} Portal;

/* One bucket of an alias table (Walker 1977, Vose 1991): keep i with probability q, else take alias. */
typedef struct AliasBucket {
    float q;
    uint alias;
} AliasBucket;

/* A node of the tree by which a light is chosen for a point (light/light_tree.h), of two or more leaves. Nodes are
 * in the order of a walk that takes left children first, so that the left child follows its node, and the right one
 * follows all those of the left. */
typedef struct LightNode {
    uint left; /* leaves of the left child, and LIGHT_NODE_ flags for both children */
    /* Each child's: 12 bits of x and y, and of z below, of the middle of a sphere around its lights, as steps from the
     * middle of the node's own sphere, 2047 of them its radius, plus 2047. Then 8 bits of the right child's intensity
     * over the left one's, the upper half of a float without its sign, first the higher 8 bits, then the lower. */
    uint xy[2];
    /* Each child's: 12 bits of z; 12 bits of the radius over the node's, a float with 4 bits of exponent
     * (light_child_sphere); 8 bits of the cone of the normals: sine of half its angle in 255ths, LIGHT_CONE_ALL for all
     * directions. */
    uint z_size[2];
    uint axes; /* 16 bits for each child: the middle of the normals (direction_pack) */
} LightNode;

#define LIGHT_NODE_TWO_SIDED 0x10000000u /* light may leave on both sides */
#define LIGHT_NODE_BEAMS 0x20000000u /* light leaves within the cones; else up to a right angle from them */
#define LIGHT_NODE_EVEN 0x40000000u /* only the children's intensities matter */
#define LIGHT_NODE_FAR 0x80000000u /* the root, if its right child has the lights at infinity: LightTree counts */
#define LIGHT_CONE_ALL 0xffu

/* The bounds of all lights that are not at infinity. */
typedef struct LightTree {
    uint leaves; /* of the whole tree: lights that have power */
    uint flags; /* as in LightNode.left */
    uint cone; /* 8 bits, as in LightNode.z_size */
    uint axis; /* 16 bits, as in LightNode.axes */
    Vec3 center; /* of a sphere around the lights */
    float radius;
    float lamps; /* sum of the largest intensities of lights (luminance) */
    float far; /* of the lights at infinity: sum of their irradiances */
} LightTree;

/* A sphere around smooth specular surfaces, at which light subpaths are aimed (light/aim.h). */
typedef struct Aim {
    Vec3 center;
    float radius;
} Aim;

/* ---- camera and film ------------------------------------------------------------------------------------------- */

#define CAMERA_PERSPECTIVE 0u
#define CAMERA_ORTHOGRAPHIC 1u
#define CAMERA_EQUAL_AREA                                                                                              \
    2u /* spherical: pbrt's equal-area octahedral map of all directions; FEATURE_SPHERICAL_CAMERA */
#define CAMERA_EQUIRECTANGULAR 3u /* spherical: longitude and latitude */

/* Camera space as in pbrt: left-handed, looking along +z, y up. The screen window is the part of the plane z = 1
 * (perspective: of the image plane in units of tan(fov/2)) that the whole film shows. */
typedef struct Camera {
    uint kind;
    float lens_radius;
    float focal_distance;
    float screen[4]; /* x_min x_max y_min y_max on the plane z = 1 (perspective) or in world units (orthographic) */
    Affine world_from_camera;
    Affine camera_from_world;
    uint medium; /* around the camera */
} Camera;

#define PIXEL_FILTER_BOX 0u
#define PIXEL_FILTER_TRIANGLE 1u
#define PIXEL_FILTER_GAUSSIAN 2u
#define PIXEL_FILTER_MITCHELL 3u
#define PIXEL_FILTER_SINC 4u

/* The filter is separable: offsets in x and y are drawn independently from |f|, by inverting a table of
 * PIXEL_FILTER_CELLS + 1 cumulative values over [-radius, radius] in `lookup`; a negative lobe gives the splat a
 * negative sign. Box and triangle are inverted in closed form and have no table. A density that is constant within
 * cells of width h has a variance that is h^2 / 6 too large: 1.6e-4 pixels^2 for a sinc of radius 4. */
#define PIXEL_FILTER_CELLS 256

typedef struct PixelFilter {
    uint kind;
    float radius_x, radius_y;
    uint table_x, table_y; /* first float in `lookup`: cells + 1 of the CDF of |f|, then cells of the sign (+1, -1);
                              NONE for box and triangle */
    float weight; /* (integral of |f|) / (integral of f) over the plane: the weight of a splat of sign +1 */
} PixelFilter;

/* ---- the packed arrays ------------------------------------------------------------------------------------------ */

/* Index of the first word of every array in its buffer. */
typedef struct SceneLayout {
    /* geometry */
    uint positions, normals, uvs, primitives, shapes, patches, quadrics, curves, objects, instances;
    /* tables */
    uint materials, texture_ops, images, lights, light_details, light_alias, light_tree, light_nodes, light_leaves,
        infinite_lights, portals, aims, distributions2d, lookup, media, grids;
} SceneLayout;

#endif
