/* A field log: what a real controller did, as a table of rows over time, read strictly.
 *
 * A row has a time, where each axis is, each valve, and perhaps each sensor. Without a map the columns are
 * those of `waferhand csv`. A map, a Lua file, gives them other names:
 *
 *     return {
 *       separator = ";", decimal = ",",
 *       time = { "t_ms", scale = 1e-3 },
 *       axes = { theta = { "J1", unit = "rad" }, r = { "J2", scale = 0.001 }, z = "J3", yaw = 0 },
 *       valves = { EE = { "vac_out", on = "1" }, PA = false },
 *       sensors = { EE = "vac_in", PA = false },
 *       ignore = { "comment" },
 *     }
 *
 * A column is a name or a table of the name and how it is read. A number in place of an axis's column says
 * where the axis stands. True or false in place of a valve's column says how it is; false in place of a
 * sensor's says that the log has none. Every axis, valve and sensor of the layout must be told, and every
 * column of the file must be known: `ignore` names the others. Host code; it ends the program if out of
 * memory.
 */
#ifndef WH_LOOP_FIELD_H
#define WH_LOOP_FIELD_H

#include "../layout/layout.h"
#include "../script/sandbox.h"
#include "../text/rows.h"

#define WH_FIELD_MESSAGE 1600
#define WH_FIELD_BYTES ((size_t)1 << 30)
/* The longest text that says "on". */
#define WH_FIELD_ON 64

/* Where a number of a row comes from. */
typedef struct {
    bool is_told;         /* the map, or a column of the usual name, tells it */
    bool is_constant;     /* `offset` is the number, in each row */
    bool is_angle_in_rad; /* of an axis */
    size_t column;
    double scale, offset;
    char on[WH_FIELD_ON];  /* of a valve or sensor: the text that says on; empty: any number but 0 */
    char off[WH_FIELD_ON]; /* the text that says off; empty: any other */
    bool has_been_on;
    bool is_turned; /* that text, or number, says off instead */
} wh_field_source_t;

/* Zero it to begin with; it must not be moved once opened. */
typedef struct {
    const wh_layout_t *layout;
    const char *path, *map; /* map: null: the columns of `csv` */
    bool has_commas;        /* a number's point is a comma */
    wh_rows_t rows;
    char *names[WH_ROWS_FIELDS]; /* of the columns */
    size_t column_count, ignored;
    bool is_used[WH_ROWS_FIELDS];
    wh_field_source_t time, axes[WH_AXES], valves[WH_GRIPPERS], sensors[WH_GRIPPERS];
    uint32_t has_sensors; /* bit g: the log has the sensor of gripper g */
    char message[WH_FIELD_MESSAGE];
    /* The last row: */
    size_t line;
    double time_s;
    wh_real_t q[WH_AXES]; /* in the library's units */
    uint32_t on, sensed;  /* valves and sensors, by bits */
} wh_field_log_t;

/* Opens the file by a map, or by none, and reads its first line. False, with the reason in `message`. Close
 * it in any case. `layout`, `path` and `map` must outlive it. */
bool wh_field_open(wh_field_log_t *field, const char *path, const char *map, const wh_layout_t *layout,
                   const wh_sandbox_limits_t *limits);

/* Reads the next row. False at the end, or with a message. Times must grow from row to row. */
bool wh_field_read(wh_field_log_t *field);

/* A valve or sensor whose text for on was in no row read so far, and whose text for off was not named: all
 * its texts may be misread. Null if there is none; `gripper` is whose, `is_sensor` which of both. */
const wh_field_source_t *wh_field_find_never_on(const wh_field_log_t *field, size_t *gripper,
                                                bool *is_sensor);

void wh_field_close(wh_field_log_t *field);

#endif
