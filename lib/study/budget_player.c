#include "budget_player.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* A wafer ends at its old place if it is not farther from it than this, in mm and in rad. */
#define SAME 1e-6

/* ------------------------------------------------------------------------------------------------ opening */

static void count_events(wh_budget_player_t *player) {
    const wh_record_t *record = &player->shared->nominal.record;
    for (size_t i = 0; i < record->event_count; ++i) {
        ++player->events[record->events[i].event.kind];
    }
}

/* Errors of commands by line, number and text, as a tally has them. */
static size_t count_caught(const wh_record_t *record) {
    size_t count = 0;
    for (size_t i = 0; i < record->command_count; ++i) {
        const wh_command_record_t *command = &record->commands[i];
        bool is_new = command->error != WH_OK;
        for (size_t k = 0; is_new && k < i; ++k) {
            is_new = record->commands[k].error != command->error ||
                     record->commands[k].line != command->line ||
                     strcmp(record->commands[k].text, command->text) != 0;
        }
        count += is_new ? 1 : 0;
    }
    return count;
}

/* The first complaint decides: the rest need not be played. */
static void end_at_complaint(void *user, const wh_command_t *command, const wh_state_t *state) {
    const wh_script_run_t *run = user;
    (void)command;
    for (size_t i = 0; i < state->event_count; ++i) {
        if (wh_record_is_complaint(state->events[i].kind)) {
            wh_sandbox_stop(run->sandbox);
        }
    }
}

/* Motion control looks ahead by what it believes: the cell as taught, and which slot has which wafer. A
 * replay in which it reads what it has read believes the same, so it was refused nothing either. */
static bool was_refused_ahead(const wh_record_t *record) {
    bool was = false;
    for (size_t i = 0; i < record->command_count; ++i) {
        was = was || record->commands[i].error == WH_STATUS_COLLISION_AHEAD;
    }
    return was;
}

bool wh_budget_has_two_ways(const wh_study_t *study) {
    return study->layout->collision && !study->decisions.unfit &&
           !(study->layout->look_ahead && was_refused_ahead(&study->nominal.record));
}

void wh_budget_player_open(wh_budget_player_t *player, const wh_study_t *study) {
    memset(player, 0, sizeof *player);
    player->shared = study;
    player->own = *study;
    player->two_ways = wh_budget_has_two_ways(study);
    player->layout = *study->layout;
    player->own.layout = &player->layout;
    player->own.cause_count = 0;
    player->own.lines = 0;
    player->point_size = WH_SPREADS * study->layout->station_count;
    player->given.stations = wh_array_new(study->layout->station_count, sizeof *player->given.stations);
    player->given.wafers = wh_array_new(study->layout->wafer_count, sizeof *player->given.wafers);
    player->given.rims = wh_array_new(study->layout->wafer_count, sizeof *player->given.rims);
    player->errors.given = &player->given;
    player->layout.errors = &player->errors;
    player->point = wh_array_new(player->point_size, sizeof *player->point);
    player->texts = wh_array_new(player->point_size, sizeof *player->texts);
    player->errors_by_name = wh_array_new(player->point_size, sizeof *player->errors_by_name);
    wh_worker_open(&player->worker, &player->own);
    player->worker.options.errors = player->errors_by_name;
    player->worker.options.listener =
        (wh_mcs_listener_t){.slice = end_at_complaint, .user = &player->worker.run};
    player->worker.ends_at_complaint = true;
    wh_tally_init(&player->tally, study->wafer_count);
    count_events(player);
    player->caught_nominally = count_caught(&study->nominal.record);
}

void wh_budget_player_close(wh_budget_player_t *player) {
    wh_worker_close(&player->worker);
    wh_tally_free(&player->tally);
    free(player->given.stations);
    free(player->given.wafers);
    free(player->given.rims);
    free(player->point);
    free(player->texts);
    free(player->errors_by_name);
}

