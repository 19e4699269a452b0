#include "bench/record.h"

#include "base/file_read.h"
#include "base/output_file.h"

#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define RECORD_HEAD "twinlight bench record 1"
#define RECORD_END "end"
#define RECORD_SIZE_MAX 65536

typedef struct Field {
    const char *name;
    size_t offset;
    bool whole; /* uint64_t, otherwise double */
} Field;

#define NUMBER(member)                                                                                                 \
    {                                                                                                                  \
#member, offsetof(BenchRecord, member), false                                                                  \
    }
#define WHOLE(member)                                                                                                  \
    {                                                                                                                  \
#member, offsetof(BenchRecord, member), true                                                                   \
    }

static const Field FIELDS[] = {
    NUMBER(seconds),
    NUMBER(load),
    NUMBER(build),
    NUMBER(write),
    NUMBER(samples_per_pixel),
    NUMBER(ray_seconds),
    WHOLE(samples),
    WHOLE(closest_rays),
    WHOLE(shadow_rays),
    WHOLE(threads),
    WHOLE(saturated),
    WHOLE(not_finite),
    WHOLE(diagnostics),
    WHOLE(chains.pool_samples),
    WHOLE(chains.seeds),
    WHOLE(chains.steps),
    NUMBER(chains.least_distinct),
    NUMBER(chains.pool_seconds),
    NUMBER(chains.chain_seconds),
    NUMBER(chains.direct_seconds),
    NUMBER(chains.bidirectional_seconds),
    NUMBER(chains.weights[0]),
    NUMBER(chains.weights[1]),
    NUMBER(chains.weights[2]),
    NUMBER(chains.weights[3]),
};

#define FIELD_COUNT (sizeof FIELDS / sizeof FIELDS[0])

/* ---- writing ---------------------------------------------------------------------------------------------------- */

static void fields_print(FILE *stream, const BenchRecord *record)
{
    for (size_t i = 0; i < FIELD_COUNT; ++i) {
        const char *at = (const char *)record + FIELDS[i].offset;
        if (FIELDS[i].whole)
            fprintf(stream, "%s %" PRIu64 "\n", FIELDS[i].name, *(const uint64_t *)(const void *)at);
        else
            fprintf(stream, "%s %.17g\n", FIELDS[i].name, *(const double *)(const void *)at);
    }
}

static void mutations_print(FILE *stream, const ChainStatistics *chains)
{
    for (int kind = 0; kind < CHAIN_KINDS; ++kind)
        for (int depth = 0; depth < CHAIN_DEPTHS; ++depth)
            if (chains->proposals[kind][depth] > 0)
                fprintf(stream, "mutation %d %d %" PRIu64 " %" PRIu64 "\n", kind, depth, chains->proposals[kind][depth],
                        chains->accepted[kind][depth]);
}

static void depths_print(FILE *stream, const ChainStatistics *chains)
{
    for (int depth = 0; depth < CHAIN_DEPTHS; ++depth)
        if (chain_statistics_proposals(chains, depth) > 0)
            fprintf(stream, "depth %d %" PRIu64 " %" PRIu64 " %" PRIu64 " %.17g\n", depth, chains->longest_run[depth],
                    chains->starts[depth], chains->distinct_starts[depth], chains->r_hat[depth]);
}

static void record_path(char path[PATH_MAX], const char *image)
{
    snprintf(path, PATH_MAX, "%.*s.record", PATH_MAX - 8, image);
}

bool bench_record_write(const char *image, const BenchRecord *record, Error *error)
{
    char path[PATH_MAX], *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream)
        return error_errno(error, "make", "a record");
    fprintf(stream, RECORD_HEAD "\ndevice %s\n", record->device);
    fields_print(stream, record);
    mutations_print(stream, &record->chains);
    depths_print(stream, &record->chains);
    fputs(RECORD_END "\n", stream);
    bool whole = fclose(stream) == 0;
    record_path(path, image);
    whole = whole ? output_file_write(path, text, size, error) : error_errno(error, "make", "a record");
    free(text);
    return whole;
}

/* ---- reading ---------------------------------------------------------------------------------------------------- */

static void field_read(BenchRecord *record, const char *name, const char *value)
{
    for (size_t i = 0; i < FIELD_COUNT; ++i) {
        if (strcmp(FIELDS[i].name, name) != 0)
            continue;
        char *at = (char *)record + FIELDS[i].offset;
        if (FIELDS[i].whole)
            *(uint64_t *)(void *)at = strtoull(value, NULL, 10);
        else
            *(double *)(void *)at = strtod(value, NULL);
    }
}

static void mutation_read(ChainStatistics *chains, const char *value)
{
    char *end;
    unsigned long kind = strtoul(value, &end, 10), depth = strtoul(end, &end, 10);
    uint64_t proposals = strtoull(end, &end, 10), accepted = strtoull(end, &end, 10);
    if (kind >= CHAIN_KINDS || depth >= CHAIN_DEPTHS)
        return;
    chains->proposals[kind][depth] = proposals;
    chains->accepted[kind][depth] = accepted;
}

static void depth_read(ChainStatistics *chains, const char *value)
{
    char *end;
    unsigned long depth = strtoul(value, &end, 10);
    if (depth >= CHAIN_DEPTHS)
        return;
    chains->longest_run[depth] = strtoull(end, &end, 10);
    chains->starts[depth] = strtoull(end, &end, 10);
    chains->distinct_starts[depth] = strtoull(end, &end, 10);
    chains->r_hat[depth] = strtod(end, &end);
}

/* Reads a line; returns whether it is the end mark. */
static bool line_read(BenchRecord *record, char *line)
{
    char *value = strchr(line, ' ');
    if (!value)
        return strcmp(line, RECORD_END) == 0;
    *value++ = '\0';
    if (strcmp(line, "device") == 0)
        snprintf(record->device, sizeof record->device, "%s", value);
    else if (strcmp(line, "mutation") == 0)
        mutation_read(&record->chains, value);
    else if (strcmp(line, "depth") == 0)
        depth_read(&record->chains, value);
    else
        field_read(record, line, value);
    return false;
}

bool bench_record_read(const char *image, BenchRecord *record)
{
    char path[PATH_MAX];
    Error none = {0};
    FileData file = {0};
    record_path(path, image);
    *record = (BenchRecord){0};
    if (access(image, R_OK) != 0 || !file_read(path, RECORD_SIZE_MAX, (SourcePlace){NULL, 0, 0}, &file, &none))
        return false;
    bool ended = false;
    char *text = strndup(file.data, file.size), *rest = text, *line = text ? strsep(&rest, "\n") : NULL;
    if (line && strcmp(line, RECORD_HEAD) == 0)
        while (!ended && (line = strsep(&rest, "\n")) != NULL)
            ended = line_read(record, line);
    free(text);
    free(file.data);
    return ended && record->seconds > 0.0;
}
