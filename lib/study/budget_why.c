/* Why a run fails. */
#include <stdio.h>
#include <string.h>

#include "../sim/event_text.h"
#include "budget_player.h"

static const char *find_name(const void *user, wh_name_kind_t kind, int32_t index) {
    const wh_record_t *record = user;
    return kind == WH_NAME_PART    ? wh_layout_part_name(record->layout, index)
           : kind == WH_NAME_WAFER ? wh_record_wafer_name(record, index)
                                   : wh_record_gripper_name(record, index);
}

static const wh_event_record_t *find_complaint(const wh_record_t *record) {
    for (size_t i = 0; i < record->event_count; ++i) {
        if (wh_record_is_complaint(record->events[i].event.kind)) {
            return &record->events[i];
        }
    }
    return NULL;
}

static void explain_complaint(const wh_record_t *record, const wh_event_record_t *complaint,
                              wh_budget_why_t *why) {
    const wh_event_names_t names = {find_name, record, 1, &record->layout->grasp.tolerance, NULL};
    const wh_command_record_t *command =
        complaint->command == WH_NONE ? NULL : &record->commands[complaint->command];
    char text[WH_EVENT_TEXT_SIZE];
    (void)wh_event_text(&complaint->event, &names, text, sizeof text);
    (void)snprintf(why->name, sizeof why->name, "%s", wh_event_name(complaint->event.kind));
    why->line = command ? command->line : 0;
    (void)snprintf(why->command, sizeof why->command, "%s", command ? command->text : "");
    (void)snprintf(why->text, sizeof why->text, "%.399s", text);
}

/* Appends all conditions that the near miss did not keep. */
static void say_miss(const wh_event_t *miss, const wh_event_names_t *names, char text[], size_t size) {
    char reason[WH_EVENT_TEXT_SIZE];
    text[0] = '\0';
    for (size_t i = 0; wh_event_reason(miss, names, i, reason, sizeof reason) > 0; ++i) {
        const size_t length = strlen(text);
        (void)snprintf(text + length, size - length, "%s%.130s", i > 0 ? " and " : "", reason);
    }
}

/* The conditions that the command's last near miss did not keep, if it failed for want of a wafer: another
 * error has another reason. */
static void find_miss(const wh_record_t *record, int32_t command, char text[], size_t size) {
    const wh_event_names_t names = {find_name, record, 1, &record->layout->grasp.tolerance, NULL};
    const wh_status_t error = record->commands[command].error;
    text[0] = '\0';
    for (size_t i = 0; i < record->event_count; ++i) {
        const wh_event_record_t *event = &record->events[i];
        if (event->event.kind == WH_EVENT_NEAR_MISS && event->command == command &&
            (error == WH_STATUS_WAFER_MISSING || error == WH_STATUS_WAFER_LOST)) {
            say_miss(&event->event, &names, text, size);
        }
    }
}

/* The last command that failed: its error ended the run. */
static bool explain_error(const wh_record_t *record, wh_budget_why_t *why) {
    size_t last = record->command_count;
    while (last > 0 && record->commands[last - 1].error == WH_OK) {
        --last;
    }
    if (!record->failure || last == 0) {
        return false;
    }
    const wh_command_record_t *command = &record->commands[last - 1];
    char miss[sizeof why->text];
    find_miss(record, (int32_t)last - 1, miss, sizeof miss);
    why->error = command->error;
    why->line = command->line;
    (void)snprintf(why->name, sizeof why->name, "%s", wh_status_name(command->error));
    (void)snprintf(why->command, sizeof why->command, "%s", command->text);
    (void)snprintf(why->text, sizeof why->text, "%.399s",
                   miss[0] ? miss : wh_record_error_text(command->error));
    return true;
}

static bool explain_expectation(const wh_record_t *record, wh_budget_why_t *why) {
    for (size_t i = 0; i < record->expectation_count && !record->failure; ++i) {
        const wh_expectation_record_t *expected = &record->expectations[i];
        if (!expected->ok) {
            why->line = expected->line;
            (void)snprintf(why->name, sizeof why->name, "expectation");
            (void)snprintf(why->text, sizeof why->text, "%.399s", expected->text);
            return true;
        }
    }
    return false;
}

void wh_budget_explain(const wh_record_t *record, const char *message, wh_budget_why_t *why) {
    const wh_event_record_t *complaint = find_complaint(record);
    memset(why, 0, sizeof *why);
    if (complaint) {
        explain_complaint(record, complaint, why);
    } else if (!explain_error(record, why) && !explain_expectation(record, why)) {
        (void)snprintf(why->name, sizeof why->name, "script");
        (void)snprintf(why->text, sizeof why->text, "%.399s", record->failure ? record->failure : message);
    }
}
