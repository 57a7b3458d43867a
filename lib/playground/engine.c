#include "engine.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>

#include "../mcs/definitions.h"
#include "../play/run_document.h"
#include "../play/run_written.h"
#include "../print/record_print.h"
#include "../text/array.h"
#include "../text/json.h"
#include "../text/output.h"

/* A text that grows by a stream. */
typedef struct {
    FILE *out;
    char *text;
    size_t size;
} text_t;

/* One instance plays one script, hence static. */
static struct {
    json_t *request;
    const char **parameters;
    wh_script_run_options_t options;
    wh_script_run_t run;
    wh_signals_t signals;
    bool is_played, has_tables, has_document, is_written;
    wh_document_t document;
    wh_run_written_t written;
    json_t *inputs;
    char *answer;
    text_t page;
    char reason[WH_SANDBOX_MESSAGE_BYTES];
} engine;

static void open_text(text_t *text) {
    free(text->text);
    text->text = NULL;
    text->out = wh_memory_need(open_memstream(&text->text, &text->size));
}

static char *close_text(text_t *text) {
    if (fclose(text->out) != 0) {
        wh_memory_out();
    }
    return text->text;
}

/* ---------------------------------------------------------------------------------------------- a request */

static bool take_request(const char *text) {
    engine.request = json_loads(text, 0, NULL);
    const json_t *list = json_object_get(engine.request, "parameters");
    const size_t count = json_array_size(list);
    engine.parameters = wh_array_new(count + 1, sizeof *engine.parameters);
    for (size_t i = 0; i < count; ++i) {
        const char *parameter = json_string_value(json_array_get(list, i));
        engine.parameters[i] = parameter ? parameter : "";
    }
    engine.options = (wh_script_run_options_t){
        .script = json_string_value(json_object_get(engine.request, "script")),
        .parameters = engine.parameters,
        .parameter_count = count,
        .limits = {.instructions = (uint64_t)json_number_value(json_object_get(engine.request, "budget"))},
        .keeps = WH_FLOW_WAYS,
        .listener = wh_run_listener(&engine.signals)};
    return engine.options.script != NULL;
}

static void hear_input(void *unused, const char *path) {
    (void)unused;
    wh_json_append(engine.inputs, wh_json_text(path));
}

/* ----------------------------------------------------------------------------------------------- an answer */

static const char *name_of(wh_script_run_outcome_t outcome) {
    return outcome == WH_RUN_MET ? "met" : outcome == WH_RUN_FAILED ? "failed" : "bad_input";
}

/* Subcommands beside `run` for which the layout has something. */
static json_t *others_of(const wh_layout_t *layout) {
    json_t *list = json_array();
    if (layout && layout->errors) {
        wh_json_append(list, wh_json_text("study"));
    }
    return list;
}

/* An expectation that was not met; null: it was. */
static json_t *unmet(const void *record, size_t i) {
    const wh_expectation_record_t *expectation = &((const wh_record_t *)record)->expectations[i];
    return expectation->ok
               ? NULL
               : wh_json_set(json_object(), "line %d text %s", expectation->line, expectation->text);
}

/* Bad input shows the run before it, if there was any. */
static bool has_tables(wh_script_run_outcome_t outcome) {
    return outcome != WH_RUN_BAD_INPUT || (engine.run.record.layout && engine.run.record.slices > 0);
}

static json_t *make_answer(wh_script_run_outcome_t outcome, const char *tables) {
    const wh_record_t *record = &engine.run.record;
    const char *message = outcome == WH_RUN_BAD_INPUT ? engine.run.message : record->failure;
    engine.has_document =
        engine.has_tables &&
        wh_run_document(&engine.run, engine.options.script, &engine.signals, &engine.document, engine.reason);
    json_t *answer = wh_json_set(json_object(), "outcome %s message %s layout %s tables %s shown %s flow %i",
                                 name_of(outcome), message, record->layout ? record->layout->path : NULL,
                                 tables, engine.has_document ? NULL : engine.reason,
                                 engine.has_document && !engine.document.signals);
    return wh_json_add(answer, "hash inputs unmet others",
                       engine.has_tables ? wh_json_hash(record->hash) : json_null(),
                       json_incref(engine.inputs), wh_json_list(unmet, record, record->expectation_count),
                       others_of(record->layout), NULL);
}

static char *play(void) {
    const wh_style_t style = {.utf8 = true};
    text_t text = {0};
    open_text(&text);
    engine.options.limits.print_to = text.out;
    const wh_script_run_outcome_t outcome = wh_script_run(&engine.run, &engine.options);
    engine.is_played = true;
    engine.has_tables = has_tables(outcome);
    if (engine.has_tables && wh_record_print_table(&engine.run.record, text.out, &style, NULL) != 0) {
        wh_memory_out();
    }
    json_t *answer = make_answer(outcome, close_text(&text));
    char *made = wh_memory_need(json_dumps(answer, JSON_COMPACT));
    json_decref(answer);
    free(text.text);
    return made;
}

const char *wh_playground_run(const char *request) {
    (void)setlocale(LC_CTYPE, "C.UTF-8");
    engine.inputs = json_array();
    wh_output_hear_inputs(hear_input, NULL);
    if (engine.is_played || !take_request(request)) {
        return "{\"outcome\": \"bad_input\", \"message\": \"no request (expected one script an instance)\"}";
    }
    engine.answer = play();
    return engine.answer;
}

/* -------------------------------------------------------------------------------------------------- pages */

/* The document is made when it is asked for: the verdict does not wait for it. */
static bool write_run(void) {
    if (engine.has_document && !engine.is_written) {
        wh_run_written_open(&engine.written, &engine.document, &engine.options, "run");
        engine.is_written = true;
    }
    return engine.is_written;
}

const char *wh_playground_document(void) {
    return write_run() ? engine.written.text : NULL;
}

const char *wh_playground_json(void) {
    open_text(&engine.page);
    if (!engine.has_tables || wh_record_print_json(&engine.run.record, engine.page.out) != 0) {
        (void)snprintf(engine.reason, sizeof engine.reason, "nothing was played");
        return close_text(&engine.page), NULL;
    }
    return close_text(&engine.page);
}

const char *wh_playground_report(void) {
    if (!write_run()) {
        return NULL;
    }
    open_text(&engine.page);
    const bool made = wh_run_written_page(&engine.written, engine.page.out);
    (void)snprintf(engine.reason, sizeof engine.reason, "%s", engine.written.message);
    return close_text(&engine.page), made ? engine.page.text : NULL;
}

const char *wh_playground_page(const char *name) {
    char message[WH_PAGE_MESSAGE_BYTES] = "";
    open_text(&engine.page);
    const bool made = wh_page_write(engine.page.out, name, "Waferhand", "", 0, message);
    (void)snprintf(engine.reason, sizeof engine.reason, "%s", message);
    return close_text(&engine.page), made ? engine.page.text : NULL;
}

const char *wh_playground_definitions(void) {
    wh_sandbox_result_t result;
    free(engine.answer);
    engine.answer = wh_definitions_make(&result);
    (void)snprintf(engine.reason, sizeof engine.reason, "%s", engine.answer ? "" : result.message);
    return engine.answer;
}

const char *wh_playground_reason(void) {
    return engine.reason;
}
