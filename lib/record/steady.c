#include "steady.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* The longest cycle that is searched, in commands. */
#define MOST_COMMANDS 1000

/* Without marks a sequence that comes only twice may do so by chance. */
#define LEAST_TIMES 3

typedef struct {
    size_t first, count; /* commands */
    int64_t begin, end;  /* slices */
    size_t mark, wafers;
    bool is_twice; /* a wafer was put twice at places where puts count */
} stretch_t;

typedef struct {
    const wh_record_t *record;
    size_t *kinds; /* of each command; commands without a text are all of different kinds */
    stretch_t *cycles;
    size_t count;
} search_t;

size_t wh_steady_kind_length(const char *text) {
    const size_t verb = strcspn(text, " ");
    const char *where = text + verb + strspn(text + verb, " ");
    if (*where == '\0' || strchr("+-.0123456789", *where)) {
        return verb;
    }
    const char *end = *where == '"' ? strchr(where + 1, '"') : NULL;
    return (size_t)(where - text) + (end ? (size_t)(end - where) + 1 : strcspn(where, " "));
}

/* -------------------------------------------------------------------------------------------------- kinds */

static bool is_one_kind(const char *a, const char *b) {
    const size_t length = a && b ? wh_steady_kind_length(a) : 0;
    return a && b && length == wh_steady_kind_length(b) && memcmp(a, b, length) == 0;
}

/* A command's kind is the index of the first command of that kind. */
static size_t *kinds_of(const wh_record_t *record) {
    size_t *kinds = wh_array_new(record->command_count, sizeof *kinds);
    size_t *firsts = wh_array_new(record->command_count, sizeof *firsts);
    size_t count = 0;
    for (size_t i = 0; i < record->command_count; ++i) {
        size_t k = 0;
        while (k < count && !is_one_kind(record->commands[firsts[k]].text, record->commands[i].text)) {
            ++k;
        }
        if (k == count) {
            firsts[count++] = i;
        }
        kinds[i] = firsts[k];
    }
    free(firsts);
    return kinds;
}

/* ------------------------------------------------------------------------------------------------- cycles */

static int64_t slice_of(const wh_record_t *record, double seconds) {
    return (int64_t)(seconds * 1e6 / (double)record->layout->slice_us + 0.5);
}

static void add_marked(search_t *search) {
    const wh_record_t *record = search->record;
    size_t next = 0;
    search->cycles = wh_array_new(record->cycle_count, sizeof *search->cycles);
    for (size_t i = 0; i < record->cycle_count; ++i) {
        stretch_t cycle = {.begin = record->cycles[i].begin, .mark = i + 1};
        cycle.end = wh_throughput_cycle_end(record, i);
        while (next < record->command_count &&
               slice_of(record, record->commands[next].begin_s) < cycle.begin) {
            ++next;
        }
        cycle.first = next;
        while (next < record->command_count && slice_of(record, record->commands[next].begin_s) < cycle.end) {
            ++next;
        }
        cycle.count = next - cycle.first;
        if (cycle.count > 0) {
            search->cycles[search->count++] = cycle;
        }
    }
}

/* The longest run of commands in which each has the kind of the one `period` later. It gives the begin, and
 * the number of whole cycles of `period` commands. */
static size_t longest(const search_t *search, size_t period, size_t *first) {
    size_t most = 0;
    size_t same = 0;
    *first = 0;
    for (size_t i = 0; i + period < search->record->command_count; ++i) {
        same = search->kinds[i] == search->kinds[i + period] ? same + 1 : 0;
        if (same > most) {
            most = same;
            *first = i + 1 - same;
        }
    }
    return (most + period) / period;
}

static void add_stretches(search_t *search, size_t first, size_t period, size_t count) {
    const wh_record_t *record = search->record;
    search->cycles = wh_array_new(count, sizeof *search->cycles);
    search->count = count;
    for (size_t i = 0; i < count; ++i) {
        const size_t from = first + i * period;
        const size_t behind = from + period;
        const double end = behind < record->command_count ? record->commands[behind].begin_s
                                                          : record->commands[behind - 1].end_s;
        search->cycles[i] = (stretch_t){.first = from,
                                        .count = period,
                                        .begin = slice_of(record, record->commands[from].begin_s),
                                        .end = slice_of(record, end)};
    }
}

static void find_repeated(search_t *search) {
    const size_t commands = search->record->command_count;
    for (size_t period = 1; period <= commands / LEAST_TIMES && period <= MOST_COMMANDS; ++period) {
        size_t first;
        const size_t count = longest(search, period, &first);
        if (count >= LEAST_TIMES && 2 * count * period >= commands) {
            add_stretches(search, first, period, count);
            return;
        }
    }
}

/* ------------------------------------------------------------------------------------------------- wafers */

