/* A rendering that is stopped at any of its passes and resumed, again and again, ends with the same sums as one that runs
 * through. */
#include "support/render_fixture.h"
#include "support/test_files.h"
#include "support/test_util.h"

#include "backend_cpu.h"
#include "base/log.h"
#include "chain/chain.h"
#include "mmlt/chain_groups.h"
#include "render/checkpoint.h"
#include "render/layers.h"

/* ---- a backend that stops ---------------------------------------------------------------------------------------- */

static atomic_int stop;
static int passes_left; /* until it sets `stop` */
static bool stops_before; /* before that pass, of which nothing is then done; else after it */

static bool pass_run(Backend *backend, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                     const atomic_int *stopped, uint64_t *items_done, Error *error)
{
    bool last = --passes_left == 0;
    if (last && stops_before)
        atomic_store(&stop, 1);
    bool done = backend_cpu()->run(backend, frame, list, sink, stopped, items_done, error);
    if (last)
        atomic_store(&stop, 1);
    return done;
}

/* ---- renderings -------------------------------------------------------------------------------------------------- */

typedef struct CheckpointCase {
    const char *scene;
    const Integrator *(*integrator)(void);
    unsigned samples, photons, layers;
    ChainOptions chains;
    double error; /* goal; 0: none */
} CheckpointCase;

static const CheckpointCase CASES[] = {
    {"cornell", integrator_pt, 160, 0, LAYER_BIT(LAYER_ALBEDO) | LAYER_BIT(LAYER_DEPTH), {0}, 0.0},
    {"pool", integrator_pt, 40, 2000, 0, {0}, 0.0},
    {"cornell", integrator_ibpt, 60, 0, 0, {0}, 0.0},
    {"cornell", integrator_bdpt, 60, 0, 0, {0}, 0.0},
    {"cornell", integrator_mmlt, 150, 0, 0, {.chains = 64}, 0.0},
    {"pool", integrator_mmlt, 30, 2000, LAYERS_AOV, {0}, 0.0},
    {"cornell", integrator_mmlt, 100, 0, LAYER_BIT(LAYER_HALVES) | LAYER_BIT(LAYER_VARIANCE), {.chains = 128}, 0.0},
    {"cornell", integrator_mmlt, 100, 0, LAYER_BIT(LAYER_BY_DEPTH), {0}, 0.0},
    {"cornell", integrator_mmlt, 100, 0, 0, {.paper = true, .chains = 256}, 0.0},
    {"cornell", integrator_mmlt, 100, 0, 0, {.chains_only = true}, 0.0},
    {"cornell", integrator_pt, 0, 0, 0, {0}, 0.04},
    {"cornell", integrator_mmlt, 0, 0, LAYER_BIT(LAYER_HALVES), {0}, 0.08},
};

typedef struct Rendering {
    const CheckpointCase *of;
    Scene scene;
    Backend *backends[2]; /* of one thread and of three */
    BackendInterface interface;
    Film film;
    RenderLayers layers;
    RenderResult result;
} Rendering;

static void rendering_begin(Rendering *rendering, const CheckpointCase *of)
{
    static char path[512];
    Error error = {0};
    snprintf(path, sizeof path, "%s/scenes/%s.pbrt", test_source_folder(), of->scene);
    *rendering = (Rendering){.of = of, .interface = *backend_cpu()};
    const RenderSetup setup = {.path = path, .width = 32, .height = 24};
    fixture_scene(&setup, &rendering->scene);
    for (int i = 0; i < 2; ++i) {
        const RenderSetup threads = {.threads = 1 + 2 * i};
        rendering->backends[i] = fixture_open(&threads, &rendering->scene, &error);
        ck_assert_msg(rendering->backends[i] != NULL, "%s", error.message);
    }
    rendering->interface.run = pass_run;
}

static void images_destroy(Rendering *rendering)
{
    render_layers_destroy(&rendering->layers);
    film_destroy(&rendering->film);
}

static void rendering_end(Rendering *rendering)
{
    images_destroy(rendering);
    for (int i = 0; i < 2; ++i)
        rendering->interface.close(rendering->backends[i]);
    scene_destroy(&rendering->scene);
}

