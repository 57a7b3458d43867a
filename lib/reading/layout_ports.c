/* Load ports, and the carriers that come to them with their wafers. */
#include "../layout/ports.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../layout/grips.h"
#include "../layout/words.h"
#include "layout_internal.h"
#include "layout_tool.h"

/* -------------------------------------------------------------------------------------------------- ports */

static int64_t read_us(wh_reader_t *reader, const char *field, double fallback) {
    return (int64_t)llround(wh_reader_apart_from(reader, field, fallback) * 1e6);
}

static double seconds_of(const wh_load_port_of_t *of, wh_load_port_step_t step) {
    return (double)of->us[step] / 1e6;
}

/* A step that takes longer than its timer would never end. */
static void read_handshake(wh_reader_t *reader, wh_load_port_of_t *of) {
    static const char *const timers[] = {"tp1", "tp2", "tp3", "tp4", "tp5"};
    static const char *const steps[] = {"t1", "t2", "t3", "t4", "t5"};
    of->is_e84 = wh_reader_open(reader, "e84", wh_layout_e84_fields);
    for (int i = 0; of->is_e84 && i < WH_LOAD_PORT_TIMERS; ++i) {
        of->limit_us[i + 1] = read_us(reader, timers[i], wh_reader_row(reader, timers[i])->usual);
        of->us[i + 1] = read_us(reader, steps[i], wh_reader_row(reader, steps[i])->usual);
        if (of->us[i + 1] > of->limit_us[i + 1]) {
            lua_pushnumber(reader->L, (double)of->us[i + 1] / 1e6);
            wh_reader_fail(reader, steps[i], "at most %.10g s, its timer %s",
                           (double)of->limit_us[i + 1] / 1e6, timers[i]);
        }
    }
    if (of->is_e84) {
        wh_reader_leave(reader);
    }
}

static void read_steps(wh_reader_t *reader, wh_load_port_of_t *of) {
    static const struct {
        const char *field;
        wh_load_port_step_t step, as; /* without the field it takes as long as that one */
    } fields[] = {{"place", WH_LOAD_PORT_PLACE, WH_LOAD_PORT_STANDS},
                  {"remove", WH_LOAD_PORT_REMOVE, WH_LOAD_PORT_STANDS},
                  {"clamp", WH_LOAD_PORT_CLAMP, WH_LOAD_PORT_STANDS},
                  {"dock", WH_LOAD_PORT_DOCK, WH_LOAD_PORT_STANDS},
                  {"open", WH_LOAD_PORT_OPENS, WH_LOAD_PORT_STANDS},
                  {"map", WH_LOAD_PORT_MAP, WH_LOAD_PORT_STANDS},
                  {"close", WH_LOAD_PORT_CLOSE, WH_LOAD_PORT_OPENS},
                  {"undock", WH_LOAD_PORT_UNDOCK, WH_LOAD_PORT_DOCK},
                  {"unclamp", WH_LOAD_PORT_UNCLAMP, WH_LOAD_PORT_CLAMP}};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        const double usual = fields[i].as == WH_LOAD_PORT_STANDS
                                 ? wh_reader_row(reader, fields[i].field)->usual
                                 : seconds_of(of, fields[i].as);
        of->us[fields[i].step] = read_us(reader, fields[i].field, usual);
    }
}

/* The mapper of a load port judges like MAP, but for the limits that it has of its own. */
static void read_mapper(wh_reader_t *reader, const wh_layout_t *layout, wh_mapping_t *mapping) {
    *mapping = layout->mapping;
    if (wh_reader_open(reader, "mapper", wh_layout_mapper_fields)) {
        mapping->crossed = wh_reader_apart_from(reader, "crossed", mapping->crossed);
        mapping->level = wh_reader_apart_from(reader, "level", mapping->level);
        mapping->protruded = wh_reader_apart_from(reader, "protruded", mapping->protruded);
        mapping->thinnest = wh_reader_apart_from(reader, "thinnest", mapping->thinnest);
        mapping->thickest = wh_reader_apart_from(reader, "thickest", mapping->thickest);
        wh_reader_leave(reader);
    }
}

static void refuse_others(wh_reader_t *reader) {
    static const char *const fields[] = {"process", "window", "clean", "pump", "state", "side"};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        wh_layout_refuse_field(reader, fields[i], "nothing: the station is a load port");
    }
}

void wh_layout_read_port_steps(wh_reader_t *reader, wh_load_port_of_t *of) {
    read_steps(reader, of);
    read_handshake(reader, of);
    of->begins = (wh_load_port_state_t)wh_reader_choice(reader, "state", WH_NONE, wh_load_port_state_names);
}

static wh_layout_port_t *read_port(wh_reader_t *reader, const wh_layout_t *layout) {
    wh_layout_port_t *port = wh_layout_memory(reader->L, 1, sizeof *port);
    refuse_others(reader);
    wh_reader_open_section(reader, "port", wh_layout_port_fields);
    wh_layout_read_port_steps(reader, &port->of);
    port->of.goes_to = (wh_load_port_state_t)(wh_reader_choice(reader, "goes", WH_LOAD_PORT_MAPPED - 1,
                                                               wh_load_port_state_names + 1) +
                                              1);
    read_mapper(reader, layout, &port->mapping);
    wh_reader_leave(reader);
    return port;
}

