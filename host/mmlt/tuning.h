/* The tuned constants of MMLT, each with its trade-off. What was measured, on which scenes, is in docs/TUNING.md. Those
 * of the kernels are beside the code that uses them (shared/chain/, shared/path/). */
#ifndef TWINLIGHT_MMLT_TUNING_H
#define TWINLIGHT_MMLT_TUNING_H

/* ---- pools ------------------------------------------------------------------------------------------------------ */

/* Fewest samples of a pool per step of a chain; docs/TUNING.md. */
#define POOL_PER_STEP (1.0 / 12.0)

/* Fraction of a pool's samples that have a light subpath; those without take a third of the time. The same where light
 * comes through openings. docs/TUNING.md. */
#define POOL_LIGHTS 0.25
#define POOL_LIGHTS_OPENED 0.75

/* Clamping threshold, in units of the mean contribution weight of a pool's sample. More shows fireflies, less leaves
 * more to the chains; docs/TUNING.md. */
#define CLAMP_FACTOR 2.0

/* Most samples of the pilot pool. */
#define PILOT_SAMPLES 4096u

/* Terms of the van der Corput sequence in lights_first; then a new random shift. */
#define TURNS 16u

/* ---- generations ------------------------------------------------------------------------------------------------ */

/* Chains of the first generation: few, so that there is soon an image. */
#define CHAINS_FIRST 256u

/* Most chains of a generation. More spread a generation over more starts and need more memory. */
#define CHAINS_DEFAULT 524288u

/* Steps of a chain in a generation. More steps explore each start longer, fewer leave time for more starts. */
#define STEPS_DEFAULT 64u

/* Fraction of the camera subpath's mutations that are shifts (chain/shift.h), which survive on paths over several
 * glossy surfaces; docs/TUNING.md. */
#define SHIFTS 0.75f

/* Most photons, up to PHOTONS_MOST_ALLOWED, if so many predict better than fewer (render/photon_map.c): more cost
 * memory (60 bytes each) and time before the first sample, fewer predict directions less well. On two cores as many as
 * a second brings take .1 to .2 s. */
#define MMLT_PHOTONS_MIN 32768u
#define MMLT_PHOTONS_PER_SECOND 32768.0
#define MMLT_PHOTONS_PER_SAMPLE 0.0625

/* Path tracing draws by photons at all receivers, and is trusted with rare light, if those where no light subpath can
 * make the path bring more than this part of the light ... */
#define PHOTONS_EVERYWHERE_PART 0.05

/* ... or more than this part of it, and than this part of what photons bring at all receivers: then much of the light
 * that path tracing would hardly find is light that no other estimator finds either; docs/CAUSTICS.md. */
#define PHOTONS_EVERYWHERE_LEAST 0.01
#define PHOTONS_EVERYWHERE_SHARE 0.25

/* Samples of path tracing per step of a chain: until variances are known, and if only direct light is wanted. */
#define PATHS_FIRST 1.0
#define PATHS_DIRECT 0.5

/* A generation may take this fraction of the time or work so far, so that stopping and saving are prompt ... */
#define GENERATION_PART 0.1

/* ... or any if twice the chains take less than this many times as long, as on a GPU that few chains leave idle; the
 * number of chains then doubles up to GROWTHS times at once. */
#define GROWTH_FREE 1.25
#define GROWTHS 3

/* ... or this much if that allows a path tracing sample of every pixel, or one of bidirectional path tracing where that
 * is better. */
#define WHOLE_SAMPLE_PART 0.25
#define WHOLE_BIDIRECTIONAL_PART 0.5

/* The last generation is fitted into the time that is left, if that is more than this fraction of what it would
 * take. */
#define LAST_PART 0.25

/* A generation that cannot be made shorter may end later than the limit of time by this fraction of it. */
#define LATE_PART 0.05

/* Most items in a pass of path tracing. */
#define PATHS_MAX (1u << 24)

/* ---- the published scheme --------------------------------------------------------------------------------------- */

/* Chains, samples of its pool per chain, and the probability of a large step. */
#define PAPER_CHAINS_DEFAULT 16384u
#define PAPER_POOL_PER_CHAIN 8u
#define LARGE_STEP_DEFAULT 0.3

/* ---- what samples cost ------------------------------------------------------------------------------------------ */

/* A step of a chain, a sample of a pool and one of path tracing, in samples of path tracing, on the CPU backend.
 * Constants, so that the image does not depend on the machine; docs/TUNING.md. */
#define COST_CHAINS 1.2
#define COST_POOL 4.0
#define COST_PATHS 1.0
#define COST_BIDIRECTIONAL 3.0

/* ---- bidirectional path tracing ---------------------------------------------------------------------------------- */

/* Where light comes through openings: so many generations after the first one have a sample of every pixel each, if
 * that takes no more than BIDIRECTIONAL_PART of the rendering, or two, if these take no more than
 * BIDIRECTIONAL_PART_EACH, and of their work it has at least BIDIRECTIONAL_FIRST. By then its variance and those of the
 * others are known well enough to compare them. */
#define BIDIRECTIONAL_FORCED 6u
#define BIDIRECTIONAL_PART 0.4
#define BIDIRECTIONAL_PART_EACH 0.25
#define BIDIRECTIONAL_FIRST 0.75

/* Elsewhere a trial tells its variance, unless light is so easy that path tracing may go on alone: after the first
 * PATHS_FORCED generations this part of the work so far, at most TRIAL_SAMPLES of a pixel, in each generation until
 * both replicas know it. */
