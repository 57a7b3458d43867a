#include "concerns.h"

#include <stdlib.h>

#include "../text/array.h"

/* The wafers and stations that the run without errors had to do with: a flag for each. */
typedef struct {
    const wh_study_t *study;
    bool *wafers, *stations;
} concerns_t;

static void add_wafer(const concerns_t *concerns, int32_t wafer) {
    if (wafer != WH_NONE) {
        concerns->wafers[wafer] = true;
    }
}

static void add_station(const concerns_t *concerns, int32_t station) {
    if (station != WH_NONE) {
        concerns->stations[station] = true;
    }
}

static void add_entry(const concerns_t *concerns, const wh_decisions_entry_t *entry) {
    if (entry->kind == WH_DECISION_HELD) {
        add_wafer(concerns, entry->answer);
    } else if (entry->kind == WH_DECISION_HOLDER) {
        add_wafer(concerns, entry->index);
    }
}

static void add_decisions(const concerns_t *concerns, const wh_decisions_t *decisions) {
    for (size_t i = 0; i < decisions->entry_count; ++i) {
        add_entry(concerns, &decisions->entries[i]);
    }
    for (size_t i = 0; i < decisions->claim_count; ++i) {
        add_wafer(concerns, decisions->claims[i].wafer);
        add_station(concerns, decisions->claims[i].station);
    }
    for (size_t i = 0; i < decisions->asked_count; ++i) {
        add_wafer(concerns, decisions->asked[i].wafer);
        add_station(concerns, decisions->asked[i].station);
    }
    for (size_t i = 0; i < decisions->visits.count; ++i) {
        add_station(concerns, decisions->visits.items[i].station);
    }
    for (size_t i = 0; i < decisions->looked_count; ++i) {
        add_wafer(concerns, decisions->looked[i]);
    }
}

/* The wafers that it moved, and where they lie at first and at last. */
static void add_moved(const concerns_t *concerns) {
    const wh_study_t *study = concerns->study;
    const wh_record_t *record = &study->nominal.record;
    for (size_t i = 0; i < record->event_count; ++i) {
        add_wafer(concerns, record->events[i].event.wafer);
    }
    for (size_t w = 0; w < study->layout->wafer_count; ++w) {
        if (concerns->wafers[w]) {
            add_station(concerns, study->layout->wafers[w].station);
            add_station(concerns, record->wafers[w].place.station);
        }
    }
}

/* Measured numbers, such as a map, may be of any wafer that lies where the run goes. */
static void add_measured(const concerns_t *concerns) {
    const wh_layout_t *layout = concerns->study->layout;
    for (size_t w = 0; concerns->study->decisions.unfit && w < layout->wafer_count; ++w) {
        const int32_t station = layout->wafers[w].station;
        concerns->wafers[w] = concerns->wafers[w] || (station != WH_NONE && concerns->stations[station]);
    }
}

static bool was_visited(const wh_decisions_t *decisions, size_t station, int32_t robot) {
    bool was = false;
    for (size_t i = 0; i < decisions->visits.count; ++i) {
        was = was || (decisions->visits.items[i].station == (int32_t)station &&
                      decisions->visits.items[i].robot == robot);
    }
    return was;
}

/* True if a route of the flow leads to a process in this station of a tool of times alone. */
static bool is_processing(const wh_study_t *study, size_t station) {
    const wh_flow_tool_t *tool = study->layout->tool;
    const wh_flow_plan_t *plan = study->has_flow ? &study->nominal.record.flow->plan : NULL;
    bool found = false;
    for (size_t r = 0; plan && r < plan->route_count; ++r) {
        for (size_t k = 1; k < plan->routes[r].step_count; ++k) {
            const wh_flow_step_t *step = &plan->routes[r].steps[k];
            found =
                found || (wh_flow_step_has(step, (int32_t)station) &&
                          (step->process_us == WH_FLOW_NONE ? wh_flow_is_processing(&tool->stations[station])
                                                            : step->process_us > 0));
        }
    }
    return found;
}

static bool is_concerned(const concerns_t *concerns, const wh_cause_t *cause) {
    const wh_layout_t *layout = concerns->study->layout;
    if (cause->robot != WH_NONE) {
        return was_visited(&concerns->study->decisions, cause->index, cause->robot);
    }
    switch ((int)cause->kind) {
    case WH_CAUSE_WAFER:
    case WH_CAUSE_RIM:
        return layout->collision || concerns->wafers[cause->index];
    case WH_CAUSE_STATION:
        return layout->collision || concerns->stations[cause->index];
    case WH_CAUSE_PROCESS:
        return !layout->tool || is_processing(concerns->study, cause->index);
    case WH_CAUSE_BEAM:
        return concerns->stations[layout->beams[cause->index].station];
    default:
        return true; /* of all there is */
    }
}

wh_cause_t *wh_concerns_choose(const wh_study_t *study, size_t *count) {
    const concerns_t concerns = {study, wh_array_new(study->layout->wafer_count, sizeof(bool)),
                                 wh_array_new(study->layout->station_count, sizeof(bool))};
    wh_cause_t *chosen = wh_array_new(study->drawn_count, sizeof *chosen);
    add_decisions(&concerns, &study->decisions);
    add_moved(&concerns);
    add_measured(&concerns);
    *count = 0;
    for (size_t i = 0; i < study->drawn_count; ++i) {
        if (is_concerned(&concerns, &study->drawn[i])) {
            chosen[(*count)++] = study->drawn[i];
        }
    }
    free(concerns.wafers);
    free(concerns.stations);
    return chosen;
}
