#include "study_suite.h"

#include <stdatomic.h>
#include <stdlib.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/threads.h"
#include "cli.h"
#include "study_output.h"

typedef struct arguments {
    cli_common common;
    bool list, slow, quick, all;
    cli_texts outputs;
} arguments;

// the cases that were chosen, each taken by the next free thread
typedef struct work {
    dem_ctx ctx;
    cli_session *session;
    tried *items;
    size_t count;
    size_t *order;  ///< those that take long come first, so that none is left over for one thread
    atomic_size_t next, done;
} work;

// a case asks whether to go on; how far all of them are is told between them
static bool asked_to_stop(void *user, const char *what, double fraction)
{
    (void)user;
    (void)what;
    (void)fraction;
    return cli_interrupted();
}

static void try_cases(void *user, int part)
{
    (void)part;
    work *w = user;
    size_t i;
    while ((i = atomic_fetch_add(&w->next, 1)) < w->count && !cli_interrupted()) {
        tried *v = &w->items[w->order[i]];
        const dem_ctx quiet = {.progress = asked_to_stop};
        dem_trial_run(&quiet, v->about, &v->trial);
        v->ran = v->trial.status != DEM_INTERRUPTED;
        size_t done = atomic_fetch_add(&w->done, 1) + 1;
        dem_progress(&w->ctx, "cases", (double)done / (double)w->count);
    }
}

// the cases the words mean, all without words; those that are slow only when asked for
static int choose(const cli_tool *tool, const suite *s, const arguments *a, const cli_texts *words, tried *items,
                  size_t *count)
{
    const dem_case *c;
    for (size_t k = 0; k < words->count; k++) {
        bool meant = false;
        for (size_t i = 0; !meant && (c = s->at(i)); i++)
            meant = dem_case_meant(c, words->items[k]);
        if (!meant)
            return cli_wrong_usage(tool, "there is no case '%s'; --list shows all", words->items[k]);
    }
    for (size_t i = 0; (c = s->at(i)); i++) {
        bool meant = words->count == 0 && (a->list || !c->slow || (s->quick ? !a->quick : a->slow));
        for (size_t k = 0; !meant && k < words->count; k++)
            meant = dem_case_meant(c, words->items[k]);
        if (meant)
            items[(*count)++] = (tried){.about = c};
    }
    return 0;
}

static void put_list(dem_buffer *out, const tried *items, size_t count, bool json)
{
    dem_json_writer w = dem_json_begin(out);
    if (json) {
        dem_json_open_object(&w, NULL);
        dem_json_open_array(&w, "cases", true);
    }
    for (size_t i = 0; i < count; i++) {
        const dem_case *c = items[i].about;
        if (!json) {
            dem_buffer_print(out, "%-24s %s (%s)%s\n", c->name, c->about, c->source, c->slow ? ", slow" : "");
            continue;
        }
        dem_json_open_object(&w, NULL);
        dem_json_put_string(&w, "name", c->name);
        dem_json_put_string(&w, "about", c->about);
        dem_json_put_string(&w, "source", c->source);
        dem_json_put_bool(&w, "slow", c->slow);
        dem_json_close(&w, '}');
    }
    if (json) {
        dem_json_close(&w, ']');
        dem_json_close(&w, '}');
    }
}

static void json_finding(dem_json_writer *w, const dem_finding *f)
{
    static const char *const bounds[] = {"near", "at most", "at least"};
    dem_json_open_object(w, NULL);
    dem_json_put_string(w, "what", f->what);
    dem_json_put_string(w, "unit", f->unit);
    dem_json_put_string(w, "bound", bounds[f->bound]);
    dem_json_put_number(w, "expected", f->expected);
    dem_json_put_number(w, "got", f->got);
    dem_json_put_number(w, "tolerance", f->tolerance);
    dem_json_put_bool(w, "passed", f->passed);
    dem_json_close(w, '}');
}

static void put_json(dem_buffer *out, cli_session *session, const tried *items, size_t count)
{
    suite_counts c = suite_count(items, count);
    dem_json_writer w = dem_json_begin(out);
    dem_json_open_object(&w, NULL);
    dem_json_put_whole(&w, "run", (int64_t)c.cases);
    dem_json_put_whole(&w, "passed", (int64_t)c.passed);
    dem_json_put_whole(&w, "failed", (int64_t)c.failed);
    dem_json_put_whole(&w, "skipped", (int64_t)c.skipped);
    dem_json_open_array(&w, "cases", true);
    for (size_t i = 0; i < count; i++) {
        const tried *v = &items[i];
        if (!v->ran)
            continue;
        dem_json_open_object(&w, NULL);
        dem_json_put_string(&w, "name", v->about->name);
        dem_json_put_string(&w, "about", v->about->about);
        dem_json_put_string(&w, "source", v->about->source);
        dem_json_put_bool(&w, "passed", dem_trial_passed(&v->trial));
        if (v->trial.skipped)
            dem_json_put_string(&w, "skipped", v->trial.skipped);
        if (v->trial.status != DEM_OK)
            dem_json_put_string(&w, "error", v->trial.error.text);
        dem_json_put_number(&w, "seconds", v->trial.seconds);
        dem_json_open_array(&w, "findings", false);
        for (size_t k = 0; k < v->trial.count; k++)
            json_finding(&w, &v->trial.findings[k]);
        dem_json_close(&w, ']');
        dem_json_close(&w, '}');
    }
    dem_json_close(&w, ']');
    cli_put_warnings(session, &w);
    dem_json_close(&w, '}');
}

