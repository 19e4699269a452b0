/* `twinlight info`: a summary of a scene. */
#include "command/command.h"

#include "base/json.h"
#include "base/log.h"
#include "gltf/gltf.h"
#include "gltf/load.h"
#include "pbrt/import.h"
#include "scene/scene.h"
#include "scene/summary.h"

typedef struct InfoCommand {
    bool json;
    bool lenient;
    bool needs;
} InfoCommand;

enum { OPTION_JSON, OPTION_LENIENT, OPTION_NEEDS };

static const OptionSpec SPECS[] = {
    [OPTION_JSON] = {"json", 0, NULL, "print JSON"},
    [OPTION_LENIENT] = {"lenient", 0, NULL, "replace unsupported features, with a warning"},
    [OPTION_NEEDS] = {"needs", 0, NULL, "list what SCENE uses and what of it is not supported"},
};

static const OptionTable TABLE = {
    "info", "info [OPTION]... SCENE",       "Prints what SCENE, a file in pbrt-v4's text format or glTF, contains.",
    SPECS,  sizeof SPECS / sizeof SPECS[0], NULL,
};

static bool option_set(void *context, int index, const char *value, Error *error)
{
    InfoCommand *command = context;
    (void)value;
    (void)error;
    bool *flags[] = {&command->json, &command->lenient, &command->needs};
    *flags[index] = true;
    return true;
}

static int info_print(const InfoCommand *command, const char *path, Error *error)
{
    Scene scene;
    scene_init(&scene);
    bool loaded = scene_file_load(path, command->lenient, &scene, error);
    if (loaded) {
        SceneSummary summary;
        scene_summary(&scene, &summary);
        if (command->json)
            scene_summary_json(&scene, &summary, path, stdout);
        else
            scene_summary_text(&scene, &summary, path, stdout);
    }
    scene_destroy(&scene);
    return loaded ? EXIT_OK : EXIT_FAILED;
}

/* Exit status EXIT_FAILED if something is not supported. */
static int needs_list(const InfoCommand *command, const char *path, Error *error)
{
    SceneNeeds needs;
    if (gltf_named(path)) {
        error_set(error, "--needs lists what pbrt scenes use; %s is a glTF file", path);
        error_fix(error, "leave --needs out, or list what twinlight convert makes of the file");
        return EXIT_FAILED;
    }
    needs_init(&needs);
    bool read = pbrt_needs(path, &needs, error), met = needs_met(&needs);
    if (read && command->json)
        needs_print_json(&needs, path, stdout);
    else if (read)
        needs_print(&needs, stdout);
    if (read && !met) {
        error_set(error, "%s needs what is not supported", path);
        error_fix(error, "see the list; --lenient replaces features by others");
    }
    needs_destroy(&needs);
    return read && met ? EXIT_OK : EXIT_FAILED;
}

int cmd_info(const BackendTable *backends, int argc, char **argv, Error *error)
{
    InfoCommand command = {0};
    const char *scene;
    int first = 0;
    (void)backends;
    OptionsEnd end = options_parse(&TABLE, argc, argv, option_set, &command, &first, error);
    if (end != OPTIONS_READ)
        return options_status(end);
    if (!options_scene(&TABLE, argc, argv, first, &scene, error))
        return EXIT_USAGE;
    return command.needs ? needs_list(&command, scene, error) : info_print(&command, scene, error);
}
