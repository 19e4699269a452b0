#include "pbrt_errors.h"

#include "log.h"

#include <stdio.h>
#include <string.h>

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
    if (consequence || again)
        return true;
    if (errors->count > 0)
        log_error(&errors->latest);
    errors->latest = *im->error;
    if (++errors->count < IMPORT_ERRORS_MAX)
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
