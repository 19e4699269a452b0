#include "mmlt/guide.h"

#include <string.h>

void mmlt_guide_init(MmltGuide *guide, const Guide *lights)
{
    *guide = (MmltGuide){.shown = *lights};
    for (int replica = 0; replica < REPLICAS; ++replica)
        importance_even(guide->importance[replica]);
    mmlt_guide_show(guide, 0);
}

void mmlt_guide_archive(Archive *archive, MmltGuide *guide, const int size[2])
{
    archive_floats(archive, guide->importance[0], REPLICAS * IMPORTANCE_CELLS,
                   (NumberRange){IMPORTANCE_LEAST, IMPORTANCE_MOST}, "the target importance");
    for (int replica = 0; replica < REPLICAS; ++replica)
        importance_visits_archive(archive, guide->visits[replica], size);
    ARCHIVE_FIELD(archive, guide->visited);
    ARCHIVE_FIELD(archive, guide->visited_all);
}

void mmlt_guide_show(MmltGuide *guide, int replica)
{
    memcpy(guide->shown.importance, guide->importance[replica], sizeof guide->shown.importance);
    memcpy(guide->shown.visits, guide->visits[replica], sizeof guide->shown.visits);
}

bool mmlt_guide_due(const Generation *generation)
{
    uint own = generation->index / REPLICAS;
    return own >= 2 && (own & (own - 1)) == 0;
}

bool mmlt_guide_renew(MmltGuide *guide, const Generation *generation, const Combination *known,
                      const double samples[ESTIMATOR_COUNT], float change[IMPORTANCE_CELLS], Error *error)
{
    int replica = generation->replica, other = generation->other;
    double visited[IMPORTANCE_CELLS];
    memcpy(change, guide->importance[replica], IMPORTANCE_CELLS * sizeof *change);
    importance_learn(known, guide->importance[replica]);
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i) {
        change[i] = guide->importance[replica][i] / change[i];
        visited[i] = guide->visited[other][i] / guide->visited_all[other];
    }
    if (!importance_visits(known, samples, visited, guide->visits[replica], error))
        return false;
    mmlt_guide_show(guide, replica);
    return true;
}

void mmlt_guide_count(MmltGuide *guide, int replica, const Combination *combination, double samples)
{
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i) {
        double density_ratio = importance_density_ratio(combination, guide->visits[replica], i);
        guide->visited[replica][i] += density_ratio > 0.0 ? samples / density_ratio : 0.0;
    }
    guide->visited_all[replica] += samples;
}
