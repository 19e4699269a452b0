/* Values that no rendering saves are refused in one sentence, in a file whose checksum is right. */
#include "support/render_fixture.h"
#include "support/test_files.h"
#include "support/test_util.h"

#include "backend_cpu.h"
#include "base/log.h"
#include "chain/chain.h"
#include "mmlt/chain_groups.h"
#include "mmlt/chain_population.h"
#include "mmlt/guide.h"
#include "mmlt/paths_estimator.h"
#include "render/checkpoint.h"
#include "render/layers.h"

#include <math.h>

/* ---- whole checkpoints ------------------------------------------------------------------------------------------- */

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
    {FILE_BEGIN, 2124 + 16 + 8 * DIAGNOSTIC_COUNT, DOUBLE, -1.0, "the estimated error is negative"},
    {PLAN, 0, DOUBLE, (double)NAN, "samples of path tracing per step: NaN was saved"},
    {PLAN, 0, DOUBLE, 1e9, "samples of path tracing per step: 1e+09 was saved"},
    {PLAN, 0, DOUBLE, -0.0, "samples of path tracing per step: -0 was saved"},
    {PLAN, 8, DOUBLE, 1e9, "samples of a pool per step: 1e+09 was saved"},
    {PLAN, 8, DOUBLE, 0.0, "samples of a pool per step: 0 was saved"},
    {PLAN, 32, WORD, 65, "chains of a generation: 65 were saved, but there can be 1 to 64"},
    {PLAN, 32, WORD, 0, "chains of a generation: 0 were saved"},
    {PLAN, 44, WORD, 2, "whether path tracing may go on alone: "},
    {PLAN, 45, DOUBLE, -1.0, "samples of path tracing alone: -1 was saved"},
    {PLAN, 53, DOUBLE, (double)NAN, "the work of path tracing alone: NaN was saved"},
    {PLAN, -4, WORD, 0, "generations: 0 were saved"},
    {PLAN, 93, DOUBLE, 1e9, "samples of path tracing: "},
    {PLAN, 93, DOUBLE, -7.0, "samples of path tracing that are wanted: -7 was saved"},
    {PLAN, 73, WORD, 9, "samples of path tracing: "}, /* the upper half of `done` */
    {PLAN, 133, DOUBLE, (double)INFINITY, "the brightness of a pool: inf was saved"},
    {PLAN, 165, DOUBLE, -1.0, "the brightness of the pilot pool: -1 was saved"},
    {PLAN, 173, DOUBLE, (double)NAN, "the brightness of all pools: NaN was saved"},
    {PLAN, 205, WORD, 9, "the words of a chain: "},
    {PLAN, 213, WORD, 4e9, "chains: 4000000000 were saved, but there can be 0 to 64"},
    {PLAN, 217, DOUBLE, (double)NAN, "the samples behind chains: NaN was saved"},
    {PLAN, 225, DOUBLE, (double)INFINITY, "the brightness of chains: inf was saved"},
    {CHAIN_WORDS, CHAIN_PASS_KEY, WORD, 2, "chain 2 of 2: its path is too short or too long"},
    {CHAIN_WORDS, CHAIN_PASS_KEY, WORD, 33, "chain 2 of 2: its path is too short or too long"},
    {CHAIN_WORDS, CHAIN_PASS_KEY, WORD, 0x503, "chain 2 of 2: its path has more vertices from the light"},
    {CHAIN_WORDS, CHAIN_PASS_LUMINANCE, FLOAT, (double)NAN, "the luminance of its path is negative or not finite"},
    {CHAIN_WORDS, CHAIN_PASS_LUMINANCE, FLOAT, -1.0, "the luminance of its path is negative or not finite"},
    {CHAIN_WORDS, CHAIN_PASS_LUMINANCE, FLOAT, (double)INFINITY, "the luminance of its path is negative or not finite"},
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
    size_t rates = rates_find(bytes, size), chains = rates + 205, words = chains + 28, second;
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

static void quiet(const char *line, void *context)
{
    (void)line;
    (void)context;
}

