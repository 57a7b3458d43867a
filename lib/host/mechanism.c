#include "mechanism.h"

#include <stdio.h>
#include <string.h>

static bool is_aligner(const wh_layout_t *layout, int32_t station) {
    return layout->places[station].chuck != WH_NONE;
}

/* True if the gripper is on that robot or at that station; WH_NONE: on any, or at any. */
static bool is_own(const wh_port_mechanism_t *mechanism, const wh_layout_t *layout, size_t g) {
    const int32_t station = layout->grippers[g].station;
    const int32_t at = mechanism->kind == WH_MECHANISM_ROBOT ? layout->machine.mounts[g].robot : station;
    if (mechanism->kind == WH_MECHANISM_CELL) {
        return true;
    }
    if ((mechanism->kind == WH_MECHANISM_ROBOT) != (station == WH_NONE)) {
        return false;
    }
    return mechanism->index == WH_NONE ? mechanism->kind != WH_MECHANISM_LOAD_PORT : at == mechanism->index;
}

static uint32_t own_grippers(const wh_port_mechanism_t *mechanism, const wh_layout_t *layout) {
    uint32_t grippers = 0;
    for (size_t g = 0; layout && g < layout->machine.gripper_count; ++g) {
        grippers |= is_own(mechanism, layout, g) ? 1U << g : 0;
    }
    return grippers;
}

wh_port_mechanism_t wh_mechanism_all(wh_mechanism_t kind, const wh_layout_t *layout) {
    wh_port_mechanism_t all = {.kind = kind, .index = WH_NONE};
    all.grippers = own_grippers(&all, layout);
    return all;
}

/* The layout's name of that number, if it is one of this kind; else an empty text. Null: no more. */
static const char *name_at(wh_mechanism_t kind, const wh_layout_t *layout, size_t i) {
    const bool is_robot = kind == WH_MECHANISM_ROBOT;
    if (i >= (is_robot ? layout->robot_count : layout->station_count)) {
        return NULL;
    }
    if (is_robot) {
        return layout->robots[i].name;
    }
    const bool is_its_kind = is_aligner(layout, (int32_t)i) == (kind == WH_MECHANISM_ALIGNER);
    return is_its_kind ? layout->stations[i].name : "";
}

/* Fills in the mechanism if there is one of this kind and name. */
static bool find_of_kind(wh_mechanism_t kind, const char *name, const wh_layout_t *layout,
                         wh_port_mechanism_t *mechanism) {
    const char *found = name_at(kind, layout, 0);
    size_t i = 0;
    while (found && (found[0] == '\0' || strcmp(found, name) != 0)) {
        found = name_at(kind, layout, ++i);
    }
    if (found) {
        *mechanism = (wh_port_mechanism_t){kind, (int32_t)i, found, 0};
        mechanism->grippers = own_grippers(mechanism, layout);
    }
    return found;
}

static void add_names(wh_mechanism_t kind, const wh_layout_t *layout, char problem[WH_MECHANISM_PROBLEM]) {
    const char *name = name_at(kind, layout, 0);
    for (size_t i = 0; name; name = name_at(kind, layout, ++i)) {
        const size_t length = strlen(problem);
        const bool is_first = problem[length - 1] == ' ';
        if (name[0] != '\0') {
            (void)snprintf(problem + length, WH_MECHANISM_PROBLEM - length, "%s%.63s", is_first ? "" : ", ",
                           name);
        }
    }
}

bool wh_mechanism_find(wh_mechanism_t kind, const char *name, const wh_layout_t *layout,
                       wh_port_mechanism_t *mechanism, char problem[WH_MECHANISM_PROBLEM]) {
    bool is_found = false;
    (void)snprintf(problem, WH_MECHANISM_PROBLEM, "%.63s (expected %s of the layout: ", name,
                   kind == WH_MECHANISM_CELL      ? "a robot or a station"
                   : kind == WH_MECHANISM_ROBOT   ? "a robot"
                   : kind == WH_MECHANISM_ALIGNER ? "a prealigner"
                                                  : "a station that is no prealigner");
    for (wh_mechanism_t k = WH_MECHANISM_ROBOT; k < WH_MECHANISMS && !is_found; ++k) {
        if (kind == WH_MECHANISM_CELL || kind == k) {
            is_found = find_of_kind(k, name, layout, mechanism);
            add_names(k, layout, problem);
        }
    }
    const size_t length = strlen(problem);
    (void)snprintf(problem + length, WH_MECHANISM_PROBLEM - length, ")");
    return is_found;
}

const char *wh_mechanism_only(wh_mechanism_t kind, const wh_layout_t *layout) {
    const char *only = NULL;
    size_t count = 0;
    for (size_t i = 0; kind != WH_MECHANISM_CELL; ++i) {
        const char *name = name_at(kind, layout, i);
        if (!name) {
            break;
        }
        only = name[0] != '\0' ? name : only;
        count += name[0] != '\0' ? 1 : 0;
    }
    return count == 1 ? only : NULL;
}

bool wh_mechanisms_clash(const wh_port_mechanism_t *a, const wh_port_mechanism_t *b) {
    if (a->kind == WH_MECHANISM_CELL || b->kind == WH_MECHANISM_CELL) {
        return true;
    }
    return a->kind == b->kind && (a->index == WH_NONE || b->index == WH_NONE || a->index == b->index);
}

bool wh_mechanism_does(wh_mechanism_t kind, const wh_word_t *word) {
    return kind == WH_MECHANISM_CELL || (word->mechanisms >> kind & 1U) != 0;
}
