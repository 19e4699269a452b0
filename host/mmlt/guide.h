/* What guides the passes of MMLT: target importance, visits and light guides (Guide), and how each replica renews its
 * own from what the other has learned. */
#ifndef TWINLIGHT_MMLT_GUIDE_H
#define TWINLIGHT_MMLT_GUIDE_H

#include "mmlt/generation.h"
#include "mmlt/importance.h"

typedef struct MmltGuide {
    Guide shown; /* for the passes under way */
    float importance[REPLICAS][IMPORTANCE_CELLS];
    uint visits[REPLICAS][IMPORTANCE_CELLS + 1]; /* of each replica's pools: importance_visits */
    double visited[REPLICAS][IMPORTANCE_CELLS]; /* visits per pixel over the mean, summed over samples */
    double visited_all[REPLICAS]; /* pool samples in `visited` */
} MmltGuide;

/* lights: the scene's light guides. All cells alike at first. */
void mmlt_guide_init(MmltGuide *guide, const Guide *lights);

/* Saves what both replicas know, or restores it. size: of the crop, pixels. */
void mmlt_guide_archive(Archive *archive, MmltGuide *guide, const int size[2]);

/* Sets `shown` for passes of a generation of this replica. */
void mmlt_guide_show(MmltGuide *guide, int replica);

/* Whether a generation begins with new importance and visits: after 2, 4, 8 ... generations of its replica, when much
 * more is known, so that the target changes rarely. */
bool mmlt_guide_due(const Generation *generation);

/* Renews the replica's importance and visits from what the other knows, and shows them. known: the other's. samples: of
 * each estimator, in proportion, as planned. change: receives the importance's ratio new over old, per cell. Fails only
 * when out of memory. */
bool mmlt_guide_renew(MmltGuide *guide, const Generation *generation, const Combination *known,
                      const double samples[ESTIMATOR_COUNT], float change[IMPORTANCE_CELLS], Error *error);

/* Counts the visits of a pool of `samples`. */
void mmlt_guide_count(MmltGuide *guide, int replica, const Combination *combination, double samples);

#endif