/* Renders until the end or the given pass, to a new film. checkpoint: its file; NULL: none. */
static bool rendering_run(Rendering *rendering, int passes, const char *checkpoint, int backend, Error *error)
{
    const CheckpointCase *of = rendering->of;
    const SceneSettings *settings = &rendering->scene.settings;
    images_destroy(rendering);
    rendering->layers.wanted = of->layers;
    const RenderOptions options = {
        .samples = of->samples,
        .max_depth = settings->max_depth,
        .photons = of->photons,
        .reconstruction = RECONSTRUCTION_SPLAT,
        .chains = of->chains,
        .layers = of->layers != 0 || of->error > 0.0 ? &rendering->layers : NULL,
        .error = {.goal = of->error, .scale = 1.0},
        .checkpoint = {.file = checkpoint, .every = 0.02, .resume = checkpoint, .anew = true},
        .stop = &stop};
    const RenderTask task = {.integrator = of->integrator(),
                             .scene = &rendering->scene,
                             .backend = {&rendering->interface, rendering->backends[backend]},
                             .options = &options};
    atomic_store(&stop, 0);
    passes_left = passes;
    return film_init(&rendering->film, settings->width, settings->height, settings->crop, error) &&
           render_film(&task, &rendering->film, &rendering->result, error);
}

/* ---- comparison -------------------------------------------------------------------------------------------------- */

static void films_compare(const Film *a, const Film *b)
{
    size_t bytes = 3 * film_pixels(a) * sizeof *a->sums;
    ck_assert_int_eq(a->quantum_exponent, b->quantum_exponent);
    ck_assert(memcmp(a->sums, b->sums, bytes) == 0);
    ck_assert(!a->light_sums == !b->light_sums);
    ck_assert(!a->light_sums || memcmp(a->light_sums, b->light_sums, bytes) == 0);
    ck_assert(memcmp(a->counts, b->counts, film_pixels(a) * sizeof *a->counts) == 0);
    ck_assert_uint_eq(a->light_samples, b->light_samples);
    ck_assert_uint_eq(a->vanished, b->vanished);
    ck_assert_uint_eq(a->saturated, b->saturated);
    for (uint depth = SPLAT_DEPTH_MIN; a->depth_sums && depth <= a->depth_last; ++depth)
        ck_assert(memcmp(film_depth_sums(a, depth, 0), film_depth_sums(b, depth, 0), bytes) == 0);
}

static void layers_compare(const Rendering *a, const Rendering *b)
{
    size_t pixels = film_pixels(&a->film), bytes = 3 * pixels * sizeof(float);
    float *values[2] = {malloc(bytes), malloc(bytes)};
    if ((a->of->layers & LAYER_BIT(LAYER_HALVES)) != 0)
        for (int i = 0; i < 2; ++i)
            films_compare(&a->layers.halves[i], &b->layers.halves[i]);
    if ((a->of->layers & LAYER_BIT(LAYER_VARIANCE)) != 0) {
        render_layers_variance(&a->layers, 1.0f, 0, pixels, values[0]);
        render_layers_variance(&b->layers, 1.0f, 0, pixels, values[1]);
        ck_assert(memcmp(values[0], values[1], bytes) == 0);
    }
    for (int aov = 0; aov < AOV_COUNT; ++aov)
        if (a->layers.aovs[aov].sums) {
            aov_image_resolve(&a->layers.aovs[aov], 0, pixels, values[0]);
            aov_image_resolve(&b->layers.aovs[aov], 0, pixels, values[1]);
            ck_assert(memcmp(values[0], values[1], bytes) == 0);
        }
    ck_assert_uint_eq(a->layers.aov_samples, b->layers.aov_samples);
    free(values[0]);
    free(values[1]);
}

/* ---- tests ------------------------------------------------------------------------------------------------------- */

static void quiet(const char *line, void *context)
{
    (void)line;
    (void)context;
}

/* After which of its passes the r-th process stops: ever later ones, then after about a generation of MMLT. Photons are traced
 * anew by each process, in passes that do not count as progress. */
