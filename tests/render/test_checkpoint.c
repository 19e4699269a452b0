/* A rendering that is stopped at any of its passes and resumed, again and again, ends with the same sums as one that
 * runs through. */
#include "support/render_fixture.h"
#include "support/test_files.h"
#include "support/test_util.h"

#include "backend_cpu.h"
#include "base/log.h"
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
    ck_assert_uint_eq(a->every_count, b->every_count);
    ck_assert_uint_eq(a->light_samples, b->light_samples);
    ck_assert_uint_eq(a->complete_samples, b->complete_samples);
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

/* After which of its passes the r-th process stops: ever later ones, then after about a generation of MMLT. Photons are
 * traced anew by each process, in passes that do not count as progress. */
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

int main(void)
{
    Suite *suite = suite_create("checkpoint");
    TCase *tcase = tcase_create("checkpoint");
    tcase_set_timeout(tcase, 120.0);
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_test(tcase, test_other_sizes);
    suite_add_tcase(suite, tcase);
    TCase *stopped = tcase_create("stopped");
    tcase_set_timeout(stopped, 120.0);
    tcase_set_tags(stopped, "pictures");
    tcase_add_checked_fixture(stopped, test_folder_make, test_folder_remove);
    tcase_add_loop_test(stopped, test_stopped, 0, sizeof CASES / sizeof CASES[0]);
    suite_add_tcase(suite, stopped);
    return test_run(suite);
}
