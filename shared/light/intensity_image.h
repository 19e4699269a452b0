/* Lights at a point whose intensity an image gives, texel by texel: goniometric lights, by pbrt's equal-area octahedral
 * map of all directions, and projection lights, which project it like a slide. Here are the functions of light/delta.h
 * for both. */
#ifndef TWINLIGHT_LIGHT_INTENSITY_IMAGE_H
#define TWINLIGHT_LIGHT_INTENSITY_IMAGE_H

#include "geometry/texture.h"
#include "layout/distribution.h"
#include "light/position.h"

SHARED_FUNCTION bool light_has_intensity_image(uint kind)
{
    return kind == LIGHT_GONIOMETRIC || kind == LIGHT_PROJECTION;
}

/* A direction on the light's image. */
typedef struct IntensityPlace {
    Vec2 uv; /* v = 0 is row 0 */
    float pdf_uniform; /* solid-angle density of the direction if uv is uniform; 0: it is not on the image */
} IntensityPlace;

/* Where the unit vector w leaves a goniometric light. If the transform M to the light's space stretches, w -> M w / |M
 * w| scales solid angles by |det M| / |M w|^3, and |det M| = 1 (layout/scene_types.h). */
SHARED_FUNCTION IntensityPlace goniometric_place(__global const LightDetail *source, Vec3 w)
{
    IntensityPlace place;
    Vec3 d = affine_vector(source->light_from_world, w);
    float length = vec3_length(d);
    place.uv = sphere_to_octahedral(vec3_scale(d, 1.0f / length));
    place.pdf_uniform = INV_4PI / (length * length * length);
    return place;
}

SHARED_FUNCTION Vec3 goniometric_direction(__global const LightDetail *source, Vec2 uv)
{
    return vec3_normalize(affine_vector(source->world_from_light, octahedral_to_sphere(uv)));
}

/* Where w leaves a projection light. In the light's space the image is the square |x| <= z, |y| <= z of directions (x,
 * y, z), y up. The area element of the plane z = 1 there is the solid angle's over (M w)_z^3, and the square has the
 * area 4. */
SHARED_FUNCTION IntensityPlace projection_place(__global const LightDetail *source, Vec3 w)
{
    IntensityPlace place;
    Vec3 d = affine_vector(source->light_from_world, w);
    place.uv = vec2(0.5f + 0.5f * (d.x / d.z), 0.5f - 0.5f * (d.y / d.z));
    bool inside = float_abs(d.x) <= d.z && float_abs(d.y) <= d.z;
    place.pdf_uniform = inside ? 0.25f / (d.z * d.z * d.z) : 0.0f;
    return place;
}

SHARED_FUNCTION Vec3 projection_direction(__global const LightDetail *source, Vec2 uv)
{
    return vec3_normalize(affine_vector(source->world_from_light, vec3(2.0f * uv.x - 1.0f, 1.0f - 2.0f * uv.y, 1.0f)));
}

/* Where w leaves a light of either kind. */
SHARED_FUNCTION IntensityPlace intensity_place(const SceneView *scene, __global const Light *source, Vec3 w)
{
    __global const LightDetail *detail = light_detail(scene, source);
    return light_kind(source) == LIGHT_PROJECTION ? projection_place(detail, w) : goniometric_place(detail, w);
}

/* Intensity towards w: of the texel that holds it, as in pbrt, so that it is constant where the density is. */
SHARED_FUNCTION Vec3 intensity_emitted(const SceneView *scene, __global const Light *source, Vec3 w)
{
    IntensityPlace place = intensity_place(scene, source, w);
    TextureImage image = scene->images[light_detail(scene, source)->image];
    if (!(place.pdf_uniform > 0.0f))
        return vec3_splat(0.0f);
    Vec3 texel = image_texel(scene, &image, distribution_cell_of(place.uv.x, image.width),
                             distribution_cell_of(place.uv.y, image.height));
    Vec3 c = vec3_mul(source->emission, texel);
    return vec3(float_max(c.x, 0.0f), float_max(c.y, 0.0f), float_max(c.z, 0.0f));
}

/* Density per solid angle of light subpaths that leave along w. */
SHARED_FUNCTION float intensity_emit_pdf_w(const SceneView *scene, __global const Light *source, Vec3 w)
{
    IntensityPlace place = intensity_place(scene, source, w);
    if (!(place.pdf_uniform > 0.0f && float_finite(place.pdf_uniform)))
        return 0.0f;
    Distribution2D directions = scene->distributions2d[light_detail(scene, source)->distribution];
    return distribution2d_pdf(scene->lookup, directions, place.uv) * place.pdf_uniform;
}

/* A direction in proportion to the intensity. */
SHARED_FUNCTION_APART bool intensity_emit(const SceneView *scene, __global const Light *source, Vec2 u_point,
                                          Vec2 u_direction, LightEmission *emission)
{
    (void)u_point;
    __global const LightDetail *detail = light_detail(scene, source);
    float pdf;
    Vec2 uv = distribution2d_sample(scene->lookup, scene->distributions2d[detail->distribution], u_direction, &pdf);
    bool projection = light_kind(source) == LIGHT_PROJECTION;
    position_light_emit(scene, source, emission);
    emission->w = projection ? projection_direction(detail, uv) : goniometric_direction(detail, uv);
    emission->pdf_w = intensity_emit_pdf_w(scene, source, emission->w);
    return emission->pdf_w > 0.0f;
}

SHARED_FUNCTION_APART bool intensity_sample(const SceneView *scene, __global const Light *source, Vec3 ref,
                                            LightSample *sample)
{
    float distance2;
    if (!position_light_sample(scene, source, ref, sample, &distance2))
        return false;
    Vec3 intensity = intensity_emitted(scene, source, vec3_negate(sample->wi));
    sample->radiance = vec3_scale(intensity, 1.0f / distance2);
    return true;
}

/* Both kinds by the names that light/delta.h gives the functions of a kind. */
#define light_goniometric_sample intensity_sample
#define light_goniometric_emit intensity_emit
#define light_goniometric_emit_pdf_w intensity_emit_pdf_w
#define light_goniometric_emitted intensity_emitted
#define light_projection_sample intensity_sample
#define light_projection_emit intensity_emit
#define light_projection_emit_pdf_w intensity_emit_pdf_w
#define light_projection_emitted intensity_emitted

#endif
