#include "gltf/emission.h"

#include "gltf/images.h"
#include "gltf/uv_transform.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Points per side of a triangle at which the texture is looked up. */
#define SAMPLES 6

typedef struct EmissiveTriangle {
    double color[3]; /* of the texture, linear */
    double area;
    int group; /* 0: does not emit */
} EmissiveTriangle;

typedef struct EmissionSplit {
    const GltfMaterial *material;
    const PlyMesh *mesh;
    float *texels; /* linear RGB */
    int width, height;
    EmissiveTriangle *triangles;
} EmissionSplit;

#define GROUPS (EMISSION_LEVELS * EMISSION_LEVELS * EMISSION_LEVELS)

static bool emits(const GltfMaterial *material)
{
    return material->emission[0] > 0.0 || material->emission[1] > 0.0 || material->emission[2] > 0.0;
}

/* Moves `mesh` to a new part. */
static bool part_add(Gltf *gltf, GltfReader *reader, PlyMesh *mesh, const double emission[3])
{
    GltfPart *part = array_grow(&gltf->parts, 1, reader->error);
    if (!part) {
        reader->failed = true;
        return false;
    }
    part->mesh = *mesh;
    memcpy(part->emission, emission, sizeof part->emission);
    *mesh = (PlyMesh){0};
    return true;
}

/* The nearest texel at pbrt's (u, v). */
static const float *texel_at(const EmissionSplit *split, double u, double v)
{
    const GltfTexture *texture = &split->material->emissive_texture;
    const UvTransform to = uv_of_pbrt(&texture->transform);
    double s = to.m[0] * u + to.m[1] * v + to.m[2], t = 1.0 - (to.m[3] * u + to.m[4] * v + to.m[5]);
    s = texture->clamp ? fmin(fmax(s, 0.0), 1.0) : s - floor(s);
    t = texture->clamp ? fmin(fmax(t, 0.0), 1.0) : t - floor(t);
    int x = (int)(s * split->width), y = (int)(t * split->height);
    x = x < split->width ? x : split->width - 1;
    y = y < split->height ? y : split->height - 1;
    return &split->texels[3 * ((size_t)y * (size_t)split->width + (size_t)x)];
}

static double triangle_area(const PlyMesh *mesh, const uint *corners)
{
    double a[3], b[3], normal[3];
    for (int k = 0; k < 3; ++k) {
        double origin = (double)mesh->positions[3 * (size_t)corners[0] + (size_t)k];
        a[k] = (double)mesh->positions[3 * (size_t)corners[1] + (size_t)k] - origin;
        b[k] = (double)mesh->positions[3 * (size_t)corners[2] + (size_t)k] - origin;
    }
    vector_cross(a, b, normal);
    return 0.5 * sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
}

/* Mean of the texture over a triangle, at the centres of the SAMPLES^2 triangles that divide it. */
static void triangle_color(const EmissionSplit *split, const uint *corners, double color[3])
{
    const float *uv[3];
    for (int k = 0; k < 3; ++k)
        uv[k] = &split->mesh->uvs[2 * (size_t)corners[k]];
    color[0] = color[1] = color[2] = 0.0;
    for (int i = 0; i < SAMPLES; ++i)
        for (int j = 0; j < 2 * (SAMPLES - i) - 1; ++j) {
            /* Upright triangles have their corner at (i, j / 2), the ones between are upside down. */
            double third = j % 2 == 0 ? 1.0 / 3.0 : 2.0 / 3.0;
            double a = (i + third) / SAMPLES, b = (floor(j / 2.0) + third) / SAMPLES, c = 1.0 - a - b;
            const float *texel = texel_at(split, a * (double)uv[0][0] + b * (double)uv[1][0] + c * (double)uv[2][0],
                                          a * (double)uv[0][1] + b * (double)uv[1][1] + c * (double)uv[2][1]);
            for (int k = 0; k < 3; ++k)
                color[k] += (double)texel[k] / (SAMPLES * SAMPLES);
        }
}

static void triangles_classify(EmissionSplit *split)
{
    const PlyMesh *mesh = split->mesh;
    for (size_t i = 0; i < mesh->triangle_count; ++i) {
        EmissiveTriangle *triangle = &split->triangles[i];
        const uint *corners = &mesh->triangles[3 * i];
        triangle_color(split, corners, triangle->color);
        triangle->area = triangle_area(mesh, corners);
        for (int k = 0; k < 3; ++k) {
            double level = sqrt(fmin(triangle->color[k], 1.0)) * (EMISSION_LEVELS - 1) + 0.5;
            triangle->group = triangle->group * EMISSION_LEVELS + (split->material->emission[k] > 0.0 ? (int)level : 0);
        }
    }
}

static void *rows_pick(const void *from, size_t row, const uint *vertices, size_t count)
{
    char *out = from ? malloc(row * count + 1) : NULL;
    for (size_t i = 0; out && i < count; ++i)
        memcpy(out + row * i, (const char *)from + row * vertices[i], row);
    return out;
}

/* Triangles by group: those of group g are sorted[first[g]] ... sorted[first[g + 1] - 1]. */
typedef struct EmissionGroups {
    size_t first[GROUPS + 1];
    uint *sorted;
    uint *number; /* of each vertex in the group at hand; UINT32_MAX: not in it */
    uint *vertices; /* of the group at hand */
} EmissionGroups;

