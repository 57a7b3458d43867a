#include "flow_plan.h"

#include <lauxlib.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/ports.h"
#include "../reading/layout_internal.h"
#include "../reading/layout_tool.h"
#include "../reading/tool_routes.h"
#include "../text/array.h"

#define END                                                                                                  \
    { NULL, NULL, NULL, false }

/* The most wafers of a flow. */
#define MOST_WAFERS 1000000

const wh_reader_field_t wh_flow_fields[] = {
    {"lots", "waferhand.lot[]", "the lots", true},
    {"routes", "table<string, waferhand.route>", "their routes by name", true},
    {"rule", "\"backward\"|\"swap\"|\"first_come\"|\"longest_wait\"|waferhand.lists|fun(tool: table): table?",
     "how robots choose; backward", false},
    {"on_error", "fun(tool: table, problem: table): string?",
     "hears of stays beyond windows and of stations that fail; a text that it returns ends the flow", false},
    {"until_s", "number", "s: the flow is cut there", false},
    {"down", "waferhand.down[]", "stations that fail for a while, and robots that are held", false},
    {"takt", "number", "s: the least time between two wafers' starts", false},
    {"safe", "boolean", "false: rules may begin transfers after which wafers could block each other", false},
    {"gains", "boolean",
     "true: what 10 % less time of each robot and station brings, by playing the flow once more for each; "
     "not beside "
     "a function as rule",
     false},
    {"late", "\"fail\"|\"tell\"", "a stay beyond a station's window fails the run, or is told alone; fail",
     false},
    END};

const wh_reader_field_t wh_flow_lot_fields[] = {
    {"name", "string", "its wafers are NAME.1, NAME.2, ...; without one W1, W2, ...", false},
    {"wafers", "waferhand.lot_wafers", "{ STATION, FIRST SLOT, LAST SLOT }", true},
    {"route", "string", "the route's name; the only one", false},
    {"arrives", "number", "s; 0", false},
    {"priority", "integer", "the higher one wins ties, as of lots that arrive together; 0", false},
    {"recipe", "string|table",
     "by which stations process its wafers, in place of their own; also by slot: { default = , [3] = }",
     false},
    {"back", "string", "the station where each wafer ends in a slot of its number", false},
    {"carrier", "string",
     "the layout's carrier that comes to the lot's load port when the lot arrives; robots with axes alone",
     false},
    {"leaves", "boolean",
     "true: the carrier goes when the lot is over; without it as soon as another one waits for its port; "
     "true "
     "with `carrier`",
     false},
    {"dummy", "boolean", "true: its wafers are moved and not counted", false},
    {"map", "boolean",
     "true: a robot maps the station before it takes the first wafer; robots with axes alone", false},
    END};

const wh_reader_field_t wh_flow_down_fields[] = {
    {"at", "number", "s", true}, {"seconds", "number", "s; for ever", false}, END};

const wh_reader_field_t wh_flow_list_fields[] = {
    {"order", "table<string, string[][]>", "each robot's transfers in order", true}, END};

/* --------------------------------------------------------------------------------------------------- lots */

static int32_t add_route(wh_reader_t *reader, const wh_flow_tool_t *tool, wh_flow_plan_t *plan,
                         const char *name) {
    plan->routes = realloc(plan->routes, (plan->route_count + 1) * sizeof *plan->routes);
    plan->routes = wh_memory_need(plan->routes);
    wh_flow_route_t *route = &plan->routes[plan->route_count++];
    memset(route, 0, sizeof *route);
    (void)wh_reader_enter(reader, "routes");
    wh_timed_read_route(reader, tool, name, route);
    wh_reader_leave(reader);
    return (int32_t)plan->route_count - 1;
}

/* A lot's part of the plan, before lots are put in order. */
typedef struct {
    wh_flow_lot_t lot;
    int32_t station, first, last, back;
    int32_t *recipes; /* by wafer; null: their own */
    char name[WH_NAME_SIZE], route[WH_NAME_SIZE];
    size_t index;
} lot_t;

static int32_t whole_entry(wh_reader_t *reader, int32_t index, int32_t least, int32_t most,
                           const char *what) {
    char field[16];
    int is_whole = 0;
    (void)snprintf(field, sizeof field, "[%d]", (int)index);
    lua_rawgeti(reader->L, -1, index);
    const lua_Integer value = lua_tointegerx(reader->L, -1, &is_whole);
    if (!is_whole || value < least || value > most) {
        wh_reader_fail(reader, field, "%s, from %d to %d", what, (int)least, (int)most);
    }
    lua_pop(reader->L, 1);
    return (int32_t)value;
}

