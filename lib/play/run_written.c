#include "run_written.h"

#include <stdlib.h>

#include "../print/record_print.h"
#include "../scene/scene.h"
#include "../text/array.h"
#include "run_document.h"

void wh_run_written_open(wh_run_written_t *written, const wh_document_t *document,
                         const wh_script_run_options_t *run, const char *subcommand) {
    *written = (wh_run_written_t){.document = *document, .command = wh_run_command(subcommand, run)};
    written->document.title = run->script;
    written->document.reproduce = written->command;
    written->document.parameters = run->parameters;
    written->document.parameter_count = run->parameter_count;
    written->document.run = wh_record_to_json(document->record);
    FILE *out = wh_memory_need(open_memstream(&written->text, &written->size));
    const bool made = wh_document_write(&written->document, out) == 0;
    if (fclose(out) != 0 || !made) {
        wh_memory_out();
    }
}

void wh_run_written_close(wh_run_written_t *written) {
    free(written->text);
    free(written->command);
    json_decref(written->document.run);
}

bool wh_run_written_page(void *user, FILE *out) {
    wh_run_written_t *written = user;
    const char *page = written->document.signals ? WH_PAGE_REPORT : WH_PAGE_FLOW;
    const wh_page_content_t content = {.title = written->document.title,
                                       .document = written->text,
                                       .document_size = written->size,
                                       .cell = written->cell,
                                       .engine = written->engine};
    return wh_page_write_content(out, page, &content, written->message);
}

bool wh_run_written_scene(void *user, FILE *out) {
    const wh_run_written_t *written = user;
    json_t *scene = wh_scene_make(written->document.signals, written->document.title, true);
    const bool is_written = json_dumpf(scene, out, JSON_COMPACT | JSON_REAL_PRECISION(9)) == 0;
    json_decref(scene);
    return is_written && fputc('\n', out) != EOF;
}

bool wh_run_written_document(void *user, FILE *out) {
    const wh_run_written_t *written = user;
    return fwrite(written->text, 1, written->size, out) == written->size;
}
