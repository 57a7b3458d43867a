/* The parts of a layout about vacuum and holding. */
#include <string.h>

#include "layout_internal.h"

static const char *const models[] = {"ideal", "delayed", NULL};

static wh_vacuum_config_t model_of(int choice) {
    return choice == 0 ? wh_vacuum_ideal() : wh_vacuum_delayed();
}

/* Each threshold within the next one's: what is said is what the layout has, not what became of it. */
static void read_levels(wh_reader_t *reader, wh_vacuum_config_t *vacuum) {
    vacuum->on = wh_reader_number(reader, "sensor_on", vacuum->on, 0.01, 1);
    const wh_real_t off = vacuum->off < vacuum->on ? vacuum->off : vacuum->on;
    vacuum->off = wh_reader_number(reader, "sensor_off", off, 0.01, vacuum->on);
    const wh_real_t idle = vacuum->idle < vacuum->off ? vacuum->idle : 0;
    vacuum->idle = wh_reader_number(reader, "idle", idle, 0, vacuum->off - WH_REAL(1e-3));
    vacuum->release = wh_reader_number(reader, "release", vacuum->release, 0.01, 1);
}

static void read_vacuum_table(wh_reader_t *reader, wh_vacuum_config_t *vacuum) {
    wh_reader_enter(reader, "vacuum");
    wh_reader_refuse_unknown(reader, "model build vent idle sensor_on sensor_off release");
    *vacuum = model_of(wh_reader_choice(reader, "model", 1, models));
    vacuum->build = wh_reader_number(reader, "build", vacuum->build, 0, 3600);
    vacuum->vent = wh_reader_number(reader, "vent", vacuum->vent, 0, 3600);
    read_levels(reader, vacuum);
    wh_reader_leave(reader);
}

static void read_vacuum(wh_reader_t *reader, wh_vacuum_config_t *vacuum) {
    lua_pushliteral(reader->L, "vacuum");
    lua_rawget(reader->L, -2);
    const int type = lua_type(reader->L, -1);
    if (type != LUA_TTABLE && type != LUA_TNIL && type != LUA_TSTRING) {
        wh_reader_fail(reader, "vacuum", "\"ideal\", \"delayed\" or { model = , build = , vent = , ... }");
    }
    lua_pop(reader->L, 1);
    if (type == LUA_TTABLE) {
        read_vacuum_table(reader, vacuum);
    } else {
        *vacuum = model_of(wh_reader_choice(reader, "vacuum", 0, models));
    }
}

static void read_pads(wh_reader_t *reader, const wh_layout_t *layout, wh_pads_t *pads) {
    const wh_real_t mass = wh_wafer_mass(layout->wafer_diameter, layout->wafer_thickness);
    if (!wh_reader_enter(reader, "pads")) {
        return;
    }
    wh_reader_refuse_unknown(reader, "friction force mass gravity");
    pads->friction = wh_reader_number(reader, "friction", WH_REAL(NAN), 0, 100);
    pads->force = wh_reader_number(reader, "force", WH_REAL(NAN), 0, 1e6);
    pads->mass = wh_reader_number(reader, "mass", mass, 1e-6, 1000);
    pads->gravity = wh_reader_number(reader, "gravity", 9.81, 0, 1000);
    wh_reader_leave(reader);
}

void wh_layout_read_physics(wh_reader_t *reader, wh_layout_t *layout) {
    layout->physics = wh_physics_default();
    layout->physics.slice_s = (wh_real_t)layout->slice_us / 1e6;
    read_vacuum(reader, &layout->physics.vacuum);
    read_pads(reader, layout, &layout->physics.pads);
}