static void read_wafers(wh_reader_t *reader, const wh_flow_tool_t *tool, lot_t *lot) {
    char name[WH_NAME_SIZE];
    if (!wh_reader_enter(reader, "wafers")) {
        wh_reader_refuse(reader, "wafers", NULL, "{ STATION, FIRST SLOT, LAST SLOT }");
    }
    if (wh_reader_list(reader) != 3) {
        wh_reader_fail(reader, NULL, "{ STATION, FIRST SLOT, LAST SLOT }");
    }
    lot->station = wh_timed_find_station(reader, tool, "[1]", wh_timed_read_entry(reader, 1, name));
    const int32_t slots = tool->stations[lot->station].slots;
    lot->first = whole_entry(reader, 2, 1, slots, "a slot");
    lot->last = whole_entry(reader, 3, lot->first, slots, "a slot not below the first");
    wh_reader_leave(reader);
}

/* The name of the only route, or an error. */
static void read_route_name(wh_reader_t *reader, const wh_timed_name_t *routes, size_t route_count,
                            char name[WH_NAME_SIZE]) {
    if (route_count == 1 && !wh_reader_has(reader, "route")) {
        (void)snprintf(name, WH_NAME_SIZE, "%s", routes[0].name);
        return;
    }
    wh_reader_text(reader, "route", NULL, name, WH_NAME_SIZE);
    for (size_t i = 0; i < route_count; ++i) {
        if (strcmp(routes[i].name, name) == 0) {
            return;
        }
    }
    wh_reader_refuse(reader, "route", name, "the name of one of the routes");
}

/* The recipe of one slot: the entry with its number, or `default`. */
static int32_t read_slot_recipe(wh_reader_t *reader, const wh_flow_tool_t *tool, int32_t slot) {
    char field[24];
    size_t length = 0;
    (void)snprintf(field, sizeof field, "[%d]", (int)slot);
    const bool is_own = lua_rawgeti(reader->L, -1, slot) != LUA_TNIL;
    if (!is_own) {
        lua_pop(reader->L, 1);
        (void)wh_reader_push(reader, "default");
    }
    const int type = lua_type(reader->L, -1);
    const char *name = type == LUA_TSTRING ? lua_tolstring(reader->L, -1, &length) : "";
    if (type != LUA_TSTRING && type != LUA_TNIL) {
        wh_reader_fail(reader, is_own ? field : "default", "the name of a recipe");
    }
    const int32_t recipe =
        type == LUA_TNIL ? 0
                         : wh_layout_find_recipe(reader, &tool->recipes, is_own ? field : "default", name);
    lua_pop(reader->L, 1);
    return recipe;
}

/* Entries that are no slot of the lot would be read by nobody. */
static void refuse_other_slots(wh_reader_t *reader, const lot_t *lot) {
    lua_State *L = reader->L;
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        const bool is_default = lua_type(L, -2) == LUA_TSTRING && strcmp(lua_tostring(L, -2), "default") == 0;
        const lua_Integer slot = lua_isinteger(L, -2) ? lua_tointeger(L, -2) : 0;
        if (!is_default && (slot < lot->first || slot > lot->last)) {
            wh_reader_fail(reader, NULL, "recipes by slots from %d to %d, and `default`", (int)lot->first,
                           (int)lot->last);
        }
    }
}

/* `recipe`: a name, or names by slot. */
static void read_recipes(wh_reader_t *reader, const wh_flow_tool_t *tool, lot_t *lot) {
    const int type = wh_reader_push(reader, "recipe");
    lua_pop(reader->L, 1);
    if (type == LUA_TNIL) {
        return;
    }
    const size_t count = (size_t)(lot->last - lot->first) + 1;
    const int32_t one = type == LUA_TTABLE ? 0 : wh_layout_read_recipe(reader, &tool->recipes);
    lot->recipes = wh_layout_memory(reader->L, count, sizeof *lot->recipes);
    if (type == LUA_TTABLE) {
        (void)wh_reader_enter(reader, "recipe");
        refuse_other_slots(reader, lot);
    }
    for (size_t i = 0; i < count; ++i) {
        lot->recipes[i] = type == LUA_TTABLE ? read_slot_recipe(reader, tool, lot->first + (int32_t)i) : one;
    }
    if (type == LUA_TTABLE) {
        wh_reader_leave(reader);
    }
}