static int write_files(cli_session *session, const suite *s, const arguments *a, const tried *items, size_t count)
{
    int status = 0;
    for (size_t i = 0; i < a->outputs.count; i++) {
        dem_buffer text = {0};
        dem_error error;
        if (study_output_form(a->outputs.items[i]) == STUDY_CSV)
            suite_csv(&text, items, count);
        else
            suite_page(&text, s, items, count);
        if (dem_file_write_buffer(a->outputs.items[i], &text, &error) != DEM_OK)
            status = cli_session_error(session, &error);
    }
    return status;
}

static int run(const cli_tool *tool, const suite *s, const arguments *a, tried *items, size_t count)
{
    cli_session session;
    cli_begin(&session, tool, &a->common);
    work w = {.ctx = cli_ctx(&session, NULL), .session = &session, .items = items, .count = count};
    int threads = dem_threads(&(dem_ctx){.threads = (int)a->common.threads});
    w.order = dem_alloc(count ? count : 1, sizeof *w.order);
    dem_team *team = w.order ? dem_team_create(threads < (int)count ? threads : (int)count) : NULL;
    for (size_t slow = 2, at = 0; w.order && slow-- > 0;)
        for (size_t i = 0; i < count; i++)
            if (items[i].about->slow == (slow == 1))
                w.order[at++] = i;
    dem_buffer text = {0};
    int status = 0;
    if (team)
        dem_team_run(team, try_cases, &w);
    else
        status = cli_session_error(&session, &(dem_error){.code = DEM_NO_MEMORY, .text = "out of memory"});
    dem_team_destroy(team);
    free(w.order);
    if (status == 0 && !cli_interrupted())
        status = write_files(&session, s, a, items, count);
    if (a->common.json)
        put_json(&text, &session, items, count);
    else if (!a->common.quiet)
        suite_text(&text, items, count, a->all || a->common.verbose);
    cli_end(&session);
    int printed = text.size ? cli_print(tool, &text) : 0;
    if (cli_interrupted())
        return DEM_INTERRUPTED;
    return status ? status : printed ? printed : suite_count(items, count).failed ? DEM_FAILED : 0;
}

static int run_chosen(const cli_tool *tool, const suite *s, const arguments *a, const cli_texts *words)
{
    size_t all = 0, count = 0;
    while (s->at(all))
        all++;
    tried *items = dem_alloc_zero(all, sizeof *items);
    if (!items)
        return cli_error(tool, &(dem_error){.code = DEM_NO_MEMORY, .text = "out of memory"});
    int status = choose(tool, s, a, words, items, &count);
    if (status == 0)
        status = study_check_outputs(tool, &a->outputs, false);
    if (status == 0 && a->list) {
        dem_buffer text = {0};
        put_list(&text, items, count, a->common.json);
        status = cli_print(tool, &text);
    } else if (status == 0)
        status = run(tool, s, a, items, count);
    for (size_t i = 0; i < count; i++)
        dem_trial_release(&items[i].trial);
    free(items);
    return status;
}

int suite_main(const suite *s, int argc, char **argv)
{
    arguments a = {.common = CLI_COMMON_DEFAULTS};
    const cli_option options[] = {
        {"list", 0, CLI_FLAG, NULL, "list the cases and leave", &a.list, 0, 0},
        {"all", 'a', CLI_FLAG, NULL, "show every figure, not only those that are off", &a.all, 0, 0},
        s->quick ? (cli_option){"quick", 0, CLI_FLAG, NULL, "without the cases that take long", &a.quick, 0, 0}
                 : (cli_option){"slow", 0, CLI_FLAG, NULL, "also the cases that take long", &a.slow, 0, 0},
        {"output", 'o', CLI_TEXTS, "FILE", "write all figures to .html or .csv; repeatable", &a.outputs, 0, 0},
        CLI_COMMON_OPTIONS(a.common),
    };
    const cli_tool tool = {s->tool,      "[CASE...] [options]", s->about, options, sizeof options / sizeof *options,
                           s->epilogue};
    cli_texts words = {0};
    int status;
    if (cli_parse(&tool, argc, argv, &words, &status) == CLI_GO)
        status = run_chosen(&tool, s, &a, &words);
    cli_texts_release(&words);
    cli_texts_release(&a.outputs);
    return status;
}
