/* A rendering under way, for integrators with a loop of their own. */
#ifndef TWINLIGHT_RENDER_RUN_H
#define TWINLIGHT_RENDER_RUN_H

#include "backend/backend.h"
#include "render/chain_statistics.h"
#include "render/job.h"

/* The number of the second sequence's first sample of a pixel, beyond all that the first can make. */
#define SEQUENCE_SAMPLES 0x40000000u

/* The latest estimate of the picture's error (render/error_watch.h). */
typedef struct ErrorWatch {
    double estimate, deviation; /* relative; its standard error */
    uint64_t work; /* RenderRun.done then; 0: there was none */
} ErrorWatch;

typedef struct RenderRun {
    const BackendInterface *interface;
    Backend *backend;
    const RenderOptions *options;
    const RenderCallbacks *callbacks; /* may be NULL */
    FrameParams frame; /* from render_frame */
    const Guide *guide; /* the scene's */
    bool hidden_light; /* scene_hides_light */
    PhotonMap photons;
    double photons_part; /* photon_map_part where no light subpath can make the path; 0: not asked for */
    Film *film;
    Film *halves; /* two films of which `film` is the sum, by render_run_gather; NULL: it is added to itself */
    uint64_t crop_pixels;
    uint64_t done; /* as RenderTotals.done */
    struct Checkpoint *checkpoint; /* NULL: none is written or resumed (render/checkpoint.h) */
    struct PilotFile *pilot; /* NULL: none (render/pilot_file.h) */
    bool resumed;
    RenderTotals past; /* of the runs before this one; zeros, but for photons, unless resumed */
    double start, last_save;
    double fraction; /* of the samples wanted, at the latest render_run_report; 0 if their number is not limited */
    double pass_end; /* when the pass or generation under way is expected to end (timing_now); 0: not known */
    bool pass_last; /* no other follows it, as far as is known before it ends */
    bool save_failed; /* the latest call of `save` failed */
    ChainStatistics chains;
    ErrorWatch error;
} RenderRun;

/* The flag that becomes 1 if the rendering is to end at once (options->stop); a constant 0 if there is none. */
const atomic_int *render_run_stop(const RenderRun *run);

/* The same for passes that are finished before a stop where a checkpoint follows: the constant 0 then. */
const atomic_int *render_run_stop_between(const RenderRun *run);

/* Seconds of rendering so far, those of earlier runs included. */
double render_run_seconds(const RenderRun *run);

/* Totals of this run and those before it. */
RenderTotals render_run_totals(const RenderRun *run);

/* Saves or restores totals. */
void render_totals_archive(Archive *archive, RenderTotals *totals);

/* Sets the seed of a frame's random numbers. */
void render_frame_seed(FrameParams *frame, uint64_t seed);

/* Brings the film up to date with its halves, if it has any. */
bool render_run_gather(RenderRun *run, Error *error);

/* How much of the work is done until the goal for the error is reached, 0 ... 1, if the square of the error falls with
 * the inverse of the work; 0 before the first estimate. */
double render_run_error_fraction(const RenderRun *run);

/* Calls `progress` and `publish`. fraction: of the samples wanted; 0 if their number is not limited. */
void render_run_report(RenderRun *run, double fraction);

/* Sets how many seconds the pass or generation under way is expected to take from now on; 0: not known. */
void render_run_expect(RenderRun *run, double seconds);

/* Calls `progress` alone, with the fraction of the latest report: while a generation is under way. */
void render_run_tell(const RenderRun *run);

/* Calls `save` if it is due. A failure causes a warning; the next attempt is made when the next save is due. */
void render_run_save_if_due(RenderRun *run);

#endif
