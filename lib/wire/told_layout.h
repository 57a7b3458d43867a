/* The cell of a log for a report: with shapes, which the messages do not have.
 *
 * The messages have the layout's path and hash, and those of its collision check. If that file exists and
 * has these hashes, it is the layout. Otherwise a layout is made from the message, with the default
 * shapes of 300 mm wafers; the arm's axes are then not known.
 */
#ifndef WH_WIRE_TOLD_LAYOUT_H
#define WH_WIRE_TOLD_LAYOUT_H

#include "../script/sandbox.h"
#include "messages.h"

/* Zero it at first. Read only. */
typedef struct {
    const wh_layout_t *layout; /* null: no cell has come yet */
    bool is_whole;             /* it is the file's */
    uint64_t hash;
    int8_t collision; /* the collision check of the log's simulator (waferhand_cell) */
    uint64_t world_hash;
    char note[700];        /* the reason why it is not, or empty */
    wh_sandbox_t *sandbox; /* of the file's */
    wh_layout_t *told;     /* the message's; and its missing parts: */
    wh_part_t *parts;
    char (*names)[WH_PART_NAME_SIZE];
} wh_told_layout_t;

/* The place of the file, and its parameters. */
typedef struct {
    const char *path; /* null: the path in the message */
    const char *const *parameters;
    size_t parameter_count;
} wh_told_layout_options_t;

/* Makes the layout from a message. False if no layout could have made that message; nothing is then changed.
 * If the options name a file and it is not the layout, is_whole is false: the caller named a wrong file. */
bool wh_told_layout_make(wh_told_layout_t *made, const waferhand_cell *cell,
                         const wh_told_layout_options_t *options);

/* The reason why no event of this kind can be in the log, from its recorded cell: the missing check, and what
 * the layout would need. Null: it may be there. */
const char *wh_told_layout_lacks(const wh_told_layout_t *made, wh_event_kind_t kind);

void wh_told_layout_free(wh_told_layout_t *made);

#endif
