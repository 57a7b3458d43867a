#include "causes.h"

#include "../layout/beam_errors.h"
#include "../layout/ports.h"
#include "../layout/times.h"
#include "../text/array.h"

#define COMPONENTS 6

typedef struct {
    wh_cause_t *causes;
    size_t count, capacity;
} list_t;

static void add(list_t *list, wh_cause_kind_t kind, size_t index, size_t component, double width) {
    if (width > 0) {
        list->causes = wh_array_grow(list->causes, list->count, &list->capacity, sizeof *list->causes);
        list->causes[list->count++] = (wh_cause_t){kind, index, component, WH_NONE, width};
    }
}

/* A wafer's tilt is one width, drawn about x and about y. */
static size_t spread_of(wh_cause_kind_t kind, size_t component) {
    return kind == WH_CAUSE_WAFER && component >= 4 ? component - 1 : component;
}

static void add_spreads(list_t *list, wh_cause_kind_t kind, size_t index, const wh_spreads_t *spreads) {
    for (size_t component = 0; component < COMPONENTS; ++component) {
        add(list, kind, index, component, spreads->of[spread_of(kind, component)].width);
    }
}

/* With several robots: the taught place of each robot that serves the station, then the station's own
 * errors. */
static void add_taught(list_t *list, const wh_layout_t *layout, size_t station, const wh_spreads_t *spreads) {
    for (size_t r = 0; r < layout->robot_count; ++r) {
        for (size_t i = 0; i < 3 && layout->stations[station].by[r].serves; ++i) {
            const size_t before = list->count;
            add(list, WH_CAUSE_STATION, station, i, spreads->of[i].width);
            for (size_t added = before; added < list->count; ++added) {
                list->causes[added].robot = (int32_t)r;
            }
        }
    }
    for (size_t i = 3; i < COMPONENTS; ++i) {
        add(list, WH_CAUSE_STATION, station, i, spreads->of[i].width);
    }
}

/* Only features that the wafer's rim has. */
static void add_rim(list_t *list, const wh_layout_t *layout, size_t wafer) {
    for (size_t i = 0; i < WH_RIM_WIDTHS; ++i) {
        const bool has = wh_rim_draw_concerns((wh_rim_draw_t)i, layout->rims[wafer]);
        add(list, WH_CAUSE_RIM, wafer, i, has ? layout->errors->rims[wafer].of[i].width : 0);
    }
}

/* Faces have no errors within their block. */
static void add_beam(list_t *list, const wh_layout_t *layout, size_t beam) {
    for (size_t i = 0; layout->doors[beam].kind == WH_DOOR_LIGHT && i < WH_BEAM_DRAWS; ++i) {
        add(list, WH_CAUSE_BEAM, beam, i, layout->errors->beams[beam].of[i].width);
    }
}

static void add_processes(list_t *list, const wh_layout_t *layout, const wh_errors_t *errors) {
    for (size_t s = 0; layout->tool && s < layout->tool->station_count; ++s) {
        add(list, WH_CAUSE_PROCESS, s, 0, errors->process.width);
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        if (layout->stations[s].times && wh_flow_is_processing(&layout->stations[s].times->of)) {
            add(list, WH_CAUSE_PROCESS, s, 0, errors->process.width);
        }
    }
}

/* Each step of a load port that takes any time. */
static void add_ports(list_t *list, const wh_layout_t *layout, const wh_errors_t *errors) {
    for (size_t s = 0; s < layout->station_count; ++s) {
        const wh_layout_port_t *port = layout->stations[s].port;
        for (size_t step = 1; port && step < WH_LOAD_PORT_STEPS; ++step) {
            const bool is_it = wh_load_port_has(&port->of, (wh_load_port_step_t)step);
            add(list, WH_CAUSE_PORT, s, step, is_it ? errors->port.width : 0);
        }
    }
}

