/* Events in words, as the program prints them: what happened to which wafer and gripper, and why.
 *
 *     near miss: wafer 0, gripper 0: |dr_proj_xy| 55.000 is not below 50 (by 5.000 mm)
 *
 * It is for a test's log and for a firmware's: no stdio, no heap, no static data.
 */
#ifndef WH_SIM_EVENT_TEXT_H
#define WH_SIM_EVENT_TEXT_H

#include "../grasp/event.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(event_text);

/* Room for every text of wh_event_text if no name has more than 63 bytes. */
#define WH_EVENT_TEXT_SIZE 640

/* The kinds of things that have names. */
typedef enum WH_FOUR_BYTES {
    WH_NAME_WAFER,
    WH_NAME_GRIPPER,
    WH_NAME_PART /* of the collision world */
} wh_name_kind_t;

/* The names of things. If all is zero, or the pointer is null: "wafer 0", "gripper 0", "part 0", "fault 0",
 * with the index. */
typedef struct {
    /* The name of one thing, or null if it has none; `index` may be WH_NONE. Null: nothing has a name. */
    const char *(*find)(const void *user, wh_name_kind_t kind, int32_t index);
    const void *user;
    int32_t first; /* the number of the first index, 0 or 1 */
    /* The table's tolerance. For a near miss between two slices the text names 0.998 eps_projz, the limit
     * there. Null: limits are computed from the margins. */
    const wh_tolerance_t *tolerance;
    const char *degree; /* null: " deg" */
} wh_event_names_t;

/* Writes the whole text, without a full stop or a line end. Returns its length without the terminator; if
 * that is not below `size`, the text is cut off. `buffer` always ends with a terminator, unless `size` is
 * 0. `event` is not null; the things at its indices need not exist. Cost: a few microseconds. */
size_t wh_event_text(const wh_event_t *event, const wh_event_names_t *names, char *buffer, size_t size)
    WH_SYMBOL(wh_event_text);

/* Writes one reason, by its index from 0: a near miss has one for each condition that failed, other events
 * have at most one. Returns the length like wh_event_text; 0, with an empty text, if there is no such
 * reason. */
size_t wh_event_reason(const wh_event_t *event, const wh_event_names_t *names, size_t index, char *buffer,
                       size_t size) WH_SYMBOL(wh_event_reason);

WH_HEADER_END

#endif