static void groups_sort(const EmissionSplit *split, EmissionGroups *groups)
{
    size_t count = split->mesh->triangle_count, next[GROUPS];
    for (size_t i = 0; i < count; ++i)
        ++groups->first[split->triangles[i].group + 1];
    for (int g = 0; g < GROUPS; ++g) {
        next[g] = groups->first[g];
        groups->first[g + 1] += groups->first[g];
    }
    for (size_t i = 0; i < count; ++i)
        groups->sorted[next[split->triangles[i].group]++] = (uint)i;
}

/* The triangles of one group with the vertices that they use. */
static bool group_extract(const EmissionSplit *split, const EmissionGroups *groups, int group, PlyMesh *out)
{
    const PlyMesh *mesh = split->mesh;
    size_t first = groups->first[group], triangles = groups->first[group + 1] - first, count = 0;
    *out = (PlyMesh){.triangle_count = triangles, .triangles = malloc((3 * triangles + 1) * sizeof(uint))};
    for (size_t i = 0; out->triangles && i < 3 * triangles; ++i) {
        uint vertex = mesh->triangles[3 * groups->sorted[first + i / 3] + i % 3];
        if (groups->number[vertex] == UINT32_MAX) {
            groups->number[vertex] = (uint)count;
            groups->vertices[count++] = vertex;
        }
        out->triangles[i] = groups->number[vertex];
    }
    for (size_t i = 0; i < count; ++i)
        groups->number[groups->vertices[i]] = UINT32_MAX;
    out->vertex_count = count;
    out->positions = rows_pick(mesh->positions, 3 * sizeof(float), groups->vertices, count);
    out->normals = rows_pick(mesh->normals, 3 * sizeof(float), groups->vertices, count);
    out->uvs = rows_pick(mesh->uvs, 2 * sizeof(float), groups->vertices, count);
    return out->triangles && out->positions && (out->normals || !mesh->normals) && out->uvs;
}

static void group_emission(const EmissionSplit *split, const EmissionGroups *groups, int group, double emission[3])
{
    double sum[3] = {0.0, 0.0, 0.0}, area = 0.0;
    for (size_t i = groups->first[group]; i < groups->first[group + 1]; ++i) {
        const EmissiveTriangle *triangle = &split->triangles[groups->sorted[i]];
        for (int k = 0; k < 3; ++k)
            sum[k] += triangle->area * triangle->color[k];
        area += triangle->area;
    }
    for (int k = 0; k < 3; ++k)
        emission[k] = group > 0 && area > 0.0 ? split->material->emission[k] * sum[k] / area : 0.0;
}

static bool group_add(Gltf *gltf, GltfReader *reader, const EmissionSplit *split, const EmissionGroups *groups,
                      int group)
{
    PlyMesh mesh = {0};
    double emission[3];
    bool good = group_extract(split, groups, group, &mesh);
    if (!good)
        reader->failed = !error_memory(reader->error, 32 * split->mesh->vertex_count, "a mesh");
    group_emission(split, groups, group, emission);
    good = good && part_add(gltf, reader, &mesh, emission);
    ply_destroy(&mesh);
    return good;
}

static bool groups_add(Gltf *gltf, GltfReader *reader, const EmissionSplit *split)
{
    EmissionGroups groups = {{0}, NULL, NULL, NULL};
    void *scratch = NULL;
    size_t vertices = split->mesh->vertex_count;
    bool good = gltf_allocate(reader, &scratch, 2 * vertices + split->mesh->triangle_count, sizeof(uint));
    if (good) {
        groups.number = scratch;
        groups.vertices = groups.number + vertices;
        groups.sorted = groups.vertices + vertices;
        memset(groups.number, 0xff, vertices * sizeof(uint));
        groups_sort(split, &groups);
    }
    for (int group = 0; group < GROUPS && good; ++group)
        if (groups.first[group + 1] > groups.first[group])
            good = group_add(gltf, reader, split, &groups, group);
    free(scratch);
    return good;
}

static bool texture_read(Gltf *gltf, GltfReader *reader, EmissionSplit *split)
{
    Image image;
    if (!gltf_image_read(gltf, split->material->emissive_texture.image, &image, reader->error)) {
        reader->failed = true;
        return false;
    }
    split->width = image.width;
    split->height = image.height;
    reader->failed = !image_linear_rgb(&image, &split->texels, reader->error);
    image_destroy(&image);
    return !reader->failed;
}

bool gltf_emission_split(Gltf *gltf, GltfReader *reader, const GltfMaterial *material, PlyMesh *mesh)
{
    EmissionSplit split = {.material = material, .mesh = mesh};
    void *triangles = NULL;
    if (material->emissive_texture.image < 0 || !mesh->uvs || !emits(material))
        return part_add(gltf, reader, mesh, material->emission);
    bool good = gltf_allocate(reader, &triangles, mesh->triangle_count, sizeof *split.triangles) &&
                texture_read(gltf, reader, &split);
    if (good) {
        split.triangles = triangles;
        triangles_classify(&split);
        good = groups_add(gltf, reader, &split);
    }
    free(split.texels);
    free(triangles);
    return good;
}
