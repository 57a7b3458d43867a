/* Reads by which rule the robots of a flow choose: a name, or lists. */
#include <lauxlib.h>
#include <string.h>

#include "../reading/layout_internal.h"
#include "../reading/tool_routes.h"
#include "../text/array.h"
#include "flow_plan.h"

/* In a cell with axes wafers have the names of those that lie in their slots, which is looked at later. */
static int32_t ask_wafer(wh_flow_plan_t *plan, const char *name) {
    size_t number = 0;
    while (number < plan->asked.count && strcmp(plan->asked.items[number], name) != 0) {
        ++number;
    }
    if (number == plan->asked.count) {
        plan->asked.items = wh_array_grow(plan->asked.items, plan->asked.count, &plan->asked.capacity,
                                          sizeof *plan->asked.items);
        plan->asked.items[plan->asked.count++] = wh_text_copy(name);
    }
    return WH_FLOW_ASKED((int32_t)number);
}

static int32_t find_wafer(wh_reader_t *reader, const wh_flow_plan_t *plan, const char *name) {
    for (size_t i = 0; i < plan->wafer_count; ++i) {
        if (strcmp(plan->wafers[i].name, name) == 0) {
            return (int32_t)i;
        }
    }
    wh_reader_refuse(reader, "[3]", name, "a wafer of the lots by name");
}

/* { "pump", "LLA", "vacuum" } */
static void read_pump(wh_reader_t *reader, const wh_flow_tool_t *tool, const char *lock, const char *side,
                      wh_flow_line_t *line) {
    line->what = WH_FLOW_PUMP;
    line->to = wh_timed_find_station(reader, tool, "[2]", lock);
    line->side = strcmp(side, "vacuum") == 0 ? WH_FLOW_VACUUM : WH_FLOW_ATMOSPHERE;
    if (!tool->stations[line->to].is_lock ||
        (line->side == WH_FLOW_ATMOSPHERE && strcmp(side, "atmosphere") != 0)) {
        wh_reader_fail(reader, NULL, "{ \"pump\", LOAD LOCK, \"vacuum\" } or \"atmosphere\"");
    }
}

/* { "LLA", "PM1" }, { "PM2", "keep" }, { "keep", "PM3" } */
static void read_way(wh_reader_t *reader, const wh_flow_tool_t *tool, const char *from, const char *to,
                     wh_flow_line_t *line) {
    const bool brings = strcmp(from, "keep") == 0, keeps = strcmp(to, "keep") == 0;
    line->what = brings ? WH_FLOW_BRING : keeps ? WH_FLOW_KEEP : WH_FLOW_TRANSFER;
    if (brings && keeps) {
        wh_reader_fail(reader, NULL, "one \"keep\" in a line");
    }
    line->from = brings ? WH_FLOW_NONE : wh_timed_find_station(reader, tool, "[1]", from);
    line->to = keeps ? WH_FLOW_NONE : wh_timed_find_station(reader, tool, "[2]", to);
}

static void read_line(wh_reader_t *reader, const wh_flow_tool_t *tool, wh_flow_plan_t *plan,
                      wh_flow_line_t *line) {
    char first[WH_NAME_SIZE], second[WH_NAME_SIZE], third[WH_NAME_SIZE];
    const size_t count = wh_reader_list(reader);
    if (count < 2 || count > 3) {
        wh_reader_fail(reader, NULL, "{ FROM, TO }, with a wafer's name if another than the first is meant");
    }
    (void)wh_timed_read_entry(reader, 1, first);
    (void)wh_timed_read_entry(reader, 2, second);
    (void)wh_timed_read_entry(reader, 3, third);
    *line = WH_FLOW_NO_LINE;
    if (strcmp(first, "pump") == 0) {
        read_pump(reader, tool, second, third, line);
        return;
    }
    read_way(reader, tool, first, second, line);
    if (third[0] != '\0') {
        line->wafer = wh_flow_has_real(tool) ? ask_wafer(plan, third) : find_wafer(reader, plan, third);
    }
}

