/* Within motion control: the load ports of a cell, stepped with each slice (flow/load_port.h), and the
 * carriers that come to them.
 *
 * A port's own controller clamps, docks, opens and maps, and speaks the handshake; motion control carries
 * that out, as it does for stations that take time (clocks.h). Carriers bring and take wafers: motion
 * control tells the simulator where these come to lie, with the commands of the next slices
 * (WH_FAULT_WAFER_PLACED). All wafers that ever come are the layout's; one that is away lies far below the
 * cell. */
#ifndef WH_MCS_PORTS_H
#define WH_MCS_PORTS_H

#include "../layout/ports.h"
#include "native.h"

/* A load port. */
typedef struct {
    int32_t station;
    wh_load_port_of_t of; /* as it truly is: a study draws times */
    size_t first;         /* of its slots among `codes` */
} wh_ported_t;

typedef struct {
    wh_load_port_t clock;
    int32_t carrier; /* that is there, comes or goes, or WH_NONE */
    int32_t changes; /* how often it was mapped, or its carrier went */
    bool is_mapped;  /* `codes` are of this carrier */
    bool is_told;    /* the handshake that failed was told by an error */
} wh_load_port_now_t;

typedef struct {
    int32_t port; /* the number of the port where it is, or to which it shall come; WH_NONE: away */
    bool is_due;  /* it shall come at that time, or as soon after as the port is free */
    int64_t comes_us;
} wh_carrier_now_t;

/* A wafer, by the layout's index. */
typedef struct {
    int32_t carrier; /* in which it is away; WH_NONE: it is in the cell */
    int32_t slot;    /* there, from 1 */
    bool stays;      /* it does not come with it next time */
    wh_pose_t slot_from_wafer;
} wh_carried_t;

/* A wafer that is to be placed. */
typedef struct {
    int32_t wafer;
    wh_pose_t base_from_wafer;
} wh_load_port_order_t;

/* All that changes, one block of memory: the arrays follow its head. */
typedef struct {
    size_t order_count; /* those that the simulator has not confirmed */
} wh_ports_state_t;

struct wh_ports {
    wh_mcs_t *mcs;
    size_t count, slot_count;
    wh_ported_t *of;
    int32_t *by_station; /* the number of each of the layout's stations, or WH_NONE */
    wh_ports_state_t *state;
    size_t state_bytes;
    wh_load_port_now_t *ports; /* by number; within the state's block, as the next four */
    wh_carrier_now_t *carriers;
    wh_carried_t *wafers;
    wh_load_port_order_t *orders; /* one for each wafer of the layout at most */
    int8_t *codes;                /* by slot */
};

/* Sets them up in a layout that has any; else null. `now_us` is 0. */
struct wh_ports *wh_ports_begin(lua_State *L, wh_mcs_t *mcs);

/* A slice has taken place, `us` after the last that was heard. */
void wh_ports_hear(struct wh_ports *ports, const wh_state_t *state, double us);

/* Adds orders of wafers to the command that goes out next. */
void wh_ports_send(const struct wh_ports *ports, wh_command_t *command);

/* Adds the order that the wafer comes to lie there to a command, if that and the simulator have room for it:
 * the state shows whether it was carried out. */
void wh_ports_order(const wh_mcs_t *mcs, wh_command_t *command, int32_t wafer,
                    const wh_pose_t *base_from_wafer);

/* The number of us in which nothing ends or comes, without faults; INFINITY: it stays so. */
double wh_ports_quiet_us(const struct wh_ports *ports, int64_t now_us);

/* This number of these us was left out. */
void wh_ports_pass(struct wh_ports *ports, int64_t us, int64_t now_us);

/* The number of a station's port; WH_NONE: it is none. */
int32_t wh_ports_find(const wh_mcs_t *mcs, int32_t station);

/* The port's clock, with the carrier that comes to it: one whose time has come begins with the next slice. */
wh_load_port_t wh_ports_coming(const struct wh_ports *ports, int32_t number, int64_t now_us);

/* True if nothing runs at the port, and no carrier is to come to it while it is free. */
bool wh_ports_is_idle(const struct wh_ports *ports, int32_t number);

/* s until it stands, by the description. */
double wh_ports_rest_us(const struct wh_ports *ports, int32_t number, int64_t now_us);

/* The wafers of a carrier that has come go to their slots; those of one that goes leave the cell. */
void wh_ports_bring_wafers(struct wh_ports *ports, int32_t number);
void wh_ports_take_wafers(struct wh_ports *ports, int32_t number);

/* The wafers as they lie when a run begins: in their carriers, or in the cell. */
void wh_ports_begin_wafers(struct wh_ports *ports);

/* True if two poses are equal to the last bit. */
bool wh_ports_is_same_place(const wh_pose_t *a, const wh_pose_t *b);

/* Keeps the event of a port, tells it, and does what goes with it: a wh_load_port_teller_t. */
typedef struct {
    struct wh_ports *ports;
    int32_t number;
} wh_ports_telling_t;
void wh_ports_tell(void *user, const wh_load_port_event_t *event);

/* At the end of a run: a handshake that failed, and that no error has told. */
void wh_ports_judge(const struct wh_ports *ports);

#endif
