/* What `twinlight render --shard` writes in place of an image, and what an image takes from it again. */
#ifndef TWINLIGHT_COMMAND_PART_OUTPUT_H
#define TWINLIGHT_COMMAND_PART_OUTPUT_H

#include "command/render_output.h"
#include "render/part.h"

typedef struct PartOutput {
    char path[PATH_MAX]; /* "": no part, but an image is written */
    PartHead head; /* complete but for what has been rendered */
    RenderLayers *layers; /* NULL: none */
    int threads; /* that may compress; 1 if 0 */
} PartOutput;

/* Sets the name: `given` or, if that is NULL, that of the image without its ending, with -KofN.part. */
bool part_output_name(PartOutput *part, const char *given, const char *image, Shard shard, Error *error);

/* Completes the head. output: what an image of this rendering would say of it. */
void part_output_begin(PartOutput *part, const RenderOutput *output, const Integrator *integrator, const Scene *scene,
                       const RenderOptions *options);

/* Writes the part. */
bool part_output_write(PartOutput *part, Film *film, const RenderTotals *totals, Error *error);

/* Sets what an image file says of its rendering, from the part's head, which must outlive `output`. */
void part_output_adopt(RenderOutput *output, const PartHead *head);

#endif
