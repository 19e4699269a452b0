/* `twinlight convert`: a glTF scene as a pbrt scene. */
#include "command/command.h"

#include "base/log.h"
#include "base/path_name.h"
#include "command/output_check.h"
#include "gltf/gltf.h"

enum { OPTION_QUIET };

static const OptionSpec SPECS[] = {
    [OPTION_QUIET] = {"quiet", 'q', NULL, "print warnings and errors only"},
};

static const OptionTable TABLE = {
    "convert",
    "convert [OPTION]... SCENE.gltf|SCENE.glb OUT.pbrt",
    "Writes a glTF 2.0 scene as a pbrt-v4 scene, with its meshes and images beside it.",
    SPECS,
    sizeof SPECS / sizeof SPECS[0],
    "Meshes go to the folder OUT-meshes, images to OUT-textures.\nMore: man twinlight-convert.",
};

static bool option_set(void *context, int index, const char *value, Error *error)
{
    (void)context;
    (void)index;
    (void)value;
    (void)error;
    log_level_set(LOG_WARNING);
    return true;
}

static bool operands_check(char **operands, int count, Error *error)
{
    if (count != 2) {
        error_set(error, "convert takes two files, not %d", count);
        return error_fix(error, "write twinlight convert SCENE.glb OUT.pbrt");
    }
    if (!gltf_named(operands[0])) {
        error_set(error, "%s is not glTF: convert reads .gltf and .glb", operands[0]);
        return error_fix(error, "twinlight render reads pbrt scenes as they are");
    }
    if (!path_ends(operands[1], ".pbrt")) {
        error_set(error, "%s does not end in .pbrt", operands[1]);
        return error_fix(error, "convert writes pbrt-v4 scenes: give a name like OUT.pbrt");
    }
    return true;
}

static bool convert_run(const char *from, const char *to, Error *error)
{
    const CommandFile files[] = {{"the scene", from, false}, {"the conversion", to, true}};
    if (!output_files_check(files, sizeof files / sizeof files[0], "give another name", error))
        return false;
    Gltf *gltf = gltf_open(from, error);
    bool good = gltf && gltf_convert(gltf, to, error);
    gltf_close(gltf);
    if (good)
        log_message(LOG_INFO, "wrote %s", to);
    return good;
}

int cmd_convert(const BackendTable *backends, int argc, char **argv, Error *error)
{
    int first = 0;
    (void)backends;
    OptionsEnd end = options_parse(&TABLE, argc, argv, option_set, NULL, &first, error);
    if (end != OPTIONS_READ)
        return options_status(end);
    if (!operands_check(argv + first, argc - first, error))
        return EXIT_USAGE;
    return convert_run(argv[first], argv[first + 1], error) ? EXIT_OK : EXIT_FAILED;
}
