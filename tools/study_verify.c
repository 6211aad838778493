// dem-study verify: cases with a known answer.
#include "study/verify.h"
#include "study_suite.h"

int study_verify(int argc, char **argv)
{
    static const suite verify = {
        .tool = "dem-study verify",
        .about = "Runs small scenes whose outcome is known (closed forms, conserved quantities, published curves) and "
                 "compares. A case is named by its whole name or by what comes before a '-' of it: jkr is every case "
                 "of JKR.",
        .epilogue =
            "Examples:\n"
            "  dem-study verify                       all that are not slow\n"
            "  dem-study verify chung-ooi --all       the impacts of Chung & Ooi, every figure\n"
            "  dem-study verify --slow -o verify.html -o verify.csv\n"
            "Exit status: 0 every case passed, 1 a case failed, 2 wrong usage, 4 cannot write, 130 interrupted.",
        .title = "Verification",
        .cases = "cases with a known answer",
        .at = dem_verify_case,
        .quick = false};
    return suite_main(&verify, argc, argv);
}