static size_t read_ports(wh_reader_t *reader, wh_layout_t *layout) {
    size_t count = 0;
    wh_reader_enter(reader, "stations");
    for (size_t s = 0; s < layout->station_count; ++s) {
        (void)wh_reader_open(reader, layout->stations[s].name, wh_layout_station_fields);
        if ((int)wh_reader_apart(reader, "kind") == WH_LAYOUT_LOAD_PORT) {
            layout->stations[s].port = read_port(reader, layout);
            ++count;
        } else {
            wh_layout_refuse_field(reader, "port", "nothing: its `kind` is not \"load_port\"");
        }
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
    return count;
}

/* ----------------------------------------------------------------------------------------------- carriers */

static int32_t most_slots(const wh_layout_t *layout, int32_t at) {
    int32_t most = 0;
    for (size_t s = 0; s < layout->station_count; ++s) {
        const bool counts = layout->stations[s].port && (at == WH_NONE || at == (int32_t)s);
        most = counts && layout->places[s].slots > most ? layout->places[s].slots : most;
    }
    return most;
}

/* A slot in the list of `wafers`, on top of the stack. */
static void check_slot(wh_reader_t *reader, const bool *is_taken, int32_t most) {
    lua_State *L = reader->L;
    const lua_Integer slot = lua_isinteger(L, -1) ? lua_tointeger(L, -1) : 0;
    if (slot < 1 || slot > most || is_taken[slot - 1]) {
        wh_reader_fail(reader, "wafers", "slots from 1 to %d, each once", (int)most);
    }
}

/* `wafers`: how many, from slot 1 on, or a list of slots. Returns their number. */
static int32_t read_slots(wh_reader_t *reader, int32_t most, bool *is_taken) {
    lua_State *L = reader->L;
    const int type = wh_reader_push(reader, "wafers");
    int32_t count = 0;
    if (type == LUA_TTABLE) {
        const lua_Integer items = (lua_Integer)lua_rawlen(L, -1);
        for (lua_Integer i = 1; i <= items; ++i) {
            (void)lua_rawgeti(L, -1, i);
            check_slot(reader, is_taken, most);
            is_taken[lua_tointeger(L, -1) - 1] = true;
            lua_pop(L, 1);
        }
        lua_pop(L, 1);
        return (int32_t)items;
    }
    if (type != LUA_TNIL && !lua_isinteger(L, -1)) {
        wh_reader_fail(reader, "wafers", "a whole number from 0 to %d, or a list of slots", (int)most);
    }
    lua_pop(L, 1);
    count = wh_reader_whole(reader, "wafers", 0, 0, most);
    for (int32_t i = 0; i < count; ++i) {
        is_taken[i] = true;
    }
    return count;
}

static int32_t read_at(wh_reader_t *reader, const wh_layout_t *layout) {
    static const char expected[] = "the name of a station of kind \"load_port\"";
    if (!wh_reader_has(reader, "at")) {
        return WH_NONE;
    }
    const int32_t at = wh_layout_read_name(reader, layout, "at", NULL, wh_layout_find_station, expected);
    if (!layout->stations[at].port) {
        wh_reader_refuse(reader, "at", layout->stations[at].name, "%s", expected);
    }
    if (layout->stations[at].port->of.begins == WH_LOAD_PORT_ABSENT) {
        wh_reader_refuse(reader, "at", layout->stations[at].name,
                         "a load port whose `port.state` is not \"absent\"");
    }
    for (size_t c = 0; c < layout->carrier_count; ++c) {
        if (layout->carriers[c].at == at) {
            wh_reader_refuse(reader, "at", layout->stations[at].name, "a load port of its own: %s is there",
                             layout->carriers[c].name);
        }
    }
    return at;
}

static void read_carrier(wh_reader_t *reader, wh_layout_t *layout, const char *name) {
    wh_layout_carrier_t *carrier = &layout->carriers[layout->carrier_count];
    bool *has = wh_layout_memory(reader->L, WH_LAYOUT_SLOTS, sizeof *has);
    snprintf(carrier->name, sizeof carrier->name, "%s", name);
    carrier->at = read_at(reader, layout);
    carrier->count = read_slots(reader, most_slots(layout, carrier->at), has);
    carrier->has = has;
    carrier->recipe = wh_layout_read_recipe(reader, layout->recipes);
    ++layout->carrier_count;
}

/* Room for those of `carriers`, and for one more at each port. */
size_t wh_layout_read_ports(wh_reader_t *reader, wh_layout_t *layout) {
    const size_t ports = read_ports(reader, layout);
    const wh_layout_carrier_t *named = NULL;
    size_t wafers = 0, count = 0;
    if (wh_reader_enter(reader, "carriers")) {
        if (ports == 0) {
            wh_reader_fail(reader, NULL, "nothing: no station has `kind` \"load_port\"");
        }
        named = wh_layout_read_keys(reader, WH_LAYOUT_CARRIERS, sizeof *named, "carriers", &count);
    }
    layout->carriers = wh_layout_memory(reader->L, count + ports, sizeof *layout->carriers);
    for (size_t c = 0; c < count; ++c) {
        (void)wh_reader_open(reader, named[c].name, wh_layout_carrier_fields);
        read_carrier(reader, layout, named[c].name);
        wafers += (size_t)layout->carriers[c].count;
        wh_reader_leave(reader);
    }
    if (named) {
        wh_reader_leave(reader);
    }
    return wafers;
}

/* ------------------------------------------------------------------------------------------------- wafers */

/* The place of a wafer's layout until its carrier comes: the first load port. */
static int32_t home_of(const wh_layout_t *layout, const wh_layout_carrier_t *carrier) {
    int32_t home = carrier->at;
    for (size_t s = 0; home == WH_NONE && s < layout->station_count; ++s) {
        home = layout->stations[s].port ? (int32_t)s : WH_NONE;
    }
    return home;
}

static void add_wafer(wh_reader_t *reader, wh_layout_t *layout, size_t c, int32_t slot) {
    const wh_layout_carrier_t *carrier = &layout->carriers[c];
    const size_t w = layout->wafer_count++;
    wh_layout_wafer_t *wafer = &layout->wafers[w];
    const int length = snprintf(wafer->name, sizeof wafer->name, "%s.%d", carrier->name, (int)slot);
    if (length >= (int)sizeof wafer->name) {
        wh_reader_refuse(reader, "carriers", carrier->name, "names of at most %d bytes", WH_NAME_SIZE - 6);
    }
    wafer->station = home_of(layout, carrier);
    wafer->slot = slot;
    wafer->thickness = layout->wafer_thickness;
    wafer->carrier = (int32_t)c + 1;
    wafer->recipe = carrier->recipe;
    layout->start[w].base_from_wafer =
        carrier->at == WH_NONE ? wh_layout_outside(w) : wh_layout_lying(layout, carrier->at, slot);
}

void wh_layout_add_carried(wh_reader_t *reader, wh_layout_t *layout) {
    for (size_t c = 0; c < layout->carrier_count; ++c) {
        wh_layout_carrier_t *carrier = &layout->carriers[c];
        carrier->first = (int32_t)layout->wafer_count;
        for (int32_t slot = 1; slot <= WH_LAYOUT_SLOTS; ++slot) {
            if (carrier->has[slot - 1]) {
                add_wafer(reader, layout, c, slot);
            }
        }
    }
}

static bool has_carrier(const wh_layout_t *layout, size_t s) {
    bool has = false;
    for (size_t c = 0; c < layout->carrier_count; ++c) {
        has = has || layout->carriers[c].at == (int32_t)s;
    }
    return has;
}

static const wh_layout_wafer_t *find_wafer_in(const wh_layout_t *layout, size_t s) {
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        const wh_layout_wafer_t *wafer = &layout->wafers[w];
        if (wafer->station == (int32_t)s && !wh_layout_is_outside(&layout->start[w].base_from_wafer)) {
            return wafer;
        }
    }
    return NULL;
}