static int passes_of(const CheckpointCase *of, int process)
{
    bool generations = of->integrator == integrator_mmlt && of->photons == 0;
    return !generations || process < 8 ? process : 3 + process % 3;
}

static void stopped_compare(const CheckpointCase *of, bool before)
{
    static Rendering through, resumed;
    Error error = {0};
    int processes = 0;
    log_sink_set(quiet, NULL);
    stops_before = before;
    rendering_begin(&through, of);
    rendering_begin(&resumed, of);
    ck_assert_msg(rendering_run(&through, -1, NULL, 0, &error), "%s", error.message);
    do {
        ++processes;
        ck_assert_msg(rendering_run(&resumed, passes_of(of, processes), test_path("c"), processes % 2, &error), "%s",
                      error.message);
        ck_assert_int_lt(processes, 1000);
    } while (resumed.result.stopped);
    printf("%s, %s: %d processes\n", of->integrator()->name, before ? "stopped before passes" : "after", processes);
    ck_assert_int_gt(processes, 2);
    films_compare(&through.film, &resumed.film);
    layers_compare(&through, &resumed);
    ck_assert_uint_eq(through.result.samples, resumed.result.samples);
    ck_assert_mem_eq(through.result.chains.accepted, resumed.result.chains.accepted,
                     sizeof through.result.chains.accepted);
    ck_assert_mem_eq(through.result.chains.r_hat, resumed.result.chains.r_hat, sizeof through.result.chains.r_hat);
    ck_assert_uint_eq(through.result.chains.pool_samples, resumed.result.chains.pool_samples);
    rendering_end(&through);
    rendering_end(&resumed);
    log_sink_set(NULL, NULL);
}

START_TEST(test_stopped)
{
    stopped_compare(&CASES[_i], false);
    ck_assert_int_eq(unlink(test_path("c")), 0);
    unlink(test_path("c.previous"));
    stopped_compare(&CASES[_i], true);
}
END_TEST

/* Reads what a checkpoint holds. */
static unsigned char *contents_read(const char *path, size_t *size)
{
    const size_t most = 1 << 22;
    unsigned char *bytes = calloc(1, most);
    ArchiveReader reader;
    Error error;
    ck_assert_ptr_nonnull(bytes);
    ck_assert(archive_reader_open(&reader, path, &error));
    for (*size = 0; *size < most && !reader.archive.failed; *size += !reader.archive.failed)
        archive_bytes(&reader.archive, bytes + *size, 1);
    archive_reader_close(&reader);
    return bytes;
}

static void contents_write(const char *path, unsigned char *bytes, size_t size)
{
    ArchiveWriter writer;
    Error error;
    ck_assert(archive_writer_begin(&writer, path, 1, &error));
    archive_bytes(&writer.archive, bytes, size);
    ck_assert(archive_writer_finish(&writer, &error) && output_file_commit(&writer.file, &error));
    archive_writer_destroy(&writer);
}

/* States that are too short or too long in a file whose checksum is right. */
START_TEST(test_other_sizes)
{
    static Rendering rendering;
    Error error = {0};
    size_t size;
    rendering_begin(&rendering, &CASES[6]);
    log_sink_set(quiet, NULL);
    ck_assert(rendering_run(&rendering, -1, test_path("c"), 1, &error));
    unlink(test_path("c.previous"));
    unsigned char *bytes = contents_read(test_path("c"), &size);
    for (size_t length = 0; length <= size + 1; length += length + 1 == size ? 2 : (size - length) / 3 + 1) {
        contents_write(test_path("c"), bytes, length);
        TEST_TRUE(!rendering_run(&rendering, -1, test_path("c"), 1, &error));
        TEST_TRUE(strstr(error.message, "cannot be resumed"));
        TEST_TRUE(rendering.result.samples == 0);
    }
    free(bytes);
    rendering_end(&rendering);
    log_sink_set(NULL, NULL);
}
END_TEST

/* ---- wrong values and a right checksum ---------------------------------------------------------------------------- */

