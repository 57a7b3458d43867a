#include "log_run.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "../text/array.h"

#include "log_internal.h"

/* ---------------------------------------------------------------------------------------------------- file */

static FILE *open_file(wh_log_run_t *run, const char *path) {
    struct stat status;
    FILE *file = fopen(path, "rb");
    const bool is_folder = file && fstat(fileno(file), &status) == 0 && S_ISDIR(status.st_mode);
    if (!file || is_folder) {
        (void)snprintf(run->message, sizeof run->message,
                       "%.300s: %s (expected an LCM event log, or a script)", path,
                       strerror(is_folder ? EISDIR : errno));
    }
    if (is_folder) {
        (void)fclose(file);
        return NULL;
    }
    return file;
}

bool wh_log_run_is_log(const char *path) {
    static const unsigned char sync[4] = {0xED, 0xA1, 0xDA, 0x01};
    unsigned char begin[4] = {0};
    FILE *file = fopen(path, "rb");
    const bool is_log = file && fread(begin, 1, 4, file) == 4 && memcmp(begin, sync, 4) == 0;
    if (file) {
        (void)fclose(file);
    }
    return is_log;
}

/* Room for one more note. */
static char *next_note(wh_log_run_t *run) {
    char *text = run->text[run->note_count];
    run->notes[run->note_count++] = text;
    return text;
}

static bool wants(const wh_log_run_t *run) {
    return run->options.number == 0 || run->options.number == run->run_count;
}

/* ------------------------------------------------------------------------------------------------- messages */

static void on_cell(wh_log_run_t *run) {
    waferhand_cell message;
    if (!wh_link_decode_cell(run->log.data, run->log.size, &message)) {
        return;
    }
    const uint64_t hash = (uint64_t)message.layout_hash;
    const wh_log_layout_t *last = run->next_cell.layout ? &run->next_cell : &run->cell;
    if (!last->layout || last->hash != hash) {
        wh_log_layout_t made;
        if (wh_log_layout_make(&made, &message, &run->options.layout)) {
            wh_log_layout_free(&run->next_cell);
            run->next_cell = made;
        }
    }
    (void)waferhand_cell_decode_cleanup(&message);
}

static void on_command(wh_log_run_t *run) {
    wh_command_t checked;
    run->has_command = wh_link_decode_command(run->log.data, run->log.size, &run->command) &&
                       wh_link_command_from_message(&run->command, &checked) == WH_OK;
}

static void on_state(wh_log_run_t *run) {
    waferhand_state message;
    if (!wh_link_decode_state(run->log.data, run->log.size, &message)) {
        return;
    }
    if (message.run != run->run && message.status == WH_OK && message.seq > 0) {
        ++run->run_count;
        run->run = message.run;
        run->seq = 0;
        run->is_wanted = wants(run);
        if (run->is_wanted) {
            wh_log_begin_run(run);
        }
    }
    if (message.run == run->run && run->is_wanted) {
        wh_log_take_state(run, &message);
    }
    (void)waferhand_state_decode_cleanup(&message);
}

static void on_mcs(wh_log_run_t *run) {
    waferhand_mcs message;
    if (wh_link_decode_mcs(run->log.data, run->log.size, &message)) {
        wh_log_take_mcs(run, &message);
        (void)waferhand_mcs_decode_cleanup(&message);
    }
}

static void take_event(wh_log_run_t *run) {
    static const struct {
        const char *channel;
        void (*take)(wh_log_run_t *run);
    } channels[] = {{WH_CHANNEL_CELL, on_cell},
                    {WH_CHANNEL_COMMAND, on_command},
                    {WH_CHANNEL_STATE, on_state},
                    {WH_CHANNEL_MCS, on_mcs}};
    const bool fits = run->log.size > 0 && run->log.size <= WH_LINK_DATAGRAM;
    for (size_t i = 0; fits && i < sizeof channels / sizeof channels[0]; ++i) {
        if (strcmp(channels[i].channel, run->log.channel) == 0) {
            channels[i].take(run);
        }
    }
}

/* ------------------------------------------------------------------------------------------------- the whole */

static int compare(const void *a, const void *b) {
    const wh_log_boundary_t *one = a;
    const wh_log_boundary_t *two = b;
    if (one->run != two->run) {
        return one->run < two->run ? -1 : 1;
    }
    return (one->seq > two->seq) - (one->seq < two->seq);
}

