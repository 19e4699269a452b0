#include "gltf/uv_transform.h"

#include <math.h>

UvTransform uv_identity(void)
{
    return (UvTransform){{1.0, 0.0, 0.0, 0.0, 1.0, 0.0}};
}

bool uv_is_identity(const UvTransform *transform)
{
    const UvTransform identity = uv_identity();
    for (int i = 0; i < 6; ++i)
        if (transform->m[i] != identity.m[i])
            return false;
    return true;
}

UvTransform uv_make(const double offset[2], double angle, const double scale[2])
{
    double c = cos(angle), s = sin(angle);
    return (UvTransform){{c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]}};
}

UvTransform uv_after(const UvTransform *whole, const UvTransform *base)
{
    const double *w = whole->m, *b = base->m;
    double determinant = b[0] * b[4] - b[1] * b[3];
    if (determinant == 0.0 || uv_is_identity(base))
        return *whole;
    double p = b[4] / determinant, q = -b[1] / determinant, r = -b[3] / determinant, s = b[0] / determinant;
    UvTransform after = {
        {w[0] * p + w[1] * r, w[0] * q + w[1] * s, 0.0, w[3] * p + w[4] * r, w[3] * q + w[4] * s, 0.0}};
    after.m[2] = w[2] - after.m[0] * b[2] - after.m[1] * b[5];
    after.m[5] = w[5] - after.m[3] * b[2] - after.m[4] * b[5];
    return after;
}

bool uv_turns(const UvTransform *transform)
{
    const double *m = transform->m;
    double size = fabs(m[0]) + fabs(m[1]) + fabs(m[3]) + fabs(m[4]);
    return fabs(m[1]) + fabs(m[3]) > 1e-6 * size;
}

UvTransform uv_of_pbrt(const UvTransform *transform)
{
    const double *m = transform->m;
    if (uv_is_identity(transform))
        return *transform;
    return (UvTransform){{m[0], -m[1], m[1] + m[2], -m[3], m[4], 1.0 - m[4] - m[5]}};
}