/* What an offset is counted from. */
typedef enum Place {
    FILE_BEGIN, /* bytes; the head has 2088 */
    PLAN, /* bytes from its rates on */
    CHAIN_WORDS, /* CHAIN_PASS_*, of the second chain of the first replica */
    GUIDE, /* bytes from the target importance of the first replica on */
    PLACES
} Place;

typedef enum ValueKind { WORD, FLOAT, DOUBLE } ValueKind;

typedef struct WrongValue {
    Place place;
    long offset;
    ValueKind kind;
    double value;
    const char *message;
} WrongValue;

static const WrongValue WRONG[] = {
    {FILE_BEGIN, 2088, WORD, 5000, "the film's quantum is out of range"},
    {FILE_BEGIN, 2100, DOUBLE, (double)NAN, "seconds of rendering: NaN was saved"},
    {FILE_BEGIN, 2100, DOUBLE, 1e300, "seconds of rendering: 1e+300 was saved"},
    {FILE_BEGIN, 2112, WORD, 4e9, "photons: 4000000000 were saved"},
    {FILE_BEGIN, 2116 + 16 + 8 * DIAGNOSTIC_COUNT, DOUBLE, -1.0, "the estimated error is negative"},
    {PLAN, 0, DOUBLE, (double)NAN, "samples of path tracing per step: NaN was saved"},
    {PLAN, 0, DOUBLE, 1e9, "samples of path tracing per step: 1e+09 was saved"},
    {PLAN, 8, DOUBLE, 1e9, "samples of a pool per step: 1e+09 was saved"},
    {PLAN, 8, DOUBLE, 0.0, "samples of a pool per step: 0 was saved"},
    {PLAN, 32, WORD, 65, "chains of a generation: 65 were saved, but there can be 1 to 64"},
    {PLAN, 32, WORD, 0, "chains of a generation: 0 were saved"},
    {PLAN, -4, WORD, 0, "generations: 0 were saved"},
    {PLAN, 76, DOUBLE, 1e9, "samples of path tracing: "},
    {PLAN, 76, DOUBLE, -7.0, "samples of path tracing that are wanted: -7 was saved"},
    {PLAN, 56, WORD, 9, "samples of path tracing: "}, /* the upper half of `done` */
    {PLAN, 116, DOUBLE, (double)INFINITY, "the brightness of a pool: inf was saved"},
    {PLAN, 148, DOUBLE, -1.0, "the brightness of the pilot pool: -1 was saved"},
    {PLAN, 156, DOUBLE, (double)NAN, "the brightness of all pools: NaN was saved"},
    {PLAN, 180, WORD, 9, "the words of a chain: "},
    {PLAN, 188, WORD, 4e9, "chains: 4000000000 were saved, but there can be 0 to 64"},
    {PLAN, 192, DOUBLE, (double)NAN, "the samples behind chains: NaN was saved"},
    {PLAN, 200, DOUBLE, (double)INFINITY, "the brightness of chains: inf was saved"},
    {CHAIN_WORDS, CHAIN_PASS_KEY, WORD, 2, "chain 2 of 8: its path is too short or too long"},
    {CHAIN_WORDS, CHAIN_PASS_KEY, WORD, 33, "chain 2 of 8: its path is too short or too long"},
    {CHAIN_WORDS, CHAIN_PASS_KEY, WORD, 0x503, "chain 2 of 8: its path has more vertices from the light"},
    {CHAIN_WORDS, CHAIN_PASS_LUMINANCE, FLOAT, (double)NAN, "the luminance of its path is negative or not finite"},
    {CHAIN_WORDS, CHAIN_PASS_LUMINANCE, FLOAT, -1.0, "the luminance of its path is negative or not finite"},
    {CHAIN_WORDS, CHAIN_PASS_CELL, WORD, IMPORTANCE_CELLS, "its place on the film does not exist"},
    {GUIDE, 0, FLOAT, 0.0, "the target importance: 0 was saved"},
    {GUIDE, 4, FLOAT, (double)NAN, "the target importance: NaN was saved"},
    {GUIDE, 4 * (3 * IMPORTANCE_CELLS), WORD, 5, "the visits of a pool's pixels do not add up"},
    {GUIDE, 4 * (2 * IMPORTANCE_CELLS + IMPORTANCE_CELLS), WORD, 5, "the visits of a pool's pixels do not add up"},
};