/* `carrier` and `leaves`, of a load port's lot. */
static void read_carrier(wh_reader_t *reader, const wh_flow_tool_t *tool, const wh_layout_t *layout,
                         lot_t *lot) {
    const bool is_port = tool->stations[lot->station].is_real_port;
    const char *const fields[] = {"carrier", "leaves"};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0] && !is_port; ++i) {
        wh_layout_refuse_field(reader, fields[i],
                               !layout->tool ? "nothing: the lot comes from no load port"
                                             : "nothing: the robots are times alone");
    }
    if (wh_reader_has(reader, "carrier")) {
        lot->lot.carrier = 1 + wh_layout_read_name(reader, layout, "carrier", NULL, wh_layout_find_carrier,
                                                   "a carrier of the layout, by name");
    }
    lot->lot.leaves = wh_reader_boolean(reader, "leaves", lot->lot.carrier > 0);
}

static void read_lot(wh_reader_t *reader, const wh_flow_tool_t *tool, const wh_layout_t *layout,
                     const wh_timed_name_t *routes, size_t route_count, lot_t *lot) {
    wh_reader_refuse_unknown(reader, wh_flow_lot_fields);
    if (wh_reader_has(reader, "name")) {
        wh_reader_text(reader, "name", NULL, lot->name, sizeof lot->name);
    }
    read_wafers(reader, tool, lot);
    read_recipes(reader, tool, lot);
    read_route_name(reader, routes, route_count, lot->route);
    lot->lot.arrives_us = wh_flow_read_us(reader, "arrives", 0);
    lot->lot.priority = wh_reader_whole(reader, "priority", 0, -1000, 1000);
    lot->lot.is_dummy = wh_reader_boolean(reader, "dummy", false);
    lot->lot.is_mapped = wh_reader_boolean(reader, "map", false);
    wh_flow_refuse_timed(reader, tool, lot->station, "map", lot->lot.is_mapped);
    read_carrier(reader, tool, layout, lot);
    lot->back = WH_FLOW_NONE;
    if (wh_reader_has(reader, "back")) {
        char back[WH_NAME_SIZE];
        wh_reader_text(reader, "back", NULL, back, sizeof back);
        lot->back = wh_timed_find_station(reader, tool, "back", back);
        if (tool->stations[lot->back].slots < lot->last) {
            wh_reader_refuse(reader, "back", back, "a station with at least %d slots", (int)lot->last);
        }
    }
}

static int by_arrival(const void *a, const void *b) {
    const lot_t *one = a, *other = b;
    if (one->lot.arrives_us != other->lot.arrives_us) {
        return one->lot.arrives_us < other->lot.arrives_us ? -1 : 1;
    }
    if (one->lot.priority != other->lot.priority) {
        return one->lot.priority > other->lot.priority ? -1 : 1;
    }
    return one->index < other->index ? -1 : 1;
}

static void add_wafers(const wh_flow_tool_t *tool, wh_flow_plan_t *plan, const lot_t *lot, size_t index) {
    for (int32_t slot = lot->first; slot <= lot->last; ++slot) {
        char name[2 * WH_NAME_SIZE];
        const size_t number = plan->wafer_count++;
        if (plan->lots[index].name[0] != '\0') {
            (void)snprintf(name, sizeof name, "%s.%d", plan->lots[index].name, (int)(slot - lot->first + 1));
        } else {
            (void)snprintf(name, sizeof name, "W%zu", number + 1);
        }
        plan->wafers[number] = (wh_flow_wafer_t){
            .name = wh_text_copy(name),
            .lot = (int32_t)index,
            .home = tool->stations[lot->station].first_place + slot - 1,
            .back =
                lot->back == WH_FLOW_NONE ? WH_FLOW_NONE : tool->stations[lot->back].first_place + slot - 1,
            .back_station = WH_FLOW_NONE,
            .recipe = lot->recipes ? lot->recipes[slot - lot->first] : 0};
    }
}

/* Routes are in the order in which lots use them. */
static void take_route(wh_reader_t *reader, const wh_flow_tool_t *tool, wh_flow_plan_t *plan, lot_t lots[],
                       size_t index) {
    for (size_t i = 0; i < index; ++i) {
        if (strcmp(lots[i].route, lots[index].route) == 0) {
            lots[index].lot.route = lots[i].lot.route;
            return;
        }
    }
    lots[index].lot.route = add_route(reader, tool, plan, lots[index].route);
}

