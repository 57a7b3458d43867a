/* Finds what is wrong with a cell before anything moves: the judgement of `waferhand layout`.
 *
 * The robot stands at home; the wafers lie where the layout puts them, and, for room, in every slot. Lengths
 * in mm.
 */
#ifndef WH_SURVEY_FEASIBILITY_H
#define WH_SURVEY_FEASIBILITY_H

#include "../layout/links.h"
#include "../layout/reach.h"

typedef enum {
    WH_FINDING_CONTACT, /* two parts overlap that must not */
    WH_FINDING_SPACE,   /* a slot's wafer does not fit beside other stations, walls, or the robot at home */
    WH_FINDING_REACH,   /* GET, PUT or MAP is refused at a slot: see survey.h */
    WH_FINDING_LINKS,   /* the arm's two links do not reach the wrist there */
    WH_FINDING_WAFER,   /* a wafer lies in no slot */
    WH_FINDING_ENTRY,   /* the blade does not fit between two wafers */
    WH_FINDING_LEDGES,  /* the blade does not fit between the ledges, or beside the chuck */
    WH_FINDING_BLADES,  /* a blade is in another one's way */
    WH_FINDING_RETRACT, /* in front of a station its wafers and the blade, or what it holds, overlap */
    WH_FINDING_TILT,    /* a station, or a wafer, is tilted more than a level blade takes it */
    WH_FINDING_GAP,     /* the room in a station is not more than `clearance` asks for */
    WH_FINDING_RELEASE, /* a PUT lets go only after the wafer has gone into its support */
    WH_FINDING_SIGHT,   /* a beam or an edge sensor cannot see its wafer or notch */
    WH_FINDING_REST,    /* a notch points to where a rest of an edge grip is */
    WH_FINDING_POCKET,  /* a wafer lies so that an edge grip would not hold it, or is of no such size */
    WH_FINDING_PLAY,    /* GET or PUT, played at a slot, fails or hits something: see survey.h */
    WH_FINDING_SIZE,    /* a mesh is smaller than 1 mm, or larger than the cell: a warning */
    WH_FINDING_UNIT     /* a number looks as if it were in another unit: a warning */
} wh_finding_kind_t;

typedef struct {
    wh_finding_kind_t kind;
    bool is_warning; /* the layout works: with nothing to spare, or not with every blade at every station */
    char text[512];
    int32_t parts[2]; /* the two that are in contact; else WH_NONE */
    int32_t station;  /* or WH_NONE */
    int32_t slot;     /* the first one, from 1; 0: of none */
    int32_t other;    /* another station that is in this one's way; else WH_NONE */
} wh_finding_t;

/* The room around the blade that serves a station. Measured between the parts, with wafers of the layout's
 * size in the middle of their slots, tilt included; 0 if they touch or overlap. */
typedef struct {
    size_t wafers; /* how many the layout puts here */
    bool has_above, has_below, has_beside, has_before, has_lifted;
    wh_real_t above;  /* entered for a GET: to the wafer in the slot */
    wh_real_t below;  /* to the wafer one slot lower; unknown for a single slot */
    wh_real_t beside; /* at the slot's height: to its ledges, or to the prealigner's chuck */
    /* at `retract` before the slot, at any height: from blade and held wafer to the station's wafers. It is
     * from the blade alone where no wafer can be held while another one lies there */
    wh_real_t before;
    /* at the end of a GET: from its wafer to the ledges and the wafer one slot higher, at most: checked at
     * slices, a wafer may lie a step of the stroke higher. Unknown for a single slot */
    wh_real_t lifted;
} wh_entry_t;

typedef struct {
    const wh_layout_t *layout;
    bool has_parts;                            /* false: too many parts; only links and wafers were checked */
    wh_links_t links;                          /* at home */
    wh_pose_t base_from_grippers[WH_GRIPPERS]; /* the same */
    wh_entry_t *entries;                       /* by station */
    wh_finding_t *findings;
    size_t count, capacity; /* of findings */
    size_t wrong;           /* those that are no warnings */
} wh_feasibility_t;

/* Checks the whole layout. survey.h adds the findings that a run would refuse. The caller frees the
 * result. Ends the program if out of memory. Cost: n log n in parts, wafers and slots, and wafers times
 * stations. */
void wh_feasibility(wh_feasibility_t *check, const wh_layout_t *layout);

/* Adds a finding: no warning, of this station or of none (WH_NONE), without parts and slot. It is valid until
 * the next one is added. */
wh_finding_t *wh_feasibility_add(wh_feasibility_t *check, wh_finding_kind_t kind, int32_t station,
                                 const char *format, ...) __attribute__((format(printf, 4, 5)));

/* Makes the last finding a warning. */
void wh_feasibility_warn(wh_feasibility_t *check);

void wh_feasibility_free(wh_feasibility_t *check);

/* The kind in one word, such as "contact": a constant. */
const char *wh_finding_name(wh_finding_kind_t kind);

/* The edges of the box around a mesh along the axes of its own frame, mm. Cost: linear in its points. */
wh_vec3_t wh_feasibility_extent(const wh_convex_t *mesh);

/* base_from_part of any part, wafers included, with the robot at home and the wafers where the layout puts
 * them. */
wh_pose_t wh_feasibility_place(const wh_feasibility_t *check, int32_t part);

#endif
