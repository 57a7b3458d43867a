#include "../text/json.h"
#include "schedule_print.h"

#define FORMAT 1

static double seconds(int64_t us) {
    return (double)us / 1e6;
}

static const char *name_or_null(const wh_schedule_names_t *names, int32_t number) {
    return number == WH_FLOW_NONE ? NULL : wh_schedule_text(names, number);
}

static json_t *row_of(const wh_schedule_t *schedule, size_t number) {
    const wh_schedule_row_t *row = &schedule->rows[number];
    json_t *object = wh_json_set(json_object(), "line %lld robot %s action %s wafer %s wafer2 %s station %s",
                                 (long long)row->line, name_or_null(&schedule->robots, row->robot),
                                 wh_schedule_words[row->action], name_or_null(&schedule->wafers, row->wafer),
                                 name_or_null(&schedule->wafers, row->wafer2),
                                 name_or_null(&schedule->stations, row->station));
    return wh_json_set(object, "slot %d to %s value %s arm %lld begin_s %g end_s %g", (int)row->slot,
                       name_or_null(&schedule->stations, row->to), wh_flow_side_words[row->side],
                       row->arm > 0 ? (long long)row->arm : WH_JSON_NONE, seconds(row->begin_us),
                       seconds(row->end_us));
}

static json_t *finding_of(const void *subject, size_t i) {
    const wh_schedule_report_t *report = subject;
    const wh_schedule_finding_t *finding = &report->findings[i];
    json_t *object = wh_json_set(json_object(), "rule %d name %s warning %i text %s", finding->rule,
                                 wh_schedule_rules[finding->rule], finding->is_warning, finding->text);
    return wh_json_add(
        object, "row other", row_of(report->schedule, finding->row),
        finding->other == WH_SCHEDULE_NO_ROW ? json_null() : row_of(report->schedule, finding->other), NULL);
}

static json_t *rule_of(const void *subject, size_t i) {
    const wh_schedule_verdict_t *verdict = &((const wh_schedule_report_t *)subject)->rules[i + 1];
    return wh_json_set(json_object(), "number %d name %s looked_at %i but %s found %lld", (int)i + 1,
                       wh_schedule_rules[i + 1], verdict->is_looked, verdict->but, (long long)verdict->found);
}

static json_t *unused_of(const void *subject, size_t i) {
    return wh_json_text(((const wh_schedule_names_t *)subject)->texts[i]);
}

static json_t *apart_of(const wh_schedule_t *schedule, size_t row, int64_t played_us) {
    return row == SIZE_MAX ? json_null()
                           : wh_json_set(row_of(schedule, row), "played_s %g", seconds(played_us));
}

/* True if it was not to be played, or came to its end. */
static bool is_played_out(const wh_schedule_play_t *play) {
    return !play || !play->is_played || play->figures.result.end == WH_FLOW_DONE;
}

static json_t *play_of(const wh_schedule_t *schedule, const wh_schedule_play_t *play) {
    static const char *const ends[] = {"done", "stuck", "broken", "cut"};
    if (!play || !play->is_played) {
        return json_null();
    }
    const wh_flow_result_t *result = &play->figures.result;
    json_t *object = wh_json_set(
        json_object(),
        "end %s why %s makespan_s %g schedule_makespan_s %g actions %lld played %lld differing %lld",
        ends[result->end], result->why, seconds(result->makespan_us), seconds(play->makespan_us),
        (long long)play->actions, (long long)play->played, (long long)play->differing);
    (void)wh_json_set(object, "left_out %lld late %lld", (long long)play->resting,
                      (long long)play->figures.stays.late_count);
    return wh_json_add(object, "first widest", apart_of(schedule, play->first_row, play->first_us),
                       apart_of(schedule, play->widest_row, play->widest_us), NULL);
}

int wh_schedule_print_json(const wh_schedule_report_t *report, const wh_schedule_play_t *play, FILE *out) {
    const wh_schedule_t *schedule = report->schedule;
    const wh_schedule_finding_t *first = wh_schedule_first(report);
    json_t *root =
        wh_json_set(json_object(), "format %d file %s ok %i rows %lld wafers %lld end_s %g", FORMAT,
                    schedule->path, wh_schedule_is_good(report) && is_played_out(play),
                    (long long)schedule->count, (long long)schedule->wafers.count, seconds(report->end_us));
    (void)wh_json_set(root, "assumed_starts %lld last_line_ends %i times_look_like %s",
                      (long long)report->assumed, schedule->ends_whole, wh_schedule_unit(report->scale));
    (void)wh_json_add(root, "unused_columns first rules findings play",
                      wh_json_list(unused_of, &schedule->unused, schedule->unused.count),
                      first ? finding_of(report, (size_t)(first - report->findings)) : json_null(),
                      wh_json_list(rule_of, report, WH_SCHEDULE_RULES - 1),
                      wh_json_list(finding_of, report, report->count), play_of(schedule, play), NULL);
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