/* ------------------------------------------------------------------------------------------------ playing */

void wh_budget_text(char text[WH_BUDGET_TEXT], const wh_layout_t *layout, size_t station, size_t axis,
                    int32_t value) {
    (void)snprintf(text, WH_BUDGET_TEXT, "%s.%s=%.3f", layout->stations[station].name,
                   wh_errors_teaching_name(axis), (double)value / WH_BUDGET_UNIT);
}

/* Replays take numbers, the script takes texts: both give equal doubles. */
static void give(wh_budget_player_t *player, const int32_t point[]) {
    size_t count = 0;
    for (size_t i = 0; i < player->point_size; ++i) {
        wh_displacement_t *station = &player->given.stations[i / WH_SPREADS];
        *wh_displacement_part(station, i % WH_SPREADS) = (wh_real_t)point[i] / WH_BUDGET_UNIT;
        if (point[i] != 0) {
            wh_budget_text(player->texts[count], &player->layout, i / WH_SPREADS, i % WH_SPREADS, point[i]);
            player->errors_by_name[count] = player->texts[count];
            ++count;
        }
    }
    player->worker.options.error_count = count;
    ++player->trials;
}

static bool ends_alike(const wh_study_wafer_t *one, const wh_study_wafer_t *other) {
    const wh_place_t *a = &one->place;
    const wh_place_t *b = &other->place;
    const wh_real_t off = wh_real_abs(a->dx - b->dx) + wh_real_abs(a->dy - b->dy) +
                          wh_real_abs(a->dz - b->dz) + wh_real_abs(a->tilt - b->tilt);
    return one->holder == other->holder && a->station == b->station &&
           (a->station == WH_NONE || (a->slot == b->slot && off <= SAME));
}

static bool ends_as_without_errors(const wh_budget_player_t *player) {
    const wh_outcome_t *outcome = &player->worker.outcome;
    bool alike = true;
    for (size_t i = 0; i < player->shared->wafer_count; ++i) {
        alike = alike && ends_alike(&outcome->wafers[i], &player->shared->wafers[i]);
    }
    return alike;
}

static bool passes_at(wh_budget_player_t *player, const int32_t point[], wh_budget_level_t level) {
    char message[WH_SANDBOX_MESSAGE_BYTES];
    const bool without = level == WH_BUDGET_WITHOUT;
    give(player, point);
    const bool replays = without || (player->two_ways && !player->by_script);
    player->own.whole = replays ? player->shared->decisions.unfit : player->shared->whole;
    player->worker.options.without_collisions = without;
    player->worker.looks_for_collisions = replays && !without;
    player->worker.grips_alike = !player->events_differ;
    wh_tally_free(&player->tally);
    wh_tally_init(&player->tally, player->shared->wafer_count);
    const bool usable = wh_worker_play(&player->worker, 0, &player->tally, message);
    const bool passes = usable && player->worker.outcome.met;
    player->events_differ = memcmp(player->worker.outcome.events, player->events, sizeof player->events) != 0;
    player->differs = !passes || player->events_differ || !ends_as_without_errors(player);
    player->caught = player->caught || (passes && player->tally.errors.count > player->caught_nominally);
    return passes;
}

bool wh_budget_passes(wh_budget_player_t *player, const int32_t point[], wh_budget_level_t level) {
    return (!player->two_ways || level == WH_BUDGET_WITHOUT || passes_at(player, point, WH_BUDGET_WITHOUT)) &&
           passes_at(player, point, level);
}

bool wh_budget_run(wh_budget_player_t *player, const int32_t point[], wh_budget_why_t *why) {
    wh_script_run_t *run = &player->worker.run;
    give(player, point);
    player->worker.options.without_collisions = false;
    const bool passes = wh_script_run(run, &player->worker.options) == WH_RUN_MET;
    if (!passes) {
        wh_budget_explain(&run->record, run->message, why);
    }
    wh_script_run_close(run);
    return passes;
}
