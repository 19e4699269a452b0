/* Integrator, Sampler, Accelerator and Option: Twinlight takes depth and number of samples from them and reports what
 * it does not use. */
#include "base/log.h"
#include "pbrt/context.h"
#include "pbrt/errors.h"
#include "pbrt/readers.h"

#include <ctype.h>
#include <string.h>

/* Reports each parameter that is accepted without effect. */
static void unused_report(const ParamList *list, const char *directive, const char *kind)
{
    for (size_t i = 0; i < list->entries.count; ++i) {
        const ParamEntry *entry = &ARRAY_AT(&list->entries, ParamEntry, i);
        if (!entry->used)
            log_message_at(LOG_INFO, entry->param->place, "parameter \"%s\" of %s \"%s\" is not used",
                           entry->param->name, directive, kind);
    }
}

static bool unused_end(ParamList *list, const char *directive, const char *kind)
{
    bool good = !list->failed;
    if (good)
        unused_report(list, directive, kind);
    param_list_destroy(list);
    return good;
}

static bool kind_known(PbrtImport *im, const char *what, const char *kind, const char *const *known, size_t count)
{
    for (size_t i = 0; i < count; ++i)
        if (strcmp(kind, known[i]) == 0)
            return true;
    return import_unknown(im, im->place, what, kind, known, count);
}

bool import_integrator(PbrtImport *im, const char *kind)
{
    static const char *const KNOWN[] = {"path",       "volpath",          "bdpt",      "mlt",
                                        "sppm",       "simplepath",       "lightpath", "simplevolpath",
                                        "randomwalk", "ambientocclusion", "function"};
    ParamList list;
    if (!kind_known(im, "integrator", kind, KNOWN, sizeof KNOWN / sizeof *KNOWN))
        return false;
    if (strcmp(kind, "ambientocclusion") == 0 || strcmp(kind, "function") == 0)
        log_message_at(LOG_WARNING, im->place,
                       "the integrator \"%s\" shows something other than light; Twinlight renders light", kind);
    import_list(im, &list, "the integrator", -1);
    int depth = param_integer(&list, "maxdepth", 5);
    if (depth < 0)
        param_error(&list, "maxdepth", "\"maxdepth\" is negative");
    im->scene->settings.max_depth = (depth < IMPORT_DEPTH_MAX ? depth : IMPORT_DEPTH_MAX - 1) + 1;
    return unused_end(&list, "the integrator", kind);
}

bool import_sampler(PbrtImport *im, const char *kind)
{
    static const char *const KNOWN[] = {"zsobol",  "halton", "independent", "paddedsobol",
                                        "pmj02bn", "sobol",  "stratified"};
    ParamList list;
    if (!kind_known(im, "sampler", kind, KNOWN, sizeof KNOWN / sizeof *KNOWN))
        return false;
    import_list(im, &list, "the sampler", -1);
    int64_t samples;
    const char *name = "pixelsamples";
    if (strcmp(kind, "stratified") == 0) {
        name = "xsamples";
        samples = param_integer(&list, "xsamples", 4);
        samples *= param_integer(&list, "ysamples", 4);
    } else {
        samples = param_integer(&list, name, strcmp(kind, "independent") == 0 ? 4 : 16);
    }
    if (samples < 1 || samples > INT32_MAX)
        param_error(&list, name, "the number of samples per pixel must be from 1 to %d", INT32_MAX);
    else
        im->scene->settings.samples = (int)samples;
    return unused_end(&list, "the sampler", kind);
}

bool import_accelerator(PbrtImport *im, const char *kind)
{
    ParamList list;
    import_list(im, &list, "the accelerator", -1);
    return unused_end(&list, "the accelerator", kind);
}

/* pbrt compares option names ignoring case, '_' and '-'. */
static void option_normalize(const char *name, char *out, size_t size)
{
    size_t n = 0;
    for (; *name && n + 1 < size; ++name)
        if (*name != '_' && *name != '-')
            out[n++] = (char)tolower((unsigned char)*name);
    out[n] = '\0';
}

bool import_option(PbrtImport *im, const char *name, const Token *value)
{
    static const char *const KNOWN[] = {"disablepixeljitter",
                                        "disabletexturefiltering",
                                        "disablewavelengthjitter",
                                        "displacementedgescale",
                                        "msereferenceimage",
                                        "msereferenceout",
                                        "rendercoordsys",
                                        "seed",
                                        "forcediffuse",
                                        "pixelstats",
                                        "wavefront"};
    char normal[64];
    option_normalize(name, normal, sizeof normal);
    if (value->kind != TOKEN_WORD && value->kind != TOKEN_STRING)
        return token_unexpected(value, "the option's value", im->error);
    if (!kind_known(im, "option", normal, KNOWN, sizeof KNOWN / sizeof *KNOWN))
        return false;
    bool changes_picture = strcmp(normal, "forcediffuse") == 0 || strcmp(normal, "disablepixeljitter") == 0;
    if (changes_picture && token_is(value, "true"))
        return import_unsupported(im, im->place, "this option", "it is ignored", NULL);
    log_message_at(LOG_INFO, im->place, "the option \"%s\" is not used", name);
    return true;
}
