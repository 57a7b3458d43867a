/* Conversion between the library's structs and LCM's messages. Nothing here allocates, unless stated. */
#ifndef WH_WIRE_MESSAGES_H
#define WH_WIRE_MESSAGES_H

#include <waferhand_cell.h>
#include <waferhand_centring.h>
#include <waferhand_command.h>
#include <waferhand_edge_scan.h>
#include <waferhand_mcs.h>
#include <waferhand_proximity.h>
#include <waferhand_request.h>
#include <waferhand_state.h>

#include "../layout/layout.h"
#include "../sim/slice.h"

/* The channels; lcm_types/README.md says who sends which. */
#define WH_LINK_OURS "WAFERHAND_"
#define WH_CHANNEL_COMMAND "WAFERHAND_COMMAND"
#define WH_CHANNEL_STATE "WAFERHAND_STATE"
#define WH_CHANNEL_RESTORE "WAFERHAND_RESTORE"
#define WH_CHANNEL_PROXIMITY "WAFERHAND_PROXIMITY"
#define WH_CHANNEL_MCS "WAFERHAND_MCS"
#define WH_CHANNEL_REQUEST "WAFERHAND_REQUEST"
#define WH_CHANNEL_CELL "WAFERHAND_CELL"
#define WH_CHANNEL_EDGE_SCAN "WAFERHAND_EDGE_SCAN"
#define WH_CHANNEL_LATCH "WAFERHAND_LATCH"

/* The most wafers of a layout for two processes, so that a state fits one datagram. */
#define WH_LINK_WAFERS 256
#define WH_LINK_EVENTS WH_SLICE_EVENTS
/* One rim for each wafer, and one for those that have none of their own. */
#define WH_LINK_RIMS (WH_LINK_WAFERS + 1)
/* A command has room for this many, whatever the cell has. */
typedef char wh_link_needs_the_usual_counts[WH_AXES == 32 && WH_GRIPPERS == 16 ? 1 : -1];
/* The most parts of a collision world; the parts of an event must be below it. */
#define WH_LINK_PARTS (1 << 20)
/* LCM sends longer messages in fragments, and single fragments get lost. */
#define WH_LINK_DATAGRAM 65499
/* The most samples of a part of a whole scan. */
#define WH_LINK_SAMPLES 7000
/* The most lines of words about a scan. */
#define WH_LINK_LINES 8

/* No run has this many slices: 285 years of 1 ms. Sums of times stay exact. */
#define WH_LINK_SLICES (INT64_C(1) << 53)

/* The longest text of a request, with its terminator. */
#define WH_LINK_LINE 1001

/* waferhand_cell.collision: the simulator's check. */
/* From this bit on `slice_us` of a cell tells the debounce of vacuum sensors, in slices. */
#define WH_LINK_DEBOUNCE_SHIFT 32

enum { WH_LINK_NO_COLLISION, WH_LINK_CONTACT, WH_LINK_GAPS };

/* waferhand_mcs.phase. */
enum {
    WH_LINK_PHASE_IDLE,
    WH_LINK_PHASE_BEGINS,
    WH_LINK_PHASE_GOES_ON,
    WH_LINK_PHASE_DONE,
    WH_LINK_PHASE_FAILED,
    WH_LINK_PHASE_OVER,
    WH_LINK_PHASE_MET,
    WH_LINK_PHASE_UNMET,
    WH_LINK_PHASE_CYCLE,
    WH_LINK_PHASE_WAITS,
    WH_LINK_PHASE_ON,
    WH_LINK_PHASE_STATION,
    WH_LINK_PHASES
};

/* The sender and its run: the first fields of each message after its times. */
typedef struct {
    int64_t run;
    uint64_t layout_hash;
} wh_link_identity_t;

/* Room for a whole state in the library's structs. */
typedef struct {
    wh_wafer_t wafers[WH_LINK_WAFERS];
    wh_gripper_t grippers[WH_GRIPPERS];
    wh_event_t events[WH_LINK_EVENTS];
    wh_physics_state_t physics;
} wh_link_arrays_t;

/* Room for a whole state as a message; `message` points into the arrays. */
typedef struct {
    waferhand_state message;
    waferhand_wafer_state wafers[WH_LINK_WAFERS];
    waferhand_gripper_state grippers[WH_GRIPPERS];
    waferhand_event events[WH_LINK_EVENTS];
    waferhand_fault_slot faults[WH_FAULTS];
    int32_t samples[WH_SCAN_SLICE];
    double doors[WH_DOORS];
    waferhand_latch waiting[WH_LATCHES], latches[WH_LATCHES];
} wh_link_state_t;

/* Room for a whole cell as a message; `message` points into the arrays, and to the layout's texts. */
typedef struct {
    waferhand_cell message;
    int8_t grips[WH_GRIPPERS];
    char *gripper_names[WH_GRIPPERS], *valve_names[WH_GRIPPERS];
    waferhand_station stations[WH_LAYOUT_STATIONS];
    char *wafer_names[WH_LINK_WAFERS];
    waferhand_wafer_state wafers[WH_LINK_WAFERS];
    waferhand_fault faults[WH_FAULTS];
    waferhand_edge_sensor sensors[WH_GRIPPERS];
    double hidden[WH_GRIPPERS][2][WH_SENSOR_ARCS];
    waferhand_door_beam beams[WH_BEAMS];
    waferhand_outline outlines[WH_GRIPPERS];
    double corners[WH_GRIPPERS][2][WH_OUTLINE_POINTS];
    waferhand_rim rims[WH_LINK_RIMS];
    double chips[WH_LINK_RIMS][3][WH_RIM_CHIPS];
    waferhand_edge_grip edges[WH_GRIPPERS];
    waferhand_door doors[WH_DOORS];
} wh_link_cell_t;

