/* --mlt and the options it replaces; and that the manual page names all its keys and all layers. */
#include "support/test_util.h"

#include "base/log.h"
#include "command/mlt_option.h"
#include "command/render_options.h"

#include <string.h>

/* ---- --mlt ------------------------------------------------------------------------------------------------------- */

static const BackendInterface CPU = {.name = "cpu"};
static const BackendInterface *const BACKENDS[] = {&CPU};
static const BackendTable BACKEND_TABLE = {BACKENDS, 1, NULL};
static const RenderOptionSet RENDER_SET = {.command = "render",
                                           .usage = "render",
                                           .summary = "",
                                           .output_ending = ".exr",
                                           .depth_low = 1,
                                           .depth_high = 65535};

/* Keeps the latest message; "" if there was none. */
static void line_keep(const char *line, void *context)
{
    snprintf(context, 256, "%s", line);
}

/* Parses `line`, words separated by blanks, as render's options. warning[256]: the last message. */
static bool render_line(const char *line, RenderCommand *command, char *warning, Error *error)
{
    static char words[256]; /* `command` points into it */
    char *argv[16] = {(char *)"render"};
    int argc = 1;
    snprintf(words, sizeof words, "%s", line);
    for (char *word = strtok(words, " "); word; word = strtok(NULL, " "))
        argv[argc++] = word;
    argv[argc++] = (char *)"a.pbrt";
    memset(command, 0, sizeof *command);
    memset(error, 0, sizeof *error);
    warning[0] = '\0';
    log_sink_set(line_keep, warning);
    bool read = render_options_parse(command, &RENDER_SET, &BACKEND_TABLE, argc, argv, error) == OPTIONS_READ;
    log_sink_set(NULL, NULL);
    return read;
}

static const struct {
    const char *line;
    ChainOptions chains;
} MLT_GOOD[] = {
    {"--mlt=scheme=paper", {.paper = true}},
    {"--mlt=scheme=paper --mlt=scheme=generations", {0}},
    {"--mlt=chains=67108864,steps=16384,pool=1073741824", {.chains = 1u << 26, .steps = 1u << 14, .pool = 1u << 30}},
    {"--mlt=scheme=paper,large-step=0.25", {.paper = true, .large_step = 0.25}},
    {"--mlt=mutations=all", {.mutations = 1}},
    {"--mlt=mutations=light", {.mutations = 2}},
    {"--mlt=mutations=camera+all", {.mutations = 5}},
    {"--mlt=sort=depth", {.order = CHAIN_ORDER_DEPTH}},
    {"--mlt=sort=none", {.order = CHAIN_ORDER_NONE}},
    {"--mlt=sort=none,sort=strategy", {.order = CHAIN_ORDER_STRATEGY}},
    {"--mlt=group=off", {.ungrouped = true}},
    {"--mlt=shift=off", {.shiftless = true}},
    {"--mlt=guide=off", {.unguided = true}},
    {"--mlt=combine=off", {.chains_only = true}},
    {"--mlt=group=off,shift=off,guide=off,combine=off --mlt=group=on,shift=on,guide=on,combine=on", {0}},
    {"--mlt=steps=8 --mlt=shift=off --mlt=steps=16", {.steps = 16, .shiftless = true}},
    {"--mlt steps=8", {.steps = 8}},
};

static void chains_compare(const ChainOptions *found, const ChainOptions *expected)
{
    ck_assert_int_eq(found->paper, expected->paper);
    ck_assert_uint_eq(found->chains, expected->chains);
    ck_assert_uint_eq(found->steps, expected->steps);
    ck_assert_uint_eq(found->pool, expected->pool);
    ck_assert_double_eq(found->large_step, expected->large_step);
    ck_assert_uint_eq(found->mutations, expected->mutations);
    ck_assert_int_eq(found->order, expected->order);
    ck_assert_int_eq(found->ungrouped, expected->ungrouped);
    ck_assert_int_eq(found->shiftless, expected->shiftless);
    ck_assert_int_eq(found->unguided, expected->unguided);
    ck_assert_int_eq(found->chains_only, expected->chains_only);
}

