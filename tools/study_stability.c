// dem-study stability: where the engine breaks, and that it does not break before.
#include "study/stability.h"
#include "study_suite.h"

int study_stability(int argc, char **argv)
{
    static const suite stability = {
        .tool = "dem-study stability",
        .about = "Measures where runs become unstable against what is predicted (the step at which contacts, chains, "
                 "packings and clumps blow up), and runs stiff and extreme scenes: what they must keep to, and what "
                 "they do. A case is named by its whole name or by what comes before a '-' of it.",
        .epilogue = "Examples:\n"
                    "  dem-study stability -o stability.html  all of it, some minutes\n"
                    "  dem-study stability --quick            without what takes long\n"
                    "  dem-study stability limit --all        the limits of the step, every figure\n"
                    "Exit status: 0 all in bounds, 1 a case is not, 2 wrong usage, 4 cannot write, 130 interrupted.",
        .title = "Stability",
        .cases = "stiff and extreme cases",
        .at = dem_stability_case,
        .quick = true};
    return suite_main(&stability, argc, argv);
}