/* Where the rates of a plan that has learnt nothing yet are. */
static size_t rates_find(const unsigned char *bytes, size_t size)
{
    const double rates[2] = {1.0, 1.0 / 12.0};
    const unsigned char *found = memmem(bytes, size, rates, sizeof rates);
    ck_assert_ptr_nonnull(found);
    ck_assert_ptr_null(memmem(found + 1, size - (size_t)(found + 1 - bytes), rates, sizeof rates));
    return (size_t)(found - bytes);
}

/* The size of the population that begins with the number of a chain's words. */
static size_t population_bytes(const unsigned char *population)
{
    uint64_t words;
    uint32_t count;
    memcpy(&words, population, sizeof words);
    memcpy(&count, population + sizeof words, sizeof count);
    return sizeof words + sizeof count + 2 * sizeof(double) + words * count * sizeof(uint);
}

static size_t place_of(const WrongValue *wrong, const unsigned char *bytes, size_t size)
{
    size_t rates = rates_find(bytes, size), chains = rates + 180, words = chains + 28, second;
    uint32_t count;
    memcpy(&count, bytes + chains + 8, sizeof count);
    second = chains + population_bytes(bytes + chains);
    const size_t places[PLACES] = {[FILE_BEGIN] = 0,
                                   [PLAN] = rates,
                                   [CHAIN_WORDS] = words + 4,
                                   [GUIDE] = second + population_bytes(bytes + second) + sizeof(ChainGroups)};
    long scale = wrong->place == CHAIN_WORDS ? 4 * (long)count : 1;
    return (size_t)((long)places[wrong->place] + wrong->offset * scale);
}

/* Resuming fails with one message that says what is wrong, and changes neither the file nor the picture. */
START_TEST(test_wrong_values)
{
    static const CheckpointCase FEW = {"cornell", integrator_mmlt, 3, 0, 0, {.chains = 64}, 0.0};
    static Rendering rendering;
    Error error = {0};
    size_t size, written_size, kept_size;
    rendering_begin(&rendering, &FEW);
    log_sink_set(quiet, NULL);
    ck_assert(rendering_run(&rendering, -1, test_path("c"), 1, &error));
    unlink(test_path("c.previous"));
    unsigned char *bytes = contents_read(test_path("c"), &size), *kept = malloc(size);
    for (size_t i = 0; i < sizeof WRONG / sizeof WRONG[0]; ++i) {
        const WrongValue *wrong = &WRONG[i];
        const float single = (float)wrong->value;
        const uint32_t word = wrong->kind == WORD ? (uint32_t)wrong->value : 0;
        const void *sources[] = {[WORD] = &word, [FLOAT] = &single, [DOUBLE] = &wrong->value};
        memcpy(kept, bytes, size);
        memcpy(kept + place_of(wrong, bytes, size), sources[wrong->kind], wrong->kind == DOUBLE ? 8 : 4);
        contents_write(test_path("c"), kept, size);
        unsigned char *written = test_file_read(test_path("c"), &written_size);
        bool resumed = rendering_run(&rendering, -1, test_path("c"), 1, &error);
        if (resumed || !strstr(error.message, "c cannot be resumed: ") || !strstr(error.message, wrong->message))
            ck_abort_msg("not \"%s\" but \"%s\"", wrong->message, resumed ? "" : error.message);
        TEST_TRUE(rendering.result.samples == 0);
        unsigned char *left = test_file_read(test_path("c"), &kept_size);
        TEST_TRUE(kept_size == written_size && memcmp(left, written, kept_size) == 0);
        free(left);
        free(written);
    }
    free(kept);
    free(bytes);
    rendering_end(&rendering);
    log_sink_set(NULL, NULL);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("checkpoint");
    TCase *tcase = tcase_create("checkpoint");
    tcase_set_timeout(tcase, 120.0);
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_loop_test(tcase, test_stopped, 0, sizeof CASES / sizeof CASES[0]);
    tcase_add_test(tcase, test_other_sizes);
    tcase_add_test(tcase, test_wrong_values);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
