#include "pbrt/hair.h"

#include "base/log.h"
#include "pbrt/values.h"

/* Reads a roughness of hair, in (0, 1]. */
static void hair_roughness_read(PbrtImport *im, ParamList *list, const char *name, FloatParam *roughness)
{
    *roughness = value_float_constant(0.3f);
    value_float_param(im, list, name, roughness);
    if (roughness->program == NONE && !(roughness->value > 0.0f && roughness->value <= 1.0f))
        param_error(list, name, "\"%s\" must be above 0 and at most 1", name);
}

static void melanin_read(PbrtImport *im, ParamList *list, const char *name, FloatParam *concentration, bool *given)
{
    *given |= value_float_param(im, list, name, concentration);
    if (concentration->program == NONE && concentration->value < 0.0f)
        param_error(list, name, "\"%s\" is negative", name);
}

/* Of sigma_a, reflectance (or color) and the pigments, the first that is given counts, as in pbrt. */
static void hair_color_read(PbrtImport *im, ParamList *list, Material *m)
{
    ColorParam color = value_color_constant(0.5f);
    bool melanin = false;
    bool absorption = value_color_param(im, list, "sigma_a", COLOR_INDEX, &m->color0);
    bool colored = value_color_param(im, list, "reflectance", COLOR_REFLECTANCE, &color);
    if (!colored)
        colored = value_color_param(im, list, "color", COLOR_REFLECTANCE, &color);
    else
        param_ignore(list, "color");
    melanin_read(im, list, "eumelanin", &m->base_u, &melanin);
    melanin_read(im, list, "pheomelanin", &m->base_v, &melanin);
    if (absorption + colored + melanin > 1)
        log_message_at(LOG_WARNING, list->place, "the hair's %s ignored: its %s given",
                       absorption && colored ? "reflectance and pigments are" : "pigments are",
                       absorption ? "sigma_a is" : "reflectance is");
    if (absorption)
        return;
    if (!colored && !melanin)
        m->base_u.value = 1.3f; /* brown */
    m->flags |= colored ? MATERIAL_HAIR_COLOR : MATERIAL_HAIR_MELANIN;
    m->color0 = color;
}

void hair_material_read(PbrtImport *im, ParamList *list, Material *m)
{
    hair_color_read(im, list, m);
    hair_roughness_read(im, list, "beta_m", &m->roughness_u);
    hair_roughness_read(im, list, "beta_n", &m->roughness_v);
    m->amount = value_float_constant(2.0f);
    value_float_param(im, list, "alpha", &m->amount);
    m->eta = value_eta(im, list, "eta", 1.55f);
}