static void add_all(list_t *list, const wh_layout_t *layout, const wh_errors_t *errors) {
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        add_spreads(list, WH_CAUSE_WAFER, w, &errors->wafers[w]);
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        if (layout->robot_count > 1) {
            add_taught(list, layout, s, &errors->stations[s]);
        } else {
            add_spreads(list, WH_CAUSE_STATION, s, &errors->stations[s]);
        }
    }
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        add(list, WH_CAUSE_VALVE, g, 0, errors->valves[g].width);
    }
    add(list, WH_CAUSE_VACUUM, 0, 0, errors->vacuum.width);
    for (size_t w = 0; errors->rims && w < layout->wafer_count; ++w) {
        add_rim(list, layout, w);
    }
    for (size_t b = 0; b < layout->beam_count; ++b) {
        add_beam(list, layout, b);
    }
    add_processes(list, layout, errors);
    add(list, WH_CAUSE_DEBOUNCE, 0, 0, errors->debounce.width);
    add_ports(list, layout, errors);
}

wh_cause_t *wh_causes_of(const wh_layout_t *layout, size_t *count) {
    list_t list = {wh_array_new(1, sizeof *list.causes), 0, 1};
    if (layout->errors) {
        add_all(&list, layout, layout->errors);
    }
    *count = list.count;
    return list.causes;
}

static wh_displacement_t draw_station(const wh_errors_t *errors, const wh_trial_t *trial,
                                      const wh_cause_t *cause) {
    if (cause->robot == WH_NONE) {
        return wh_errors_draw_station(errors, trial, cause->index);
    }
    return (wh_displacement_t){wh_errors_draw_taught(errors, trial, cause->index, (size_t)cause->robot),
                               {0, 0, 0}};
}

static double component_of(const wh_displacement_t *drawn, size_t component) {
    const double moved[] = {drawn->moved.x, drawn->moved.y, drawn->moved.z};
    return component < 3 ? moved[component] : drawn->turn[component - 3];
}

static double draw_rim(const wh_layout_t *layout, const wh_trial_t *trial, const wh_cause_t *cause) {
    double drawn[WH_RIM_DRAWS];
    wh_errors_draw_rim(layout->errors, trial, cause->index, layout->rims[cause->index], drawn);
    return drawn[cause->component];
}

static double draw_beam(const wh_errors_t *errors, const wh_trial_t *trial, const wh_cause_t *cause) {
    double drawn[WH_BEAM_DRAWS];
    wh_errors_draw_beam(errors, trial, cause->index, drawn);
    return drawn[cause->component];
}

static bool is_displacement(wh_cause_kind_t kind) {
    return kind == WH_CAUSE_WAFER || kind == WH_CAUSE_STATION;
}

static double draw_other(const wh_layout_t *layout, const wh_trial_t *trial, const wh_cause_t *cause) {
    const wh_errors_t *errors = layout->errors;
    return cause->kind == WH_CAUSE_VALVE      ? wh_errors_draw_valve(errors, trial, cause->index)
           : cause->kind == WH_CAUSE_VACUUM   ? wh_errors_draw_vacuum(errors, trial)
           : cause->kind == WH_CAUSE_DEBOUNCE ? wh_errors_draw_debounce(errors, trial)
           : cause->kind == WH_CAUSE_PROCESS  ? wh_errors_draw_process(errors, trial, cause->index)
           : cause->kind == WH_CAUSE_PORT ? wh_errors_draw_port(errors, trial, cause->index, cause->component)
           : cause->kind == WH_CAUSE_RIM  ? draw_rim(layout, trial, cause)
                                          : draw_beam(errors, trial, cause);
}