/* A carrier that the layout does not name is called like its load port. */
static void begin_port(wh_reader_t *reader, wh_layout_t *layout, size_t s) {
    wh_layout_station_t *station = &layout->stations[s];
    const wh_layout_wafer_t *wafer = find_wafer_in(layout, s);
    const bool is_said = (int)station->port->of.begins != WH_NONE;
    if (!is_said) {
        station->port->of.begins = wafer || has_carrier(layout, s) ? WH_LOAD_PORT_OPEN : WH_LOAD_PORT_ABSENT;
    }
    if (station->port->of.begins == WH_LOAD_PORT_ABSENT && wafer) {
        wh_reader_enter(reader, "stations");
        wh_reader_enter(reader, station->name);
        wh_reader_enter(reader, "port");
        wh_reader_refuse(reader, "state", wh_load_port_state_name(WH_LOAD_PORT_ABSENT),
                         "a state with a carrier: %s lies there", wafer->name);
    }
    if (station->port->of.begins != WH_LOAD_PORT_ABSENT && !has_carrier(layout, s)) {
        wh_layout_carrier_t *carrier = &layout->carriers[layout->carrier_count];
        if (wh_layout_find_carrier(layout, station->name) != WH_NONE) {
            wh_reader_enter(reader, "carriers");
            wh_reader_refuse(
                reader, station->name, NULL,
                "`at`, or another name: the carrier that stands at %s when a run begins is called "
                "like it",
                station->name);
        }
        snprintf(carrier->name, sizeof carrier->name, "%s", station->name);
        carrier->at = (int32_t)s;
        ++layout->carrier_count;
    }
}

void wh_layout_begin_ports(wh_reader_t *reader, wh_layout_t *layout) {
    for (size_t s = 0; s < layout->station_count; ++s) {
        if (layout->stations[s].port) {
            begin_port(reader, layout, s);
        }
    }
}
