/* A robot's own controller: its power, brakes, emergency stop, servos and mode, an axis whose encoder tells a
 * place beyond its soft limit, and the override of its speed.
 *
 * Conditions refuse motion. Commands raise and clear them, and faults raise them. A motion that runs while a
 * condition comes ends where it is, with that error. All zero is a controller that refuses nothing, as in a
 * cell that uses none of this.
 */
#ifndef WH_MCS_CONTROLLER_H
#define WH_MCS_CONTROLLER_H

#include "../layout/layout.h"

struct wh_mcs;

typedef enum { WH_MODE_AUTOMATIC, WH_MODE_MANUAL, WH_MODE_REMOTE } wh_mcs_mode_t;

/* Without gaps: states are compared byte by byte. */
typedef struct {
    int32_t is_off;     /* the power is */
    int32_t is_braked;  /* the brakes are set */
    int32_t is_pressed; /* the emergency stop is, by a command */
    int32_t is_struck;  /* it is, by a fault that lasts */
    int32_t has_failed; /* a servo has */
    int32_t mode;       /* wh_mcs_mode_t */
    int32_t exceeded;   /* the robot's axis of the machine, from 1; 0: none */
    int32_t unused;
    double at;       /* what that axis's encoder tells, rad or mm */
    double override; /* the part of all speeds, above 0; 0: all of them */
} wh_mcs_controller_t;

/* A change as it was said, such as "power" and "off". */
typedef struct {
    const char *name, *value;
} wh_mcs_change_t;

/* The most changes at once, and room for the reason why one was refused. */
#define WH_MCS_CHANGES 8
#define WH_MCS_CHANGE_BYTES 400

/* Takes all changes, or none: then `reason` says why. A motion that the robot may no longer make ends after
 * the present slice. Values by name: power on, off; brakes released, set; estop off, on; servo ok, error;
 * mode automatic, manual, remote; exceeded an axis or none, with at, its place in degrees or mm, beyond its
 * soft limit; override 0.001 to 1. The power goes off with the emergency stop, and comes on only without
 * it. */
wh_status_t wh_mcs_change_controller(struct wh_mcs *mcs, size_t robot, const wh_mcs_change_t changes[],
                                     size_t count, char reason[WH_MCS_CHANGE_BYTES]);

/* A controller as it is now. */
const wh_mcs_controller_t *wh_mcs_controller(const struct wh_mcs *mcs, size_t robot);

/* Why the robot may not move; WH_OK: it may. `homes`: an axis beyond its soft limit does not hinder. */
wh_status_t wh_mcs_refusal(const struct wh_mcs *mcs, size_t robot, bool homes,
                           char reason[WH_MCS_CHANGE_BYTES]);

/* Takes the faults that act in this slice. */
void wh_mcs_look_at_controllers(struct wh_mcs *mcs, int64_t slice);

/* The values of a controller by name, as a change says them; the override is a number. An axis is told only
 * where one is exceeded. For each of them `tell` is called; `usual` is true for what a controller has that
 * refuses nothing. */
typedef void wh_mcs_tell_value_t(void *user, const char *name, const char *value, bool usual);
void wh_mcs_tell_controller(const struct wh_mcs *mcs, size_t robot, wh_mcs_tell_value_t *tell, void *user);

/* Where STATUS tells that a robot's axis stands, by its encoder, if it stands at `at`. */
wh_real_t wh_mcs_encoder(const struct wh_mcs *mcs, size_t axis, wh_real_t at);

#endif
