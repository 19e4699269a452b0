/* Checkpoints with wrong values and a right checksum: a small rendering is resumed, or begun with a pilot, and goes on
 * for two generations of mmlt or some passes of the others. The first byte of an input says of which rendering (CASES);
 * each 13 bytes that follow replace a value (Change) of its checkpoint, which the program itself has made, so that
 * inputs outlive changes of the format. */
#include "fuzz/fuzz.h"
#include "fuzz/fuzz_file.h"

#include "backend_cpu.h"
#include "base/archive_file.h"
#include "base/log.h"
#include "pbrt/import.h"
#include "render/identity.h"
#include "render/layers.h"
#include "render/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the renderings ---------------------------------------------------------------------------------------------- */

typedef struct FuzzCase {
    const Integrator *(*integrator)(void);
    unsigned layers;
    ChainOptions chains;
    double error; /* goal; 0: none */
    bool pilot; /* a shard begins with the checkpoint */
    int passes_before, passes_after; /* the checkpoint */
} FuzzCase;

#define CHAINS .chains = 8, .steps = 8

/* After 16 passes of mmlt five generations are complete, and the next renews its importance and visits; after 21 there
 * are seven, and it does not. */
static const FuzzCase CASES[] = {
    {integrator_mmlt, LAYERS_AOV, {CHAINS}, 0.0, false, 16, 6},
    {integrator_mmlt, LAYERS_ALL, {CHAINS}, 1e-4, false, 21, 6},
    {integrator_mmlt, LAYER_BIT(LAYER_BY_DEPTH), {CHAINS}, 0.0, false, 21, 6},
    {integrator_mmlt, 0, {CHAINS, .chains_only = true}, 0.0, false, 16, 6},
    {integrator_mmlt, 0, {CHAINS, .paper = true}, 0.0, false, 16, 6},
    {integrator_mmlt, 0, {CHAINS}, 0.0, true, 21, 6},
    {integrator_pt, LAYER_BIT(LAYER_ALBEDO), {0}, 1e-4, false, 2, 1},
    {integrator_bdpt, LAYERS_AOV, {0}, 0.0, false, 2, 1},
};
#define CASE_COUNT (sizeof CASES / sizeof CASES[0])

/* A floor, a wall of metal and a ball of frosted glass, lit by a lamp and a point light. Without smooth surfaces, so
 * that any number of photons takes no time. */
static const char SCENE[] =
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6\n"
    "LookAt 0 1 -4  0 1 0  0 1 0\n"
    "Camera \"perspective\" \"float fov\" 50\n"
    "WorldBegin\n"
    "LightSource \"point\" \"point3 from\" [ 1 2 -1 ]\n"
    "Material \"diffuse\"\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -2 0 -2  2 0 -2  -2 0 2  2 0 2 ]\n"
    "Material \"conductor\" \"float roughness\" 0.2\n"
    "Shape \"bilinearmesh\" \"point3 P\" [ -2 0 2  2 0 2  -2 3 2  2 3 2 ]\n"
    "Material \"dielectric\" \"float roughness\" 0.3\n"
    "Translate 0 0.6 0\n"
    "Shape \"sphere\" \"float radius\" 0.5\n"
    "AreaLightSource \"diffuse\" \"rgb L\" [ 9 9 9 ]\n"
    "Shape \"trianglemesh\" \"point3 P\" [ 0 2 0  1 2 0  0 2 1 ] \"integer indices\" [ 0 1 2 ]\n";

static Scene scene;
static BackendInterface interface;
static Backend *backend;

static atomic_int stop;
static int passes_left; /* until it is set */

static bool pass_run(Backend *of, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                     const atomic_int *stopped, uint64_t *items_done, Error *error)
{
    bool done = backend_cpu()->run(of, frame, list, sink, stopped, items_done, error);
    if (--passes_left == 0)
        atomic_store(&stop, 1);
    return done;
}

static void require(bool good)
{
    if (!good)
        abort();
}