/* LCM's structs hold plain char pointers, though encoding only reads what they point to. */
static inline char *wh_link_borrowed(const char *text) {
    union {
        const char *constant;
        char *plain;
    } cast = {text};
    return cast.plain;
}

/* Poses and faults: the parts that several messages share. Nothing is checked. */
void wh_link_put_pose(const wh_pose_t *pose, double position[3], double rotation[9]);
wh_pose_t wh_link_take_pose(const double position[3], const double rotation[9]);
void wh_link_put_fault(const wh_fault_t *fault, waferhand_fault *out);
wh_fault_t wh_link_take_fault(const waferhand_fault *in);

/* A command as a message, and back. The latter refuses counts out of range (WH_STATUS_OUT_OF_RANGE). The
 * step judges poses, valves and faults. */
void wh_link_command_to_message(const wh_command_t *command, const wh_link_identity_t *identity,
                                bool lockstep, waferhand_command *message);
wh_status_t wh_link_command_from_message(const waferhand_command *message, wh_command_t *command);

/* A state as a message. The caller ensures that the counts are within the room. The condition may be null
 * where there is no gripper. */
void wh_link_state_to_message(const wh_state_t *state, const wh_link_identity_t *identity, uint64_t hash,
                              int64_t missed, wh_link_state_t *message);

/* Converts back: fills `arrays`, and `state` as a view of them. The message's counts are within the arrays;
 * wh_link_decode_state ensures that. It refuses events that no step yields (WH_STATUS_OUT_OF_RANGE).
 * wh_grasp_restore judges wafers and grippers, wh_physics_state_validate the condition. Margins and
 * verdicts of measured values do not travel: they are computed again from `tolerance`, those of a near miss
 * from the limit in its message. */
wh_status_t wh_link_state_from_message(const waferhand_state *message, const wh_tolerance_t *tolerance,
                                       wh_link_arrays_t *arrays, wh_state_t *state);

/* Converts back likewise. It returns true only if the state belongs to this layout, its physics are sound,
 * and it has the hash that it carries. wh_grasp_restore finds out whether a grasp table could be in that
 * state. */
bool wh_link_state_is_sound(const waferhand_state *message, const wh_layout_t *layout,
                            wh_link_arrays_t *arrays, wh_state_t *state);

/* A grasp table with the layout's rules over the wafers and grippers of a sound state. */
wh_grasp_t wh_link_table(const waferhand_state *message, const wh_layout_t *layout, wh_link_arrays_t *arrays);

/* The values of the paper's Fig. 9: each gripper of the state against the wafer that it holds, or else the
 * one nearest to the limits (record/counterpart.h). Wafers that other grippers hold count too. Cost: linear
 * in grippers times wafers. */
void wh_link_proximity_to_message(const wh_state_t *state, const wh_link_identity_t *identity,
                                  const wh_layout_t *layout, waferhand_proximity *message);

/* Returns the big-endian word at `bytes`. If `size` is less than 8, zeros stand for the bytes beyond it. */
uint64_t wh_link_word(const uint8_t *bytes, size_t size);

/* Writes the check over the last eight of `size` bytes, which end a command or a state. A datagram with a
 * flipped bit is then no message. It does nothing to less than eight bytes. Cost: about 2 ns a word.
 *
 * h = 0x6a09e667f3bcc908; for each eight bytes of the encoded message but the last eight, as a big-endian
 * word w, the last of them filled up with zeros: h = (h ^ w) * 0x9e3779b97f4a7c15; h = h ^ (h >> 32). A
 * result of 0 is written as 1, because 0 says that the sender makes no checks. */
void wh_link_seal(uint8_t *bytes, size_t size);

/* Decodes a datagram. It first compares size and fingerprint with its counts. Whatever the datagram
 * contains, nothing beyond it is read, and no memory is allocated for a count that it does not carry. The
 * command needs no heap. States and texts are decoded into memory of their own; release them with
 * waferhand_*_decode_cleanup. */
bool wh_link_decode_command(const void *data, size_t size, waferhand_command *message);
bool wh_link_decode_state(const void *data, size_t size, waferhand_state *message);
bool wh_link_decode_mcs(const void *data, size_t size, waferhand_mcs *message);
bool wh_link_decode_request(const void *data, size_t size, waferhand_request *message);
bool wh_link_decode_cell(const void *data, size_t size, waferhand_cell *message);
bool wh_link_decode_edge_scan(const void *data, size_t size, waferhand_edge_scan *message);
bool wh_link_decode_centring(const void *data, size_t size, waferhand_centring *message);

/* The number of a request that cannot be decoded, if it has a request's fingerprint and is long enough to
 * carry one; otherwise 0. */
int64_t wh_link_request_number(const void *data, size_t size);

/* The cell of a layout as a message. Returns false if it has more than WH_LINK_WAFERS wafers: the room is
 * then all zero. */
bool wh_link_cell_from_layout(const wh_layout_t *layout, const wh_link_identity_t *identity,
                              wh_link_cell_t *room);

/* The layout that a cell message describes; a simulator needs no more, and no file. wh_link_layout_free
 * releases it. The result is null for a message that no layout could have made: poses, tolerances, counts,
 * names and slots are checked. The message has the number of the machine's grippers and nothing else of it.
 * It does not have the stations' parameters of GET and PUT. All these are zero. */
wh_layout_t *wh_link_layout_from_cell(const waferhand_cell *cell);
void wh_link_layout_free(wh_layout_t *layout);

#endif