static void take_lots(const wh_flow_tool_t *tool, wh_flow_plan_t *plan, const lot_t lots[], size_t count,
                      size_t wafers) {
    plan->lots = wh_array_new(count, sizeof *plan->lots);
    plan->wafers = wh_array_new(wafers, sizeof *plan->wafers);
    for (size_t i = 0; i < count; ++i) {
        plan->lots[i] = lots[i].lot;
        plan->lots[i].name = wh_text_copy(lots[i].name);
        plan->lot_count = i + 1;
    }
    for (size_t i = 0; i < count; ++i) {
        plan->lots[i].first_wafer = plan->wafer_count;
        plan->lots[i].wafer_count = (size_t)lots[i].last - (size_t)lots[i].first + 1;
        add_wafers(tool, plan, &lots[i], i);
    }
}

static int by_name(const void *a, const void *b) {
    const lot_t *const *one = a, *const *other = b;
    const int order = strcmp((*one)->name, (*other)->name);
    return order != 0 ? order : (*one)->index < (*other)->index ? -1 : 1;
}

/* Wafers are found by their names, which begin with that of their lot. */
static void refuse_twins(wh_reader_t *reader, const lot_t lots[], size_t count) {
    const lot_t **named = wh_array_new(count + 1, sizeof(lot_t *));
    const lot_t *twin = NULL;
    for (size_t i = 0; i < count; ++i) {
        named[i] = &lots[i];
    }
    qsort(named, count, sizeof *named, by_name);
    for (size_t i = 1; i < count && !twin; ++i) {
        const bool is_one = named[i]->name[0] != '\0' && strcmp(named[i - 1]->name, named[i]->name) == 0;
        twin = is_one ? named[i] : NULL;
    }
    free(named);
    if (twin) {
        char field[48];
        (void)snprintf(field, sizeof field, "[%zu].name", twin->index + 1);
        wh_reader_refuse(reader, field, twin->name, "a name that no lot before it has");
    }
}

/* A route that no lot takes is read as well, and then dropped. */
static void look_at_unused(wh_reader_t *reader, const wh_flow_tool_t *tool, wh_flow_plan_t *plan,
                           const wh_timed_name_t *routes, size_t route_count) {
    const size_t used = plan->route_count;
    for (size_t i = 0; i < route_count; ++i) {
        bool is_used = false;
        for (size_t k = 0; k < used; ++k) {
            is_used = is_used || strcmp(plan->routes[k].name, routes[i].name) == 0;
        }
        if (!is_used) {
            (void)add_route(reader, tool, plan, routes[i].name);
            wh_flow_route_close(&plan->routes[--plan->route_count]);
        }
    }
}

static void read_lots(wh_reader_t *reader, const wh_flow_tool_t *tool, const wh_layout_t *layout,
                      wh_flow_plan_t *plan) {
    size_t route_count = 0, wafers = 0;
    if (!wh_reader_enter(reader, "routes")) {
        wh_reader_refuse(reader, "routes", NULL, "a table of routes by name");
    }
    const wh_timed_name_t *routes = wh_layout_read_keys(reader, 1000, sizeof *routes, "routes", &route_count);
    wh_reader_leave(reader);
    if (!wh_reader_enter(reader, "lots")) {
        wh_reader_refuse(reader, "lots", NULL, "a list of lots");
    }
    const size_t count = wh_reader_list(reader);
    lot_t *lots = lua_newuserdatauv(reader->L, (count + 1) * sizeof *lots, 0);
    memset(lots, 0, (count + 1) * sizeof *lots);
    lua_insert(reader->L, -2); /* below the table being read */
    for (size_t i = 0; i < count; ++i) {
        (void)wh_reader_enter_item(reader, (lua_Integer)i + 1);
        read_lot(reader, tool, layout, routes, route_count, &lots[i]);
        lots[i].index = i;
        wafers += (size_t)(lots[i].last - lots[i].first + 1);
        wh_reader_leave(reader);
    }
    if (count == 0 || wafers > MOST_WAFERS) {
        wh_reader_fail(reader, NULL, "1 to %d wafers in lots", MOST_WAFERS);
    }
    refuse_twins(reader, lots, count);
    wh_reader_leave(reader);
    lua_insert(reader->L, -2); /* the table on top of the lots */
    for (size_t i = 0; i < count; ++i) {
        take_route(reader, tool, plan, lots, i);
    }
    look_at_unused(reader, tool, plan, routes, route_count);
    qsort(lots, count, sizeof *lots, by_arrival);
    take_lots(tool, plan, lots, count, wafers);
    lua_remove(reader->L, -2);
}