START_TEST(test_mlt_good)
{
    RenderCommand command;
    char warning[256];
    Error error;
    ck_assert_msg(render_line(MLT_GOOD[_i].line, &command, warning, &error), "%s", error.message);
    chains_compare(&command.chains, &MLT_GOOD[_i].chains);
    ck_assert_str_eq(command.chain_option, "mlt");
    ck_assert_str_eq(warning, "");
}
END_TEST

static const struct {
    const char *line, *message, *fix;
} MLT_BAD[] = {
    {"--mlt=polo=4", "--mlt=polo: there is no such switch", "did you mean pool?"},
    {"--mlt=quantum=4", "--mlt=quantum: there is no such switch", "use scheme, chains, "},
    {"--mlt=paper", "--mlt=paper: there is no such switch", "use scheme, chains, "},
    {"--mlt=,", "--mlt=: there is no such switch", "use scheme, chains, "},
    {"--mlt=steps=8,", "--mlt=: there is no such switch", "use scheme, chains, "},
    {"--mlt=Pool=8", "--mlt=Pool: there is no such switch", "did you mean pool?"},
    {"--mlt=pool", "--mlt=pool needs a value", "write --mlt=pool=N"},
    {"--mlt=sort=", "--mlt=sort needs a value", "write --mlt=sort=strategy|depth|none"},
    {"--mlt=sort=pool", "--mlt=sort=pool: there is no such value", "write --mlt=sort=strategy|depth|none"},
    {"--mlt=sort=dept", "--mlt=sort=dept: there is no such value", "write --mlt=sort=strategy|depth|none"},
    {"--mlt=sort=depth|none", "--mlt=sort=depth|none: there is no such value", "write --mlt=sort="},
    {"--mlt=scheme=best", "--mlt=scheme=best: there is no such value", "write --mlt=scheme=generations|paper"},
    {"--mlt=group=no", "--mlt=group=no: there is no such value", "write --mlt=group=on|off"},
    {"--mlt=combine=offf", "--mlt=combine=offf: there is no such value", "write --mlt=combine=on|off"},
    {"--mlt=chains=0", "--mlt=chains=0: out of range", "from 1 to 67108864"},
    {"--mlt=steps=16385", "--mlt=steps=16385: out of range", "from 1 to 16384"},
    {"--mlt=pool=1=2", "--mlt=pool=1=2: not a whole number", "from 1 to 1073741824"},
    {"--mlt=large-step=1.5", "--mlt=large-step=1.5: out of range", "from 1e-06 to 1"},
    {"--mlt=mutations=all+lens", "--mlt=mutations=all+lens: there is no kind of mutation lens", "separated by +"},
    {"--mlt=mutations=all+", "--mlt=mutations=all+: there is no kind of mutation ", "separated by +"},
    {"--mlt=mutations=all,light", "--mlt=light: there is no such switch", ""},
    {"--mlt=pool=0000000000000000000000000000000000000000000000000000000000004",
     "--mlt=pool=000000000000000000000000000...: too long", "separate switches by commas"},
    {"--chains=4,steps=8", "--mlt=chains=4+steps=8: not a whole number", "from 1 to 67108864"},
    {"--mutations=all,lens", "--mlt=mutations=all+lens: there is no kind of mutation lens", "separated by +"},
    {"--mlt-scheme=best", "--mlt=scheme=best: there is no such value", "write --mlt=scheme=generations|paper"},
};

START_TEST(test_mlt_bad)
{
    RenderCommand command;
    char warning[256];
    Error error;
    ck_assert(!render_line(MLT_BAD[_i].line, &command, warning, &error));
    ck_assert_str_eq(error_text(&error), MLT_BAD[_i].message);
    ck_assert_msg(strstr(error.fix, MLT_BAD[_i].fix) && error.fix[0], "%s", error.fix);
}
END_TEST

/* A deprecated option sets what its warning says. */
static const struct {
    const char *line, *mlt;
} MLT_OLD[] = {
    {"--mlt-scheme=paper", "scheme=paper"},
    {"--chains=100", "chains=100"},
    {"--steps=16", "steps=16"},
    {"--pool=1000", "pool=1000"},
    {"--large-step=0.5", "large-step=0.5"},
    {"--mutations=all,camera", "mutations=all+camera"},
    {"--sort=depth", "sort=depth"},
    {"--no-sort", "sort=none"},
    {"--no-group", "group=off"},
    {"--no-shift", "shift=off"},
    {"--no-aim", "guide=off"},
    {"--no-blend", "combine=off"},
};

