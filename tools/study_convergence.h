/// dem-study convergence: a scene at a ladder of steps and by several schemes of integration.
#ifndef DEM_TOOLS_STUDY_CONVERGENCE_H
#define DEM_TOOLS_STUDY_CONVERGENCE_H

#include "cli.h"
#include "study/convergence.h"

int study_convergence(int argc, char **argv);

// ---- what was found, as text

void convergence_text(dem_buffer *out, const dem_convergence *c, const char *scene);
void convergence_json(dem_buffer *out, const dem_convergence *c, const char *scene, cli_session *session);
/// A row per scheme and step: cost, errors and their doubts.
void convergence_csv(dem_buffer *out, const dem_convergence *c);
/// A row per scheme and quantity.
void convergence_orders_csv(dem_buffer *out, const dem_convergence *c);
bool convergence_page(dem_buffer *out, const dem_convergence *c, const char *scene);

#endif