/* Puts are in order, and cycles, too. */
static void count_wafers(search_t *search) {
    const wh_record_t *record = search->record;
    /* For each wafer: 1 + the last cycle in which it counted. */
    size_t *counted = wh_array_new(record->layout->wafer_count, sizeof *counted);
    size_t at = 0;
    for (size_t i = 0; i < record->put_count; ++i) {
        const wh_put_record_t *put = &record->puts[i];
        while (at < search->count && search->cycles[at].end < put->slice) {
            ++at;
        }
        if (at == search->count) {
            break;
        }
        stretch_t *cycle = &search->cycles[at];
        if (put->slice > cycle->begin && record->layout->stations[put->station].counts) {
            const bool again = counted[put->wafer] == at + 1;
            counted[put->wafer] = at + 1;
            cycle->is_twice = cycle->is_twice || again;
            cycle->wafers += again ? 0 : 1;
        }
    }
    free(counted);
}

static wh_figure_t judge_cycle(const wh_record_t *record, const stretch_t *cycle) {
    const wh_figure_t whole = wh_throughput(record).figure;
    const bool is_bad = whole != WH_FIGURE_GIVEN && whole != WH_FIGURE_NO_WAFER && whole != WH_FIGURE_TWICE;
    if (is_bad || cycle->wafers == 0) {
        return is_bad ? whole : WH_FIGURE_NO_WAFER;
    }
    return cycle->is_twice && cycle->mark == 0 ? WH_FIGURE_TWICE : WH_FIGURE_GIVEN;
}

/* -------------------------------------------------------------------------------------------------- alike */

static bool are_alike(const search_t *search, const stretch_t *a, const stretch_t *b) {
    const double lengths[] = {(double)(a->end - a->begin), (double)(b->end - b->begin)};
    bool alike = a->count == b->count && a->wafers == b->wafers &&
                 fabs(lengths[0] - lengths[1]) <= WH_STEADY_SHARE * fmax(lengths[0], lengths[1]);
    for (size_t i = 0; alike && i < a->count; ++i) {
        const wh_command_record_t *commands = search->record->commands;
        alike = search->kinds[a->first + i] == search->kinds[b->first + i] &&
                commands[a->first + i].error == WH_OK && commands[b->first + i].error == WH_OK;
    }
    return alike;
}

static void describe(const search_t *search, size_t i, wh_steady_cycle_t *steady) {
    const stretch_t *cycle = &search->cycles[i];
    size_t times = 2;
    while (i + times < search->count && are_alike(search, cycle, &search->cycles[i + times])) {
        ++times;
    }
    *steady = (wh_steady_cycle_t){.found = WH_STEADY_FOUND,
                                  .first = cycle->first,
                                  .count = cycle->count,
                                  .begin = cycle->begin,
                                  .end = cycle->end,
                                  .seconds = wh_throughput_seconds(search->record, cycle->end - cycle->begin),
                                  .mark = cycle->mark,
                                  .times = times,
                                  .figure = judge_cycle(search->record, cycle),
                                  .wafers = cycle->wafers};
    if (steady->figure == WH_FIGURE_GIVEN) {
        steady->wafers_per_hour = 3600 * (double)steady->wafers / steady->seconds;
    }
}

static void search_cycles(search_t *search, wh_steady_cycle_t *steady) {
    if (search->record->cycle_count > 0) {
        add_marked(search);
    } else {
        find_repeated(search);
    }
    if (search->count < 2) {
        steady->found = WH_STEADY_NO_CYCLES;
        return;
    }
    count_wafers(search);
    steady->found = WH_STEADY_UNLIKE;
    for (size_t i = 0; i + 1 < search->count && steady->found != WH_STEADY_FOUND; ++i) {
        if (search->cycles[i].end > search->cycles[i].begin &&
            are_alike(search, &search->cycles[i], &search->cycles[i + 1])) {
            describe(search, i, steady);
        }
    }
}

wh_steady_cycle_t wh_steady_cycle(const wh_record_t *record) {
    wh_steady_cycle_t steady = {.found = WH_STEADY_NO_COMMANDS, .figure = WH_FIGURE_NO_WAFER};
    if (record->dropped.is_wanted) {
        steady.found = WH_STEADY_NO_ROWS;
    } else if (record->layout && record->command_count > 0) {
        search_t search = {.record = record, .kinds = kinds_of(record)};
        search_cycles(&search, &steady);
        free(search.cycles);
        free(search.kinds);
    }
    return steady;
}

const char *wh_steady_reason(wh_steady_t found) {
    static const char *const texts[] = {
        [WH_STEADY_FOUND] = NULL,
        [WH_STEADY_NO_COMMANDS] = "there are no commands",
        [WH_STEADY_NO_ROWS] = "commands were not kept",
        [WH_STEADY_NO_CYCLES] = "no two cycles are marked, and no sequence of commands that repeats makes up "
                                "half of the run",
        [WH_STEADY_UNLIKE] =
            "no cycle is repeated by the next one with the same commands and wafers, without "
            "errors, and as long to 1 %",
    };
    return texts[found];
}