#define TRIAL_PART 0.04
#define TRIAL_SAMPLES 0.25

/* It goes on where both replicas expect the error to be less than this part of that without it: if light comes through
 * openings, or if not. More gives it scenes where path tracing alone would do, less withholds it from others;
 * docs/TUNING.md. */
#define BIDIRECTIONAL_ERROR_OPENED 0.95
#define BIDIRECTIONAL_ERROR 0.75

/* ---- what a combination learns ---------------------------------------------------------------------------------- */

/* Weight, in generations, of the prior for a tile's variance: the median over tiles of variance / light, times the
 * tile's light. A few generations give uncertain variances, and independent samples underestimate theirs until a rare
 * bright path is found. */
#define PRIOR_GENERATIONS 2.0

/* About how many steps of a chain stay near one tile, and how many such visits, or samples of pools, tell as much of
 * the variance of a tile's light as all tiles together do: with fewer, most tiles have not met the bright paths;
 * docs/TUNING.md. */
#define VISIT_STEPS 64.0
#define VISITS_KNOWN 1.0
#define POOL_KNOWN 16.0

/* The chains' variance of rare light counts this many times against path tracing's: it is learnt from few visits, and
 * two replicas' estimates of it differ by a factor of two or three. More shows fireflies of path tracing, less shows
 * places where a chain has stayed; docs/TUNING.md. */
#define RARE_DOUBT 2.0

/* Generations of chains by which their variances count as known where path tracing is trusted with rare light. */
#define CHAINS_KNOWN 3u

/* How many times the variance that chains' generations state may be found at most between the replicas: chains go on
 * from one generation to the next, and their errors with them. */
#define PERSISTENCE_MOST 16.0

/* Path tracing finds too little of the rare light if the chains' in the whole image exceeds its own by this many of the
 * chains' standard errors, and by this part of all light: chains of a few generations state errors that are too small.
 * Its own error does not count: as long as it has found nothing, that is nothing; docs/TUNING.md. */
#define RARE_MISSED_DEVIATIONS 3.0
#define RARE_MISSED_PART 0.01

/* As long as so many standard errors are more than this part of all light, that comparison tells nothing, and path
 * tracing counts as finding too little; docs/TUNING.md. */
#define RARE_KNOWN_PART 0.05

/* One estimator must exceed another by so many standard errors that noise does so, either way, with this probability
 * (Student's t): then the difference counts as light that the other misses. A lower value trusts path tracing for too
 * long, a higher one takes noise for light; docs/TUNING.md. */
#define MISSING_PROBABILITY 0.0455

/* A patch's luminance is clamped to this many times its tile's mean: it may be a firefly, whose variance would count
 * little if its luminance counted in full; docs/TUNING.md. */
#define LIGHT_OVER_TILE 4.0

/* Chain steps per pixel at which a patch's own mean counts as much as its tile's. */
#define LIGHT_STEPS 16.0

/* Errors are relative to light^2 plus this fraction of the squared mean light. */
#define DARK_PART 0.1

/* ---- weights and plans ------------------------------------------------------------------------------------------ */

/* Until variances are known, path tracing is weighted by this fraction of its work, against all of a pool's;
 * docs/TUNING.md. */
#define FIRST_PATHS 0.25

/* Weight of a generation's picture per work: until variances are known, and at most, without and with bidirectional
 * path tracing; 1 if its work is divided as is best without. */
#define FIRST_WORTH 0.25
#define WORTH_MOST 2.0
#define WORTH_BIDIRECTIONAL_MOST 4.0

/* Path tracing alone, with the rare light that it finds itself, goes on for some generations if it has at most this
 * many times the error of the best division of work, which takes longer; docs/TUNING.md. */
#define ALONE_ERROR 1.5

/* Its work then, in units of that of the generations between, which look for what it does not find. */
#define ALONE_WORK 4.0

/* In the first generations, of which weights are not those of known variances, path tracing alone is shown if one of
 * so many generations tells that it has at most ALONE_ERROR_FIRST times the error of the best division of work:
 * chains of those generations are few, and show rare light worse than it does. Its difference from their image is
 * kept until then, which takes 24 bytes a pixel; pictures of more pixels than this do without; docs/TUNING.md. */
#define PATHS_REPLACED 3u
#define ALONE_ERROR_FIRST 3.0
#define PATHS_KEPT 8u
#define PATHS_KEPT_PIXELS ((size_t)1 << 20)

/* Plans are searched on a grid that divides time into this many parts. */
#define PLAN_PARTS 20

/* About how many of the tiles a search looks at. */
#define PLAN_TILES 1000u

/* The fraction of time for pools in the best division between pools and steps. It stands for how much of the chains'
 * variance a / T_pool + b / T_steps is due to starts and how much to steps: POOL_PART = sqrt(a) / (sqrt(a) + sqrt(b));
 * docs/TUNING.md. */
#define POOL_PART 0.45

/* ---- target importance and visits ------------------------------------------------------------------------------- */

/* Lower bound of a cell's light, relative to the mean. */
#define LIGHT_LEAST 0.05

/* Target importance is light^-EXPONENT: 0 leaves the target f as it is, 1 would visit all cells equally;
 * docs/TUNING.md. */
#define EXPONENT 0.5

/* Mean visits per pixel before they are rounded to whole numbers. A pixel has at least one, so that the inverse of this
 * is the part of a pool that goes everywhere, for paths not yet found; docs/TUNING.md. */
#define VISITS_MEAN 4.0

#endif