static void note_boundary(wh_log_run_t *run) {
    waferhand_mcs message;
    if (!wh_link_decode_mcs(run->log.data, run->log.size, &message)) {
        return;
    }
    run->boundaries =
        wh_array_grow(run->boundaries, run->boundary_count, &run->boundary_capacity, sizeof *run->boundaries);
    const wh_log_boundary_t boundary = {message.run, message.seq};
    if (message.phase != WH_LINK_PHASE_GOES_ON) {
        run->boundaries[run->boundary_count++] = boundary;
    }
    (void)waferhand_mcs_decode_cleanup(&message);
}

/* What is needed before it comes. The cell is told once a second: a recording may begin before it, and goes with the first one then.
 * And a command's end may be told after the next slice. */
static void look_ahead(wh_log_run_t *run, FILE *file) {
    wh_log_open(&run->log, file);
    while (wh_log_next(&run->log) == WH_LOG_EVENT) {
        const bool fits = run->log.size > 0 && run->log.size <= WH_LINK_DATAGRAM;
        if (fits && !run->next_cell.layout && strcmp(run->log.channel, WH_CHANNEL_CELL) == 0) {
            on_cell(run);
        } else if (fits && strcmp(run->log.channel, WH_CHANNEL_MCS) == 0) {
            note_boundary(run);
        }
    }
    if (run->boundary_count > 0) {
        qsort(run->boundaries, run->boundary_count, sizeof *run->boundaries, compare);
    }
    rewind(file);
}

bool wh_log_is_boundary(const wh_log_run_t *run) {
    const wh_log_boundary_t now = {run->run, run->seq};
    return run->boundary_count > 0 &&
           bsearch(&now, run->boundaries, run->boundary_count, sizeof now, compare) != NULL;
}

static wh_log_result_t read_events(wh_log_run_t *run, FILE *file) {
    wh_log_result_t result;
    wh_log_open(&run->log, file);
    do {
        result = wh_log_next(&run->log);
        if (result == WH_LOG_EVENT) {
            take_event(run);
        }
    } while (result == WH_LOG_EVENT);
    return result;
}

static void tell(wh_log_run_t *run, wh_log_result_t result) {
    (void)snprintf(next_note(run), WH_LOG_NOTE_BYTES,
                   "From a log: what the script expected and its cycles are not in it.");
    if (!run->cell.is_whole) {
        (void)snprintf(next_note(run), WH_LOG_NOTE_BYTES, "Shapes are the defaults of 300 mm wafers: %.140s.",
                       run->cell.note);
    }
    if (run->gaps > 0) {
        (void)snprintf(next_note(run), WH_LOG_NOTE_BYTES, "%zu stretches of slices are not in the log.",
                       run->gaps);
    }
    if (result == WH_LOG_CUT || result == WH_LOG_DAMAGED) {
        (void)snprintf(next_note(run), WH_LOG_NOTE_BYTES,
                       "The log is %s at byte %" PRIu64 ": shown up to there.",
                       result == WH_LOG_CUT ? "cut off" : "damaged", run->log.offset);
    }
}

static bool refuse(wh_log_run_t *run, wh_log_result_t result) {
    const char *path = run->options.path;
    if (run->log.count == 0 && result != WH_LOG_END) {
        (void)snprintf(run->message, sizeof run->message,
                       "%.300s: no LCM event log (expected one, or a script)", path);
    } else if (!run->cell.layout && !run->next_cell.layout) {
        (void)snprintf(
            run->message, sizeof run->message,
            "%.300s: no cell in it (expected WAFERHAND_CELL, which a simulator tells once a second)", path);
    } else if (run->options.number > 0 && run->run_count > 0) {
        (void)snprintf(run->message, sizeof run->message, "%.300s: no run %zu in it (expected 1 to %zu)",
                       path, run->options.number, run->run_count);
    } else {
        (void)snprintf(run->message, sizeof run->message,
                       "%.300s: no run in it (expected states on WAFERHAND_STATE, in %" PRIu64 " events)",
                       path, run->log.count);
    }
    return false;
}

bool wh_log_run_read(wh_log_run_t *run, const wh_log_run_options_t *options) {
    memset(run, 0, sizeof *run);
    run->options = *options;
    FILE *file = open_file(run, options->path);
    if (!file) {
        return false;
    }
    look_ahead(run, file);
    const wh_log_result_t result = read_events(run, file);
    (void)fclose(file);
    if (!run->signals.layout || run->signals.last <= 0) {
        return refuse(run, result);
    }
    wh_log_finish_run(run);
    tell(run, result);
    return true;
}

void wh_log_run_close(wh_log_run_t *run) {
    wh_log_drop_run(run);
    wh_log_layout_free(&run->cell);
    wh_log_layout_free(&run->next_cell);
    free(run->boundaries);
    run->boundaries = NULL;
}
