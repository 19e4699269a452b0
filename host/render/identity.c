#include "render/identity.h"

#include "config.h"

#include "base/hash.h"
#include "render/layers.h"

#include <stdarg.h>
#include <string.h>

/* Changes with what the archives of a rendering's state hold. */
#define LAYOUT "5"

#ifdef KERNELS_IN_DOUBLE
#define PRECISION " (double)"
#else
#define PRECISION ""
#endif

#define VERSION_NAME PACKAGE_VERSION "." LAYOUT PRECISION
#define VERSION_LINE "version=" VERSION_NAME "\n"

__attribute__((format(printf, 2, 3))) static void line_add(Identity *identity, const char *format, ...)
{
    size_t length = strlen(identity->text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(identity->text + length, sizeof identity->text - length, format, arguments);
    va_end(arguments);
}

/* ---- scene ------------------------------------------------------------------------------------------------------- */

static uint64_t scene_hash(const Scene *scene)
{
    const Array *const arrays[] = {&scene->geometry_words, &scene->tables_words, &scene->texels};
    uint64_t hash = HASH_START;
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; ++i)
        hash = hash_words(hash, arrays[i]->data, arrays[i]->count * arrays[i]->element_size / 4);
    hash = hash_bytes(hash, &scene->frame, sizeof scene->frame);
    return hash_bytes(hash, &scene->guide, sizeof scene->guide);
}

/* ---- options ----------------------------------------------------------------------------------------------------- */

/* A number for which 0 means the default. */
static void number_add(Identity *identity, const char *name, double number)
{
    if (number > 0.0)
        line_add(identity, "%s=%.17g\n", name, number);
    else
        line_add(identity, "%s=default\n", name);
}

static void switch_add(Identity *identity, const char *name, bool on)
{
    line_add(identity, "%s=%s\n", name, on ? "on" : "off");
}

/* The names whose bits are set, bit i for name i of `count`, with `between` between two; `none` for no bit at all. */
static void names_add(Identity *identity, const char *name, unsigned bits, const char *const *names, unsigned count,
                      const char *between, const char *none)
{
    line_add(identity, "%s=%s", name, bits == 0 ? none : "");
    for (unsigned i = 0; i < count; ++i)
        if ((bits >> i & 1u) != 0)
            line_add(identity, "%s%s", names[i], bits >> i > 1u ? between : "");
    line_add(identity, "\n");
}

static void layers_add(Identity *identity, const RenderLayers *layers)
{
#define TEXT(NAME, name, text, ...) text,
    static const char *const NAMES[LAYER_COUNT] = {LAYER_LIST(TEXT)};
#undef TEXT
    names_add(identity, "layers", layers ? layers->wanted : 0, NAMES, LAYER_COUNT, ",", "none");
}

static void chains_add(Identity *identity, const ChainOptions *options)
{
    static const char *const ORDERS[] = {"strategy", "depth", "none"}, *const MUTATIONS[] = {"all", "light", "camera"};
    line_add(identity, "mlt=scheme=%s\n", options->paper ? "paper" : "generations");
    number_add(identity, "mlt=chains", options->chains);
    number_add(identity, "mlt=steps", options->steps);
    number_add(identity, "mlt=pool", options->pool);
    number_add(identity, "mlt=large-step", options->large_step);
    names_add(identity, "mlt=mutations", options->mutations & 7u, MUTATIONS, 3, "+", "default");
    line_add(identity, "mlt=sort=%s\n", ORDERS[options->order]);
    switch_add(identity, "mlt=group", !options->ungrouped);
    switch_add(identity, "mlt=shift", !options->shiftless);
    switch_add(identity, "mlt=guide", !options->unguided);
    switch_add(identity, "mlt=combine", !options->chains_only);
    number_add(identity, "shown", options->shown);
}

