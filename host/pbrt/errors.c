#include "pbrt/errors.h"

#include "base/log.h"
#include "base/name_table.h"
#include "scene/format.h"

#include <stdio.h>
#include <string.h>

bool import_unsupported(PbrtImport *im, SourcePlace place, const char *what, const char *substitute, const char *fix)
{
    if (im->options.needs)
        return needs_unsupported(im->options.needs, what, substitute, place, im->error);
    if (im->options.lenient) {
        ++im->scene->counts.substitutions;
        log_message_at(LOG_WARNING, place, "%s is not supported; instead: %s", what, substitute);
        return true;
    }
    error_at(im->error, place, "%s is not supported", what);
    if (fix)
        return error_fix(im->error, "%s; or replace it by --lenient (%s)", fix, substitute);
    return error_fix(im->error, "replace it by --lenient (%s)", substitute);
}

bool import_use(PbrtImport *im, const char *kind, const char *name)
{
    return !im->options.needs || needs_use(im->options.needs, kind, name, im->place, im->error);
}

bool import_other_version(PbrtImport *im, SourcePlace place, const char *kind, const char *name)
{
    im->errors.other_version = true;
    error_at(im->error, place, "this is a scene for pbrt-v3, as the %s \"%s\" shows", kind, name);
    return error_fix(im->error, "convert it by pbrt --upgrade, of pbrt-v4");
}

bool import_unknown(PbrtImport *im, SourcePlace place, const char *kind, const char *name, const char *const *known,
                    size_t count)
{
    const char *nearest = name_nearest(name, known, count);
    char list[400] = "";
    size_t used = 0;
    if (scene_format_is_v3(kind, name))
        return import_other_version(im, place, kind, name);
    error_at(im->error, place, "unknown %s \"%s\"", kind, name);
    if (nearest)
        return error_fix(im->error, "did you mean \"%s\"?", nearest);
    for (size_t i = 0; i < count && used + 32 < sizeof list; ++i)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i > 0 ? ", " : "", known[i]);
    return error_fix(im->error, "use %s", list);
}

void errors_missing(PbrtImport *im)
{
    im->errors.missing = true;
}

bool errors_note(PbrtImport *im, bool defines)
{
    ImportErrors *errors = &im->errors;
    bool consequence = errors->missing && errors->definition_failed;
    bool again = errors->count > 0 && strcmp(errors->latest.message, im->error->message) == 0;
    errors->missing = false;
    errors->definition_failed = errors->definition_failed || defines;
    if (!im->options.all_errors || error_is_memory(im->error))
        return false;
    if (im->options.needs)
        return consequence || (needs_error(im->options.needs, im->error, im->error) && !errors->other_version);
    if (consequence || again)
        return true;
    if (errors->count > 0)
        log_error(&errors->latest);
    errors->latest = *im->error;
    ++errors->count;
    if (errors->other_version)
        return false;
    if (errors->count < IMPORT_ERRORS_MAX)
        return true;
    size_t used = strlen(errors->latest.fix);
    snprintf(errors->latest.fix + used, sizeof errors->latest.fix - used, "; there may be more errors than these %d",
             IMPORT_ERRORS_MAX);
    return false;
}

bool errors_end(PbrtImport *im)
{
    if (im->errors.count == 0)
        return true;
    if (!error_is_memory(im->error))
        *im->error = im->errors.latest;
    else
        log_error(&im->errors.latest);
    return false;
}