static void renderer_begin(void)
{
    const ImportOptions import = {0};
    const BackendOptions threads = {.threads = 1};
    Error error;
    log_sink_set(fuzz_log_drop, NULL);
    scene_init(&scene);
    require(pbrt_import_text(SCENE, sizeof SCENE - 1, "fuzz.pbrt", ".", &import, &scene, &error) &&
            scene_finish(&scene, &error));
    const BackendScene view = scene_backend_view(&scene);
    interface = *backend_cpu();
    interface.run = pass_run;
    backend = interface.open(&view, &threads, &error);
    require(backend != NULL);
}

/* Reads all that the picture and its layers hold. */
static void image_read(const Film *film, const RenderLayers *layers)
{
    size_t pixels = film_pixels(film);
    float *rgb = malloc(3 * pixels * sizeof *rgb);
    require(rgb != NULL);
    film_resolve(film, 1.0f, rgb);
    if ((layers->wanted & LAYER_BIT(LAYER_VARIANCE)) != 0)
        render_layers_variance(layers, 1.0f, 0, pixels, rgb);
    for (int aov = 0; aov < AOV_COUNT; ++aov)
        if (layers->aovs[aov].sums)
            aov_image_resolve(&layers->aovs[aov], 0, pixels, rgb);
    free(rgb);
}

/* Renders for some passes, from the checkpoint or pilot that `options` name. Returns whether that was restored. */
static bool rendering_run(const FuzzCase *of, RenderOptions options, int passes)
{
    const SceneSettings *settings = &scene.settings;
    RenderLayers layers = {.wanted = of->layers};
    RenderResult result;
    Film film = {0};
    Error error = {0};
    options.samples = 1000;
    options.max_depth = 5;
    options.reconstruction = RECONSTRUCTION_SPLAT;
    options.chains = of->chains;
    options.error = (ErrorGoal){.goal = of->error, .scale = 1.0};
    options.layers = of->layers != 0 ? &layers : NULL;
    options.stop = &stop;
    const RenderTask task = {
        .integrator = of->integrator(), .scene = &scene, .backend = {&interface, backend}, .options = &options};
    atomic_store(&stop, 0);
    passes_left = passes;
    require(film_init(&film, settings->width, settings->height, settings->crop, &error));
    render_film(&task, &film, &result, &error);
    if (result.samples > 0)
        image_read(&film, &layers);
    render_layers_destroy(&layers);
    film_destroy(&film);
    return result.samples > 0;
}

/* ---- their checkpoints ------------------------------------------------------------------------------------------- */

#define FIELDS_MAX 512

/* What a checkpoint holds: bytes, and the fields that they are read as, from the one after the identity on. */
typedef struct State {
    ArchiveMemory bytes; /* empty until it is made */
    struct {
        size_t place, size;
    } fields[FIELDS_MAX];
    size_t field_count;
} State;

static State states[CASE_COUNT];

/* Records the fields of the file that is read next. The program is linked with --wrap=archive_reader_open. */
static struct {
    State *of; /* NULL: nothing is recorded */
    size_t place;
    bool (*transfer)(void *context, void *bytes, size_t size, Error *error);
} recording;

static bool field_transfer(void *context, void *bytes, size_t size, Error *error)
{
    State *of = recording.of;
    if (of && recording.place > sizeof(Identity) && of->field_count < FIELDS_MAX) {
        of->fields[of->field_count].place = recording.place;
        of->fields[of->field_count++].size = size;
    }
    recording.place += size;
    return recording.transfer(context, bytes, size, error);
}

/* The names that the linker's option asks for. */
bool __real_archive_reader_open(ArchiveReader *reader, const char *path, Error *error);
bool __wrap_archive_reader_open(ArchiveReader *reader, const char *path, Error *error);

bool __wrap_archive_reader_open(ArchiveReader *reader, const char *path, Error *error)
{
    bool opened = __real_archive_reader_open(reader, path, error);
    recording.transfer = reader->archive.transfer;
    recording.place = 0;
    if (recording.of && opened)
        reader->archive.transfer = field_transfer;
    return opened;
}

static void bytes_read(ArchiveMemory *into)
{
    ArchiveReader reader;
    Error error;
    Archive memory = archive_to_memory(into);
    require(archive_reader_open(&reader, fuzz_file(), &error));
    for (unsigned char byte; archive_bytes(&reader.archive, &byte, 1), !reader.archive.failed;)
        archive_bytes(&memory, &byte, 1);
    archive_reader_close(&reader);
    require(!memory.failed);
}

