#include "vacuum.h"

/* The longest time constant, s, and the distance from its target at which a level reaches it. */
#define LONGEST WH_REAL(3600.0)
#define NEAR WH_REAL(1e-4)

wh_vacuum_config_t wh_vacuum_ideal(void) {
    const wh_vacuum_config_t config = {0, 0, 0, WH_REAL(0.5), WH_REAL(0.5), WH_REAL(0.5), 0};
    return config;
}

wh_vacuum_config_t wh_vacuum_delayed(void) {
    const wh_vacuum_config_t config = {
        WH_REAL(0.05), WH_REAL(0.02), WH_REAL(0.1), WH_REAL(0.7), WH_REAL(0.6), WH_REAL(0.3), 0};
    return config;
}

static bool is_share(wh_real_t value) {
    return value > 0 && value <= 1;
}

static bool is_time(wh_real_t value) {
    return value >= 0 && value <= LONGEST;
}

static bool is_finite(const wh_vacuum_config_t *config) {
    return wh_real_is_finite(config->build) && wh_real_is_finite(config->vent) &&
           wh_real_is_finite(config->idle) && wh_real_is_finite(config->on) &&
           wh_real_is_finite(config->off) && wh_real_is_finite(config->release);
}

static bool are_thresholds(const wh_vacuum_config_t *config) {
    return is_share(config->off) && is_share(config->release) && config->off <= config->on &&
           config->on <= 1 && config->idle >= 0 && config->idle < config->off;
}

wh_status_t wh_vacuum_validate(const wh_vacuum_config_t *config) {
    if (!config) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!is_finite(config)) {
        return WH_STATUS_NOT_FINITE;
    }
    const bool good = are_thresholds(config) && is_time(config->build) && is_time(config->vent) &&
                      config->debounce >= 0 && config->debounce <= WH_VACUUM_DEBOUNCE;
    return good ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

wh_vacuum_fault_t wh_vacuum_sound(void) {
    const wh_vacuum_fault_t upset = {1, 0};
    return upset;
}

wh_vacuum_t wh_vacuum_start(void) {
    const wh_vacuum_t vacuum = {0, WH_VALVE_CLOSED, false, 0};
    return vacuum;
}

/* One slice towards the target. Below WH_REAL's rounding it never passes the target, because the share is
 * at most 1. */
static wh_real_t approach(const wh_vacuum_config_t *config, const wh_vacuum_fault_t *upset, wh_real_t level,
                          wh_real_t target, wh_real_t dt) {
    if (level == target) {
        return target;
    }
    const wh_real_t up = config->build > upset->build ? config->build : upset->build;
    const wh_real_t tau = target > level ? up : config->vent;
    const wh_real_t next = level + (target - level) * (dt / (tau + dt));
    return wh_real_abs(target - next) < NEAR ? target : next;
}

int32_t wh_vacuum_before(const wh_vacuum_config_t *config, const wh_vacuum_fault_t *upset, int32_t command,
                         bool holds, wh_real_t dt, wh_vacuum_t *vacuum) {
    if (command != WH_VALVE_OPEN && command != WH_VALVE_CLOSED) {
        return command;
    }
    vacuum->command = command;
    if (command == WH_VALVE_OPEN) {
        return WH_VALVE_OPEN;
    }
    vacuum->level = approach(config, upset, vacuum->level, 0, dt);
    return holds && vacuum->level >= config->release ? WH_VALVE_OPEN : WH_VALVE_CLOSED;
}

/* Tells a turn of the switch once it has stood. While it waits, the switch stands otherwise than told, and
 * has the other threshold. */
static void tell(const wh_vacuum_config_t *config, wh_vacuum_t *vacuum) {
    const bool was_on = vacuum->on != (vacuum->waits > 0);
    const bool is_on = was_on ? vacuum->level >= config->off : vacuum->level >= config->on;
    if (is_on == vacuum->on) {
        vacuum->waits = 0;
    } else if (vacuum->waits < config->debounce) {
        ++vacuum->waits;
    } else {
        vacuum->on = is_on;
        vacuum->waits = 0;
    }
}

bool wh_vacuum_after(const wh_vacuum_config_t *config, const wh_vacuum_fault_t *upset, bool holds,
                     wh_real_t dt, wh_vacuum_t *vacuum) {
    const bool was_on = vacuum->on;
    const bool open = vacuum->command == WH_VALVE_OPEN;
    if (open) {
        const wh_real_t wanted = holds ? 1 : config->idle;
        vacuum->level =
            approach(config, upset, vacuum->level, wanted < upset->full ? wanted : upset->full, dt);
    }
    tell(config, vacuum);
    return was_on && !vacuum->on && holds && open;
}
