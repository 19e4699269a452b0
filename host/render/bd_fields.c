#include "render/bd_fields.h"

#include "path/ib_weight.h"

const StateField BD_FIELDS[IB_FIELD_COUNT] = {
    BD_FIELD_LIST,
    {BUFFER_PATHS, IB_PRODUCT, 1, true, "product of ratios"},
    {BUFFER_PATHS, IB_PRODUCT + 1u, 1, false, "its exponent"},
    {BUFFER_PATHS, IB_OWN, 1, true, "density of the vertex"},
    {BUFFER_PATHS, IB_OWN_BEFORE, 1, true, "density of the vertex before it"},
    {BUFFER_PATHS, IB_FIRST_RATIO, 1, true, "ratio of the light's point"},
    {BUFFER_PATHS, IB_FIRST_DELTA, 1, false, "whether the first vertex is a delta"},
};