/* Goes on from the file. Returns whether it was restored. */
static bool file_use(const FuzzCase *of)
{
    const RenderOptions pilot = {.pilot = fuzz_file(), .shard = {1, 2}},
                        resume = {.checkpoint = {.file = "/dev/null", .every = 1e9, .resume = fuzz_file()}};
    return rendering_run(of, of->pilot ? pilot : resume, of->passes_after);
}

static void state_make(const FuzzCase *of, State *state)
{
    const RenderOptions options = {.checkpoint = {.file = fuzz_file(), .every = 1e9}};
    require(rendering_run(of, options, of->passes_before));
    bytes_read(&state->bytes);
    recording.of = state;
    require(file_use(of));
    recording.of = NULL;
    require(state->field_count > 0 && state->field_count < FIELDS_MAX);
}

/* ---- changes ----------------------------------------------------------------------------------------------------- */

typedef enum ChangeKind {
    CHANGE_BYTE, /* to `value` */
    CHANGE_WORD,
    CHANGE_LONG,
    CHANGE_FLOAT, /* to a special number */
    CHANGE_DOUBLE,
    CHANGE_SCALE_FLOAT, /* times a power of two */
    CHANGE_SCALE_DOUBLE,
    CHANGE_KINDS
} ChangeKind;

static const size_t CHANGE_SIZES[CHANGE_KINDS] = {1, 4, 8, 4, 8, 4, 8};

typedef struct Change {
    uint16_t field, element; /* both wrap around */
    ChangeKind kind;
    uint64_t value;
} Change;

#define CHANGE_BYTES 13

static Change change_read(const uint8_t bytes[CHANGE_BYTES])
{
    Change change = {.kind = bytes[4] % CHANGE_KINDS};
    memcpy(&change.field, bytes, 2);
    memcpy(&change.element, bytes + 2, 2);
    memcpy(&change.value, bytes + 5, 8);
    return change;
}

static const double SPECIAL[] = {0.0,   -0.0, (double)NAN, HUGE_VAL, -HUGE_VAL,    -1.0,  0.5,
                                 1.0,   1.5,  1e-300,      1e300,    -1e300,       3e38,  -3e38,
                                 1e-38, 1e20, -1e20,       1e10,     4294967296.0, 0x1p64};

/* Changes an element of the type that the change is of, unless the field is smaller. */
static void change_make(const State *state, Change change, unsigned char *bytes)
{
    size_t size = CHANGE_SIZES[change.kind], field = change.field % state->field_count,
           elements = state->fields[field].size / size;
    if (elements == 0)
        return;
    unsigned char *place = bytes + state->fields[field].place + change.element % elements * size;
    double number = SPECIAL[change.value % (sizeof SPECIAL / sizeof SPECIAL[0])];
    float single = (float)number;
    int exponent = (int)(change.value % 129) - 64;
    if (change.kind == CHANGE_SCALE_FLOAT) {
        memcpy(&single, place, sizeof single);
        single = ldexpf(single, exponent);
    } else if (change.kind == CHANGE_SCALE_DOUBLE) {
        memcpy(&number, place, sizeof number);
        number = ldexp(number, exponent);
    }
    const void *sources[CHANGE_KINDS] = {&change.value, &change.value, &change.value, &single,
                                         &number,       &single,       &number};
    memcpy(place, sources[change.kind], size);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (!backend)
        renderer_begin();
    if (size == 0)
        return 0;
    const FuzzCase *of = &CASES[data[0] % CASE_COUNT];
    State *state = &states[of - CASES];
    if (state->bytes.size == 0)
        state_make(of, state);
    unsigned char *bytes = malloc(state->bytes.size);
    require(bytes != NULL);
    memcpy(bytes, state->bytes.bytes, state->bytes.size);
    for (size_t i = 1; i + CHANGE_BYTES <= size; i += CHANGE_BYTES)
        change_make(state, change_read(data + i), bytes);
    fuzz_file_compress(&(ArchiveMemory){.size = 0}, bytes, state->bytes.size);
    free(bytes);
    require(file_use(of) || size > CHANGE_BYTES);
    return 0;
}