/* Reads what a checkpoint holds. */
static unsigned char *contents_read(const char *path, size_t *size)
{
    ArchiveMemory memory = {0};
    Archive archive = archive_to_memory(&memory);
    ArchiveReader reader;
    Error error;
    ck_assert(archive_reader_open(&reader, path, &error));
    for (unsigned char byte; archive_bytes(&reader.archive, &byte, 1), !reader.archive.failed;)
        archive_bytes(&archive, &byte, 1);
    archive_reader_close(&reader);
    *size = memory.size;
    return memory.bytes;
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

typedef struct Renderer {
    Scene scene;
    Backend *backend;
} Renderer;

static void renderer_init(Renderer *renderer)
{
    static char path[512];
    const RenderSetup setup = {.path = path, .width = 16, .height = 12};
    Error error = {0};
    snprintf(path, sizeof path, "%s/scenes/cornell.pbrt", test_source_folder());
    fixture_scene(&setup, &renderer->scene);
    renderer->backend = fixture_open(&setup, &renderer->scene, &error);
    ck_assert_ptr_nonnull(renderer->backend);
    log_sink_set(quiet, NULL);
}

static void renderer_destroy(Renderer *renderer)
{
    backend_cpu()->close(renderer->backend);
    scene_destroy(&renderer->scene);
    log_sink_set(NULL, NULL);
}

/* Renders few samples by 64 chains from a checkpoint on, if there is one. *done: receives how many. */
static bool checkpoint_render(const Renderer *renderer, const char *file, uint64_t *done, Error *error)
{
    const RenderOptions options = {.samples = 3,
                                   .max_depth = renderer->scene.settings.max_depth,
                                   .reconstruction = RECONSTRUCTION_SPLAT,
                                   .chains = {.chains = 64},
                                   .checkpoint = {.file = file, .every = 1e9, .resume = file, .anew = true}};
    const RenderTask task = {.integrator = integrator_mmlt(),
                             .scene = &renderer->scene,
                             .backend = {backend_cpu(), renderer->backend},
                             .options = &options};
    const SceneSettings *settings = &renderer->scene.settings;
    RenderResult result;
    Film film;
    ck_assert(film_init(&film, settings->width, settings->height, settings->crop, error));
    bool rendered = render_film(&task, &film, &result, error);
    *done = result.samples;
    film_destroy(&film);
    return rendered;
}

/* Puts a wrong value into a checkpoint. */
static void wrong_put(const WrongValue *wrong, unsigned char *bytes, size_t size)
{
    const float single = (float)wrong->value;
    const uint32_t word = wrong->kind == WORD ? (uint32_t)wrong->value : 0;
    const void *sources[] = {[WORD] = &word, [FLOAT] = &single, [DOUBLE] = &wrong->value};
    memcpy(bytes + place_of(wrong, bytes, size), sources[wrong->kind], wrong->kind == DOUBLE ? 8 : 4);
}

/* Resuming fails with one message that says what is wrong, nothing is rendered, and the file stays as it is. */
START_TEST(test_checkpoint_values)
{
    const WrongValue *wrong = &WRONG[_i];
    static Renderer renderer;
    Error error = {0};
    size_t size, before_size, after_size;
    uint64_t done;
    renderer_init(&renderer);
    ck_assert(checkpoint_render(&renderer, test_path("c"), &done, &error) && done > 0);
    unsigned char *bytes = contents_read(test_path("c"), &size);
    unlink(test_path("c.previous"));
    wrong_put(wrong, bytes, size);
    contents_write(test_path("c"), bytes, size);
    unsigned char *before = test_file_read(test_path("c"), &before_size);
    bool resumed = checkpoint_render(&renderer, test_path("c"), &done, &error);
    unsigned char *after = test_file_read(test_path("c"), &after_size);
    ck_assert_msg(!resumed && strstr(error.message, "c cannot be resumed: ") && strstr(error.message, wrong->message),
                  "not \"%s\", but \"%s\"", wrong->message, resumed ? "" : error.message);
    ck_assert(strstr(error.fix, "it is damaged in spite of its checksum; remove it, and begin again"));
    ck_assert_uint_eq(done, 0);
    ck_assert(after_size == before_size && memcmp(after, before, after_size) == 0);
    ck_assert_int_eq(test_folder_entries(), 1);
    free(after);
    free(before);
    free(bytes);
    renderer_destroy(&renderer);
}
END_TEST

/* ---- parts of a state -------------------------------------------------------------------------------------------- */

typedef void ObjectArchive(Archive *archive, void *object);

/* Saves one object, and restores it to another. Returns the message; NULL: all was restored. */
static const char *object_pass(ObjectArchive *archive, void *saved, void *restored)
{
    static Error error;
    ArchiveMemory memory = {0};
    Archive saving = archive_to_memory(&memory);
    ArchiveReader reader;
    archive(&saving, saved);
    ck_assert(!saving.failed);
    contents_write(test_path("object"), memory.bytes, memory.size);
    archive_memory_destroy(&memory);
    ck_assert(archive_reader_open(&reader, test_path("object"), &error));
    archive(&reader.archive, restored);
    bool good = archive_reader_finish(&reader, &error);
    archive_reader_close(&reader);
    return good ? NULL : error.message;
}

/* Whether object_pass fails with a message that holds this text. */
#define REFUSED(archive, saved, restored, text)                                                                        \
    do {                                                                                                               \
        const char *message = object_pass(archive, saved, restored);                                                   \
        ck_assert_msg(message &&strstr(message, text), "%s", message ? message : "restored");                          \
    } while (0)

static void layers_pass(Archive *archive, void *layers)
{
    render_layers_archive(archive, layers);
}

/* NaN and other values that would be in the EXR. Infinite spreads are those of bright light. */
START_TEST(test_layers)
{
    const unsigned wanted = LAYER_BIT(LAYER_VARIANCE) | LAYER_BIT(LAYER_ALBEDO);
    const int crop[4] = {0, 0, 20, 12};
    RenderLayers saved, restored;
    Film film;
    Error error;
    ck_assert(film_init(&film, 20, 12, crop, &error));
    ck_assert(render_layers_init(&saved, wanted, false, &film, &error));
    ck_assert(render_layers_init(&restored, wanted, false, &film, &error));
    saved.light[0].spread[7] = (float)INFINITY;
    ck_assert_ptr_null(object_pass(layers_pass, &saved, &restored));
    ck_assert(isinf(restored.light[0].spread[7]));
    const struct {
        float *number;
        float wrong;
        const char *message;
    } CASES[] = {
        {&saved.own[0].mean[5], (float)NAN, "the means of a series of images: NaN"},
        {&saved.own[1].mean[5], (float)INFINITY, "the means of a series of images: inf"},
        {&saved.own[1].spread[6], (float)NAN, "the spreads of a series of images: NaN"},
        {&saved.light[0].spread[6], -(float)INFINITY, "the spreads of a series of images: -inf"},
        {&saved.light[1].weight[0], -1.0f, "the weights of a series of images: -1"},
        {&saved.stratified[0][5], (float)NAN, "the parts left of variances: NaN"},
        {&saved.stratified[1][5], 1.5f, "the parts left of variances: 1.5"},
        {&saved.aovs[AOV_ALBEDO].sums[9], (float)NAN, "the values of a layer: NaN"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; ++i) {
        const float kept = *CASES[i].number;
        *CASES[i].number = CASES[i].wrong;
        REFUSED(layers_pass, &saved, &restored, CASES[i].message);
        *CASES[i].number = kept;
    }
    ck_assert_ptr_null(object_pass(layers_pass, &saved, &restored));
    render_layers_destroy(&saved);
    render_layers_destroy(&restored);
    film_destroy(&film);
}
END_TEST

static const int VISITED_SIZE[2] = {48, 20}; /* cells of two pixels, of one and of none */

static void visits_pass(Archive *archive, void *visits)
{
    importance_visits_archive(archive, visits, VISITED_SIZE);
}

/* Fills in the visits of cells, each of whose pixels has `each` of them. */
static void visits_set(uint visits[IMPORTANCE_CELLS + 1], uint each)
{
    visits[0] = 0;
    for (uint cell = 0; cell < IMPORTANCE_CELLS; ++cell) {
        uint column = cell % IMPORTANCE_SIDE, row = cell / IMPORTANCE_SIDE;
        uint pixels =
            (cell_begin(column + 1, 48) - cell_begin(column, 48)) * (cell_begin(row + 1, 20) - cell_begin(row, 20));
        visits[cell + 1] = visits[cell] + pixels * each;
    }
}

/* Cells that begin elsewhere, pixels without visits or with too many, and with a part of one. */
START_TEST(test_visits)
{
    static const char MESSAGE[] = "the visits of a pool's pixels do not add up";
    uint saved[IMPORTANCE_CELLS + 1], restored[IMPORTANCE_CELLS + 1];
    for (uint each = 1; each <= VISITS_MOST; each += VISITS_MOST - 1) {
        visits_set(saved, each);
        ck_assert_ptr_null(object_pass(visits_pass, saved, restored));
        ck_assert_mem_eq(saved, restored, sizeof saved);
    }
    visits_set(saved, VISITS_MOST + 1);
    REFUSED(visits_pass, saved, restored, MESSAGE);
    visits_set(saved, 2);
    for (uint cell = 0; cell <= IMPORTANCE_CELLS; ++cell)
        ++saved[cell];
    REFUSED(visits_pass, saved, restored, MESSAGE);
    visits_set(saved, 2);
    for (uint cell = 1; cell <= IMPORTANCE_CELLS; ++cell)
        saved[cell] -= 4; /* all of the first cell's */
    REFUSED(visits_pass, saved, restored, MESSAGE);
    visits_set(saved, 2);
    for (uint cell = 1; cell <= IMPORTANCE_CELLS; ++cell)
        ++saved[cell]; /* of one of the first cell's two pixels */
    REFUSED(visits_pass, saved, restored, MESSAGE);
    saved[IMPORTANCE_CELLS] = 0; /* all pixels alike, whatever the others are */
    ck_assert_ptr_null(object_pass(visits_pass, saved, restored));
}
END_TEST

static void population_pass(Archive *archive, void *population)
{
    chain_population_archive(archive, population, (PopulationLimits){.chains = 9, .depth = 7});
}

/* Paths are too short for chains: then there are no words, and there can be none. */
START_TEST(test_no_words)
{
    ChainPopulation saved, restored;
    chain_population_init(&saved, 0);
    chain_population_init(&restored, 0);
    ck_assert_ptr_null(object_pass(population_pass, &saved, &restored));
    saved.count = 3;
    saved.brightness = 1.0;
    REFUSED(population_pass, &saved, &restored, "chains: 3 were saved, but there can be 0 to 0");
}
END_TEST

static void paths_pass(Archive *archive, void *paths)
{
    paths_estimator_archive(archive, paths);
}

/* As many samples as there can be, or more. */
START_TEST(test_most_samples)
{
    const uint64_t most = film_samples_most(RECONSTRUCTION_SAMPLE);
    Film film = {.reconstruction = RECONSTRUCTION_SAMPLE};
    PathsEstimator saved = {.own = {.film = &film}, .done = most, .wanted = 2.0 * (double)most}, restored = saved;
    ck_assert_ptr_null(object_pass(paths_pass, &saved, &restored));
    ++saved.done;
    REFUSED(paths_pass, &saved, &restored, "samples of path tracing: ");
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("restore");
    TCase *tcase = tcase_create("restore");
    tcase_set_timeout(tcase, 60.0);
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_loop_test(tcase, test_checkpoint_values, 0, sizeof WRONG / sizeof WRONG[0]);
    tcase_add_test(tcase, test_layers);
    tcase_add_test(tcase, test_visits);
    tcase_add_test(tcase, test_no_words);
    tcase_add_test(tcase, test_most_samples);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
