/* The list of all kinds of materials. Made from it are the kinds (MATERIAL_*), their bits in the feature mask
 * (FEATURE_*), the dispatch of bsdf/bsdf.h, the readers of pbrt's materials, and the names in `twinlight info`. */
#ifndef TWINLIGHT_LAYOUT_MATERIAL_LIST_H
#define TWINLIGHT_LAYOUT_MATERIAL_LIST_H

/* The lobes of a BSDF. */
#define TRAIT_COSINE 0x1u /* a cosine lobe, drawn with BsdfDraw.u_base */
#define TRAIT_MICROFACET 0x2u /* a microfacet lobe, or a delta if both alphas are below ALPHA_DELTA */
#define TRAIT_INTERFACE 0x4u /* ... of an interface, which is smooth if its relative index is close to 1 */
#define TRAIT_DELTA 0x8u /* only deltas if it is not rough, nor its base */

/* X(NAME, name, text, traits): MATERIAL_NAME; functions bsdf_name_eval, _sample and _invert (bsdf/bsdf.h) and
 * name_read (host/pbrt/materials.c); what pbrt calls it. */
#define BSDF_LIST(X)                                                                                                   \
    X(DIFFUSE, diffuse, "diffuse", TRAIT_COSINE)                                                                       \
    X(CONDUCTOR, conductor, "conductor", TRAIT_MICROFACET | TRAIT_DELTA)                                               \
    X(DIELECTRIC, dielectric, "dielectric", TRAIT_MICROFACET | TRAIT_INTERFACE | TRAIT_DELTA)                          \
    X(THIN_DIELECTRIC, thin_dielectric, "thindielectric", TRAIT_DELTA)                                                 \
    X(COATED_DIFFUSE, coated_diffuse, "coateddiffuse", TRAIT_COSINE | TRAIT_MICROFACET | TRAIT_INTERFACE)              \
    X(COATED_CONDUCTOR, coated_conductor, "coatedconductor",                                                           \
      TRAIT_COSINE | TRAIT_MICROFACET | TRAIT_INTERFACE | TRAIT_DELTA)                                                 \
    X(DIFFUSE_TRANSMISSION, diffuse_transmission, "diffusetransmission", TRAIT_COSINE)                                 \
    X(HAIR, hair, "hair", 0u)

/* All BSDFs, and the materials that are not BSDFs themselves. */
#define MATERIAL_LIST(X)                                                                                               \
    BSDF_LIST(X)                                                                                                       \
    X(MIX, mix, "mix", 0u)

#define MATERIAL_ENUMERATE(NAME, name, text, traits) MATERIAL_##NAME,
enum { MATERIAL_LIST(MATERIAL_ENUMERATE) MATERIAL_KINDS };
#undef MATERIAL_ENUMERATE

#endif