/* -------------------------------------------------------------------------------------------------- whole */

static int by_begin(const void *a, const void *b) {
    const wh_flow_down_t *one = a, *other = b;
    return one->at_us != other->at_us       ? (one->at_us < other->at_us ? -1 : 1)
           : one->station != other->station ? one->station - other->station
                                            : one->robot - other->robot;
}

/* Nothing and math.huge are for ever. */
static int64_t read_length(wh_reader_t *reader) {
    const int type = wh_reader_push(reader, "seconds");
    const bool is_endless =
        type == LUA_TNIL || (type == LUA_TNUMBER && lua_tonumber(reader->L, -1) == (lua_Number)INFINITY);
    lua_pop(reader->L, 1);
    return is_endless ? WH_FLOW_FOR_EVER
                      : wh_layout_us(wh_reader_number(reader, "seconds", NAN, 1e-6, WH_FLOW_LONGEST_S));
}

static void read_downs(wh_reader_t *reader, const wh_flow_tool_t *tool, wh_flow_plan_t *plan) {
    if (!wh_reader_enter(reader, "down")) {
        return;
    }
    const size_t count = wh_reader_list(reader);
    plan->downs = wh_array_new(count + 1, sizeof *plan->downs);
    for (size_t i = 0; i < count; ++i) {
        char name[WH_NAME_SIZE];
        (void)wh_reader_enter_item(reader, (lua_Integer)i + 1);
        if (wh_timed_count_entries(reader, wh_flow_down_fields) != 1) {
            wh_reader_fail(reader, NULL, "{ STATION, at = , seconds = }");
        }
        wh_flow_down_t *down = &plan->downs[plan->down_count];
        (void)wh_timed_read_entry(reader, 1, name);
        down->robot = wh_flow_robot_named(tool, name);
        down->station =
            down->robot == WH_FLOW_NONE ? wh_timed_find_station(reader, tool, "[1]", name) : WH_FLOW_NONE;
        down->at_us = wh_flow_read_us(reader, "at", NAN);
        down->for_us = read_length(reader);
        if (down->robot != WH_FLOW_NONE && down->for_us == WH_FLOW_FOR_EVER) {
            wh_reader_refuse(reader, "seconds", NULL, "a number: %s is held so long", name);
        }
        ++plan->down_count;
        wh_reader_leave(reader);
    }
    qsort(plan->downs, plan->down_count, sizeof *plan->downs, by_begin);
    wh_reader_leave(reader);
}

void wh_flow_read(wh_reader_t *reader, const wh_flow_tool_t *tool, const wh_layout_t *layout,
                  wh_flow_t *flow) {
    static const char *const lates[] = {"fail", "tell", NULL};
    wh_flow_plan_t *plan = &flow->plan;
    wh_reader_refuse_unknown(reader, wh_flow_fields);
    read_lots(reader, tool, layout, plan);
    wh_flow_read_rule(reader, tool, plan);
    read_downs(reader, tool, plan);
    const int on_error = wh_reader_push(reader, "on_error");
    if (on_error != LUA_TNIL && on_error != LUA_TFUNCTION) {
        wh_reader_fail(reader, "on_error", "a function of the tool and a problem");
    }
    lua_pop(reader->L, 1);
    plan->until_us = wh_reader_has(reader, "until_s") ? wh_flow_read_us(reader, "until_s", 0) : WH_FLOW_NEVER;
    plan->takt_us = wh_flow_read_us(reader, "takt", 0);
    plan->is_safe = wh_reader_boolean(reader, "safe", true);
    flow->has_gains = wh_reader_boolean(reader, "gains", false);
    if (flow->has_gains && wh_flow_has_real(tool)) {
        wh_reader_refuse(reader, "gains", NULL, "nothing: a cell with axes would be played again for each");
    }
    if (flow->has_gains && plan->rule == WH_FLOW_OWN) {
        wh_reader_refuse(reader, "gains", NULL,
                         "a rule by name or lists: a function could answer otherwise each time");
    }
    flow->is_lateness_told = wh_reader_choice(reader, "late", 0, lates) == 1;
    char *problem = wh_flow_plan_finish(plan, tool);
    if (problem) {
        lua_pushfstring(reader->L, "%s: %s", reader->file, problem);
        free(problem);
        (void)lua_error(reader->L);
    }
}
