#include "sim/simulator.h"

static wh_status_t exchange_by_call(wh_link_t *link, const wh_command_t *command, wh_state_t *state) {
    return wh_simulator_step((wh_simulator_t *)(void *)link, command, state);
}

static uint64_t hash_by_call(wh_link_t *link) {
    return wh_grasp_hash(&((wh_simulator_t *)(void *)link)->table);
}

static int64_t missed_by_call(wh_link_t *link) {
    (void)link;
    return 0;
}

wh_status_t wh_simulator_init(wh_simulator_t *simulator, const wh_grasp_config_t *config,
                              const wh_grasp_storage_t *storage, const wh_cell_t *cell) {
    if (!simulator || !storage || !cell || (!cell->stations && cell->count > 0)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (storage->gripper_count > WH_GRIPPERS) {
        return WH_STATUS_BAD_CAPACITY;
    }
    const wh_status_t status = wh_grasp_init(&simulator->table, config, storage);
    if (status == WH_OK) {
        simulator->link.exchange = exchange_by_call;
        simulator->link.hash = hash_by_call;
        simulator->link.missed = missed_by_call;
        simulator->cell = *cell;
        simulator->event_count = 0;
        simulator->observer = (wh_observer_t){NULL, NULL, NULL};
    }
    return status;
}

static uint32_t read_sensors(const wh_grasp_t *table) {
    uint32_t sensors = 0;
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        sensors |= table->storage.grippers[g].wafer == WH_NONE ? 0U : 1U << g;
    }
    return sensors;
}

static wh_status_t step_table(wh_simulator_t *simulator, const wh_command_t *command) {
    if (command->gripper_count != simulator->table.storage.gripper_count) {
        ++simulator->table.counters.refused;
        simulator->event_count = 0;
        return WH_STATUS_OUT_OF_RANGE;
    }
    wh_event_list_t list = {simulator->events, sizeof simulator->events / sizeof simulator->events[0], 0};
    const wh_status_t status = wh_grasp_step(&simulator->table, command->grippers, &list);
    if (status == WH_OK && list.count > 0) {
        (void)wh_cell_judge(&simulator->cell, &simulator->table, &list);
        wh_cell_settle(&simulator->cell, &simulator->table, &list);
    }
    if (status == WH_OK && simulator->observer.look) {
        simulator->observer.look(simulator->observer.user, command, &simulator->table, &list);
    }
    simulator->event_count = list.count;
    return status;
}

void wh_simulator_view(const wh_simulator_t *simulator, wh_state_t *state) {
    const wh_grasp_t *table = &simulator->table;
    state->wafers = table->storage.wafers;
    state->wafer_count = table->storage.wafer_count;
    state->grippers = table->storage.grippers;
    state->gripper_count = table->storage.gripper_count;
    state->events = simulator->events;
    state->event_count = simulator->event_count;
    state->sensors = read_sensors(table);
}

wh_status_t wh_simulator_step(wh_simulator_t *simulator, const wh_command_t *command, wh_state_t *state) {
    if (!simulator || !command || !state) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    state->status = step_table(simulator, command);
    state->utime = command->utime;
    state->seq = command->seq;
    wh_simulator_view(simulator, state);
    return state->status;
}
