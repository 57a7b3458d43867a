/* The members that a struct of ours and a message share: one row serves both ways. */
#ifndef WH_WIRE_MEMBERS_H
#define WH_WIRE_MEMBERS_H

#include <stddef.h>
#include <stdint.h>

/* How both hold it. A switch and a choice of two are 0 or 1 in the message, and any other number is 1. */
typedef enum {
    WH_MEMBER_NUMBER, /* double, double */
    WH_MEMBER_WHOLE,  /* int32_t or an enumeration, int32_t */
    WH_MEMBER_LONG,   /* int64_t or uint64_t, int64_t */
    WH_MEMBER_SWITCH, /* bool, int8_t */
    WH_MEMBER_CHOICE  /* an enumeration of two, int8_t */
} wh_member_kind_t;

typedef struct {
    wh_member_kind_t kind;
    size_t count;        /* so many of them, one behind the other; 0: ends a list */
    size_t ours, theirs; /* offsets */
} wh_member_t;

/* The members of a cell: of the layout, and of what the message has by list. */
extern const wh_member_t wh_cell_members[];   /* wh_layout_t, waferhand_cell */
extern const wh_member_t wh_sensor_members[]; /* wh_scanner_t, waferhand_edge_sensor */
extern const wh_member_t wh_rim_members[];    /* wh_rim_t, waferhand_rim */
extern const wh_member_t wh_edge_members[];   /* wh_edge_t, waferhand_edge_grip */
extern const wh_member_t wh_light_members[];  /* wh_door_beam_t, waferhand_door_beam: of light */
extern const wh_member_t wh_touch_members[];  /* likewise: of a face that is touched */
extern const wh_member_t wh_door_members[];   /* wh_door_t, waferhand_door */

/* Copies all members to the message, and back. Others stay as they are, and nothing is checked. */
void wh_members_put(const wh_member_t members[], const void *ours, void *theirs);
void wh_members_take(const wh_member_t members[], const void *theirs, void *ours);

#endif
