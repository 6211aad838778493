/// dem-study: what the engine's results can be relied on for.
#include <string.h>

#include "cli.h"
#include "study_convergence.h"
#include "study_dimers.h"
#include "study_lab.h"
#include "study_mohr.h"
#include "study_shape.h"
#include "study_suite.h"

// what stands before the options and has options of its own
typedef struct subcommand {
    const char *name;
    int (*run)(int argc, char **argv);
} subcommand;
static const subcommand subcommands[] = {
    {"verify", study_verify},
    {"stability", study_stability},
    {"convergence", study_convergence},
    {"mohr-coulomb", study_mohr_coulomb},
    {"scene", study_scene},
    {"test", study_test},
    {"shape", study_shape},
    {"dimers", study_dimers},
};

static int no_study(const cli_tool *tool, const char *name)
{
    char known[200] = "";
    for (size_t i = 0, at = 0; i < sizeof subcommands / sizeof *subcommands && at < sizeof known; i++)
        at += (size_t)snprintf(known + at, sizeof known - at, "%s%s", i ? ", " : "", subcommands[i].name);
    if (!name)
        return cli_wrong_usage(tool, "name a study, one of %s", known);
    return cli_wrong_usage(tool, "there is no study '%s'; there is %s", name, known);
}

int main(int argc, char **argv)
{
    for (size_t i = 0; argc > 1 && i < sizeof subcommands / sizeof *subcommands; i++)
        if (strcmp(argv[1], subcommands[i].name) == 0)
            return subcommands[i].run(argc - 1, argv + 1);
    static const char about[] =
        "Studies of what can be relied on. Each is a word with options of its own: verify compares what the engine "
        "computes with what is known; stability finds where runs become unstable and tries extreme scenes; convergence "
        "measures what the step and the schemes of integration do to a scene and what they cost; "
        "mohr-coulomb fits friction angle and cohesion to the strengths of tests; scene and test write and do measured "
        "tests of granular matter; shape compares grains by them; dimers packs dimers at random.";
    static const char epilogue[] =
        "Examples:\n"
        "  dem-study verify                 cases with a known answer\n"
        "  dem-study stability              limits of the step and extreme scenes\n"
        "  dem-study convergence sand.json  error against the step and run time\n"
        "  dem-study mohr-coulomb tests.csv friction angle and cohesion\n"
        "  dem-study test heap              angle of repose of a grain\n"
        "  dem-study shape grain.obj        from how many spheres on more do not pay\n"
        "  dem-study dimers                 random packing against aspect ratio\n"
        "  dem-study verify --help          how to choose them, and where the table can go\n"
        "Exit status: 0 done, 1 a study found a failure, 2 wrong usage, 3 bad input, 4 cannot write, 130 interrupted.";
    cli_common common = CLI_COMMON_DEFAULTS;
    const cli_option options[] = {CLI_COMMON_OPTIONS(common)};
    const cli_tool tool = {"dem-study", "STUDY [options]", about,
                           options,     sizeof options / sizeof *options, epilogue};
    cli_texts words = {0};
    int status;
    if (cli_parse(&tool, argc, argv, &words, &status) == CLI_GO)
        status = no_study(&tool, words.count ? words.items[0] : NULL);
    cli_texts_release(&words);
    return status;
}