static void paths_add(Identity *identity, const RenderOptions *options, const FrameParams *frame)
{
    line_add(identity, "seed=%llu\n", (unsigned long long)options->seed);
    line_add(identity, "first-sample=%u\n", options->first_sample);
    line_add(identity, "max-depth=%u\n", frame->path.max_depth);
    line_add(identity, "heuristic=%s\n", options->balance ? "balance" : "power");
    line_add(identity, "sampler=%s\n", options->independent ? "independent" : "sobol");
    line_add(identity, "reconstruction=%s\n", frame->film.reconstruction == RECONSTRUCTION_SAMPLE ? "sample" : "splat");
    if (options->only_strategy)
        line_add(identity, "strategy=%u,%u\n", options->strategy[0], options->strategy[1]);
    else
        line_add(identity, "strategy=all\n");
    switch_add(identity, "unweighted", options->unweighted);
    if (options->photons == PHOTONS_DEFAULT)
        line_add(identity, "photons=default\n");
    else
        line_add(identity, "photons=%u\n", options->photons);
    switch_add(identity, "openings", !options->no_openings);
}

/* A shard, and what its share is of. */
static void shard_add(Identity *identity, const RenderOptions *options)
{
    const Shard shard = options->shard;
    if (shard.number > 0)
        line_add(identity, "shard=%u/%u\n", shard.number, shard.count);
    else
        line_add(identity, "shard=none\n");
    if (shard.count > 0)
        number_add(identity, "samples", options->samples);
}

void identity_begin(Identity *identity)
{
    *identity = (Identity){{0}};
    line_add(identity, "%s", VERSION_LINE);
}

void identity_make(Identity *identity, const Integrator *integrator, const Scene *scene, const RenderOptions *options,
                   const FrameParams *frame)
{
    const FilmParams *film = &frame->film;
    identity_begin(identity);
    line_add(identity, "integrator=%s\n", integrator->name);
    line_add(identity, "resolution=%ux%u\n", film->width, film->height);
    line_add(identity, "crop=%u,%u,%u,%u\n", film->crop_x0, film->crop_y0, film->crop_x1, film->crop_y1);
    shard_add(identity, options);
    paths_add(identity, options, frame);
    layers_add(identity, options->layers);
    switch_add(identity, "error", options->error.goal > 0.0);
    if (integrator->render)
        chains_add(identity, &options->chains);
    line_add(identity, "scene=%016llx\n", (unsigned long long)scene_hash(scene));
}

/* ---- comparison -------------------------------------------------------------------------------------------------- */

static bool starts_with(const char *line, const char *name)
{
    return strncmp(line, name, strlen(name)) == 0;
}

/* Sets the error for two lines that differ. */
static bool difference_set(const char *saved, const char *now, const IdentityUse *use, Error *error)
{
    char lines[2][128];
    snprintf(lines[0], sizeof lines[0], "%.*s", (int)strcspn(saved, "\n"), saved);
    snprintf(lines[1], sizeof lines[1], "%.*s", (int)strcspn(now, "\n"), now);
    if (starts_with(now, "scene=")) {
        error_set(error, "%s is of another scene than %s, or of this one before it was changed", use->saved, use->now);
        return error_fix(error, "%s", use->fix);
    }
    if (starts_with(now, "version=")) {
        error_set(error, "%s is of Twinlight %s, and %s of %s", use->saved, lines[0] + strcspn(lines[0], "0123456789"),
                  use->now, lines[1] + strlen("version="));
        return error_fix(error, "%s", use->fix);
    }
    error_set(error, "%s is of --%s, and %s of --%s", use->saved, lines[0], use->now, lines[1]);
    return error_fix(error, "%s", use->fix);
}

bool identity_compare(const Identity *saved, const Identity *now, const IdentityUse *use, Error *error)
{
    size_t line = 0;
    for (size_t i = 0; i < sizeof now->text; ++i) {
        if (saved->text[i] != now->text[i])
            return difference_set(saved->text + line, now->text + line, use, error);
        if (now->text[i] == '\n')
            line = i + 1;
    }
    return true;
}

bool identity_of_this_version(const Identity *saved, const char *what, Error *error)
{
    char text[64];
    if (strncmp(saved->text, VERSION_LINE, strlen(VERSION_LINE)) == 0)
        return true;
    snprintf(text, sizeof text, "%.*s", (int)strcspn(saved->text, "\n"), saved->text);
    text_make_printable(text);
    error_set(error, "%s is of Twinlight %s, and this is " VERSION_NAME, what, text + strcspn(text, "0123456789"));
    return error_fix(error, "use the version that it is of for all of its picture");
}