START_TEST(test_mlt_old)
{
    RenderCommand command;
    ChainOptions expected = {0};
    char warning[256], wanted[256], name[32];
    Error error;
    ck_assert_msg(render_line(MLT_OLD[_i].line, &command, warning, &error), "%s", error.message);
    ck_assert(mlt_option_set(&expected, MLT_OLD[_i].mlt, &error));
    chains_compare(&command.chains, &expected);
    snprintf(name, sizeof name, "%.*s", (int)strcspn(MLT_OLD[_i].line + 2, "="), MLT_OLD[_i].line + 2);
    ck_assert_str_eq(command.chain_option, name);
    snprintf(wanted, sizeof wanted, "warning: --%s is deprecated; write --mlt=%s", name, MLT_OLD[_i].mlt);
    ck_assert_str_eq(warning, wanted);
}
END_TEST

/* ---- the manual page --------------------------------------------------------------------------------------------- */

/* Whether the lines of twinlight-render(1) from the one that starts with `from` to the next that starts with `to` have
 * `word`, with blanks or line ends around it, in a line that starts with `macro`. */
static bool page_has(const char *from, const char *to, const char *macro, const char *word)
{
    char path[512], line[512], wanted[64];
    bool within = false, found = false;
    snprintf(path, sizeof path, "%s/man/twinlight-render.1", test_source_folder());
    FILE *page = fopen(path, "r");
    ck_assert_msg(page != NULL, "%s", path);
    snprintf(wanted, sizeof wanted, " %s ", word);
    while (!found && fgets(line, sizeof line - 1, page)) {
        bool first = strncmp(line, from, strlen(from)) == 0;
        if (within && !first && strncmp(line, to, strlen(to)) == 0)
            break;
        within = within || first;
        line[strcspn(line, "\n")] = ' ';
        found = within && strncmp(line, macro, strlen(macro)) == 0 && strstr(line, wanted);
    }
    fclose(page);
    return found;
}

START_TEST(test_page_names_layers)
{
#define TEXT(NAME, name, text, ...) text,
#define CHANNEL(NAME, name, text, values, red, ...) red,
    static const char *const LAYERS[LAYER_COUNT] = {LAYER_LIST(TEXT)};
    static const char *const CHANNELS[AOV_COUNT] = {AOV_LIST(CHANNEL)};
#undef TEXT
#undef CHANNEL
    for (int i = 0; i < LAYER_COUNT; ++i)
        ck_assert_msg(page_has(".It Fl -layers", ".It ", ".Cm ", LAYERS[i]), "--layers=%s", LAYERS[i]);
    for (int i = 0; i < AOV_COUNT; ++i)
        ck_assert_msg(page_has(".Sh THE IMAGE", ".Sh ", ".It Li ", CHANNELS[i]), "channel %s", CHANNELS[i]);
    ck_assert(!page_has(".It Fl -layers", ".It ", ".Cm ", "halfA.R"));
}
END_TEST

START_TEST(test_page_names_switches)
{
#define NAME_OF(NAME, name, ...) name,
    static const char *const KEYS[] = {MLT_KEY_LIST(NAME_OF)};
#undef NAME_OF
    for (size_t i = 0; i < sizeof KEYS / sizeof *KEYS; ++i)
        ck_assert_msg(page_has(".It Fl -mlt", ".It Fl ", ".It Cm ", KEYS[i]), "--mlt=%s", KEYS[i]);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("mlt_option");
    TCase *mlt = tcase_create("mlt");
    tcase_add_loop_test(mlt, test_mlt_good, 0, sizeof MLT_GOOD / sizeof *MLT_GOOD);
    tcase_add_loop_test(mlt, test_mlt_bad, 0, sizeof MLT_BAD / sizeof *MLT_BAD);
    tcase_add_loop_test(mlt, test_mlt_old, 0, sizeof MLT_OLD / sizeof *MLT_OLD);
    suite_add_tcase(suite, mlt);
    TCase *page = tcase_create("manual page");
    tcase_add_test(page, test_page_names_layers);
    tcase_add_test(page, test_page_names_switches);
    suite_add_tcase(suite, page);
    return test_run(suite);
}
