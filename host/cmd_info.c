/* `twinlight info`: what a scene holds. */
#include "command.h"

#include "json.h"
#include "log.h"
#include "options.h"
#include "pbrt_import.h"
#include "scene.h"
#include "scene_summary.h"

#include <string.h>

typedef struct InfoCommand {
    bool json;
    bool lenient;
    bool help;
} InfoCommand;

enum { OPTION_JSON, OPTION_LENIENT, OPTION_HELP };

static const OptionSpec SPECS[] = {
    [OPTION_JSON] = {"json", 0, NULL, "print JSON"},
    [OPTION_LENIENT] = {"lenient", 0, NULL, "replace what is not supported, with a warning"},
    [OPTION_HELP] = {"help", 'h', NULL, "print this and exit"},
};

static const OptionTable TABLE = {
    "info", "info [OPTION]... SCENE",       "Prints what SCENE, a file in pbrt-v4's text format, holds.",
    SPECS,  sizeof SPECS / sizeof SPECS[0], NULL,
};

static bool option_set(void *context, int index, const char *value, Error *error)
{
    InfoCommand *command = context;
    (void)value;
    (void)error;
    bool *flags[] = {&command->json, &command->lenient, &command->help};
    *flags[index] = true;
    return true;
}

static int info_print(const InfoCommand *command, const char *path, Error *error)
{
    ImportOptions options = {.lenient = command->lenient};
    Scene scene;
    scene_init(&scene);
    bool loaded = pbrt_import(path, &options, &scene, error) && (scene_finish(&scene, error) || error_in(error, path));
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

int cmd_info(const BackendTable *backends, int argc, char **argv, Error *error)
{
    InfoCommand command = {0};
    int first = 0;
    (void)backends;
    if (!options_parse(&TABLE, argc, argv, option_set, &command, &first, error))
        return EXIT_USAGE;
    if (command.help) {
        options_help(&TABLE, stdout);
        return EXIT_OK;
    }
    if (argc - first != 1) {
        error_set(error, first >= argc ? "no scene is given" : "more than one scene");
        error_fix(error, "write twinlight info SCENE");
        return EXIT_USAGE;
    }
    return info_print(&command, argv[first], error);
}