/* A displacement is drawn once, for all of its components that follow each other. */
void wh_causes_draw(const wh_cause_t causes[], size_t count, const wh_layout_t *layout,
                    const wh_trial_t *trial, double drawn[]) {
    const wh_errors_t *errors = layout->errors;
    wh_displacement_t last = {0};
    for (size_t i = 0; i < count; ++i) {
        const wh_cause_t *cause = &causes[i];
        const bool goes_on = i > 0 && causes[i - 1].kind == cause->kind &&
                             causes[i - 1].index == cause->index && causes[i - 1].robot == cause->robot;
        if (!is_displacement(cause->kind)) {
            drawn[i] = draw_other(layout, trial, cause);
            continue;
        }
        if (!goes_on) {
            last = cause->kind == WH_CAUSE_WAFER ? wh_errors_draw_wafer(errors, trial, cause->index)
                                                 : draw_station(errors, trial, cause);
        }
        drawn[i] = component_of(&last, cause->component);
    }
}

const char *wh_cause_what(const wh_cause_t *cause) {
    static const char *const wafer[COMPONENTS] = {"dx", "dy", "dz", "tilt_x", "tilt_y", "turn"};
    static const char *const station[COMPONENTS] = {"x", "y", "z", "roll", "pitch", "yaw"};
    return cause->kind == WH_CAUSE_WAFER     ? wafer[cause->component]
           : cause->kind == WH_CAUSE_STATION ? station[cause->component]
           : cause->kind == WH_CAUSE_RIM     ? wh_rim_draw_name((wh_rim_draw_t)cause->component)
           : cause->kind == WH_CAUSE_BEAM    ? wh_beam_draw_name((wh_beam_draw_t)cause->component)
           : cause->kind == WH_CAUSE_VALVE   ? "valve"
           : cause->kind == WH_CAUSE_PROCESS ? "process"
           : cause->kind == WH_CAUSE_PORT    ? wh_load_port_step_name((wh_load_port_step_t)cause->component)
           : cause->kind == WH_CAUSE_VACUUM  ? "vacuum"
                                             : "debounce";
}

static bool is_delay(const wh_cause_t *cause) {
    return cause->kind == WH_CAUSE_VALVE || cause->kind == WH_CAUSE_VACUUM ||
           cause->kind == WH_CAUSE_DEBOUNCE;
}

bool wh_cause_has_sign(const wh_cause_t *cause) {
    const bool is_rim = cause->kind == WH_CAUSE_RIM;
    const bool is_beam = cause->kind == WH_CAUSE_BEAM;
    return !is_delay(cause) && !(is_rim && wh_rim_draw_is_size((wh_rim_draw_t)cause->component)) &&
           !(is_beam && wh_beam_draw_is_size((wh_beam_draw_t)cause->component));
}

const char *wh_cause_unit(const wh_cause_t *cause) {
    if (cause->kind == WH_CAUSE_RIM) {
        return wh_rim_draw_unit((wh_rim_draw_t)cause->component);
    }
    if (cause->kind == WH_CAUSE_BEAM) {
        return wh_beam_draw_unit((wh_beam_draw_t)cause->component);
    }
    return is_delay(cause) || cause->kind == WH_CAUSE_PROCESS || cause->kind == WH_CAUSE_PORT ? "s"
           : cause->component < 3                                                             ? "mm"
                                                                                              : "deg";
}

const char *wh_cause_robot(const wh_cause_t *cause, const wh_layout_t *layout) {
    return cause->robot == WH_NONE ? NULL : layout->robots[cause->robot].name;
}

const char *wh_cause_of(const wh_cause_t *cause, const wh_layout_t *layout) {
    const bool is_wafer = cause->kind == WH_CAUSE_WAFER || cause->kind == WH_CAUSE_RIM;
    return is_wafer                                          ? layout->wafers[cause->index].name
           : cause->kind == WH_CAUSE_PROCESS && layout->tool ? layout->tool->stations[cause->index].name
           : cause->kind == WH_CAUSE_STATION || cause->kind == WH_CAUSE_PROCESS ||
                   cause->kind == WH_CAUSE_PORT
               ? layout->stations[cause->index].name
           : cause->kind == WH_CAUSE_VALVE ? layout->grippers[cause->index].name
           : cause->kind == WH_CAUSE_BEAM  ? layout->beams[cause->index].name
                                           : NULL;
}