static void check_served(wh_reader_t *reader, const wh_flow_tool_t *tool, int32_t robot,
                         const wh_flow_line_t *line) {
    const int32_t both[] = {line->from, line->to};
    for (size_t i = 0; i < 2; ++i) {
        if (both[i] != WH_FLOW_NONE && line->what != WH_FLOW_PUMP &&
            !tool->serves[wh_flow_of(tool, robot, both[i])]) {
            wh_reader_refuse(reader, i == 0 ? "[1]" : "[2]", tool->stations[both[i]].name,
                             "a station that %s serves", tool->robots[robot].name);
        }
    }
}

/* Long lists are made of few tables, again and again: the lines that were read from the last ones. */
#define KNOWN 64

typedef struct {
    const void *tables[KNOWN];
    size_t lines[KNOWN];
    size_t count;
} known_t;

/* The number of an equal line before it, or SIZE_MAX; it is noted where the line of this table stands. */
static size_t find_known(known_t *known, const void *table, size_t line) {
    for (size_t i = 0; table && i < KNOWN && i < known->count; ++i) {
        if (known->tables[i] == table) {
            return known->lines[i];
        }
    }
    known->tables[known->count % KNOWN] = table;
    known->lines[known->count++ % KNOWN] = line;
    return SIZE_MAX;
}

static void read_list(wh_reader_t *reader, const wh_flow_tool_t *tool, wh_flow_plan_t *plan, int32_t robot) {
    wh_flow_list_t *list = &plan->lists[robot];
    const size_t count = wh_reader_list(reader);
    known_t known = {.count = 0};
    for (size_t i = 0; i < count; ++i) {
        list->lines = wh_array_grow(list->lines, list->count, &list->capacity, sizeof *list->lines);
        lua_rawgeti(reader->L, -1, (lua_Integer)i + 1);
        const size_t equal = find_known(&known, lua_topointer(reader->L, -1), i);
        lua_pop(reader->L, 1);
        if (equal != SIZE_MAX) {
            list->lines[i] = list->lines[equal];
        } else {
            (void)wh_reader_enter_item(reader, (lua_Integer)i + 1);
            read_line(reader, tool, plan, &list->lines[i]);
            check_served(reader, tool, robot, &list->lines[i]);
            wh_reader_leave(reader);
        }
        list->count = i + 1;
    }
}

static void read_lists(wh_reader_t *reader, const wh_flow_tool_t *tool, wh_flow_plan_t *plan) {
    size_t count = 0;
    plan->rule = WH_FLOW_LISTS;
    plan->lists = wh_array_new(tool->robot_count, sizeof *plan->lists);
    (void)wh_reader_open(reader, "rule", wh_flow_list_fields);
    if (!wh_reader_enter(reader, "order")) {
        wh_reader_refuse(reader, "order", NULL, "each robot's transfers in order, by its name");
    }
    const wh_timed_name_t *robots = wh_layout_read_keys(reader, 1000, sizeof *robots, "robots", &count);
    for (size_t i = 0; i < count; ++i) {
        const int32_t robot = wh_flow_robot_named(tool, robots[i].name);
        if (robot == WH_FLOW_NONE) {
            wh_reader_refuse(reader, robots[i].name, NULL, "robots of the layout by name");
        }
        if (wh_reader_enter(reader, robots[i].name)) {
            read_list(reader, tool, plan, robot);
            wh_reader_leave(reader);
        }
    }
    wh_reader_leave(reader);
    wh_reader_leave(reader);
}

void wh_flow_read_rule(wh_reader_t *reader, const wh_flow_tool_t *tool, wh_flow_plan_t *plan) {
    static const char *const rules[] = {"backward", "swap", "first_come", "longest_wait", NULL};
    const int type = wh_reader_push(reader, "rule");
    lua_pop(reader->L, 1);
    if (type == LUA_TTABLE) {
        read_lists(reader, tool, plan);
    } else if (type == LUA_TFUNCTION) {
        plan->rule = WH_FLOW_OWN;
    } else {
        plan->rule = (wh_flow_rule_t)wh_reader_choice(reader, "rule", 0, rules);
    }
}
