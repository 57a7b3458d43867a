#include "event_text.h"

#include "../math/trig.h"
#include "faults.h"
#include "names_internal.h"

/* The significant digits of a limit: no more than its number type keeps. */
#if defined(WH_FLOAT)
#define LIMIT_DIGITS 6
#else
#define LIMIT_DIGITS 10
#endif
#define SHORT_DIGITS 6

/* The text of an event while it is written. */
typedef struct {
    wh_words_t words;
    const wh_event_t *event;
    const wh_event_names_t *names;
} said_t;

static void put_text(said_t *said, const char *text) {
    wh_words_put(&said->words, text);
}

static void put_fixed(said_t *said, wh_real_t value, int decimals) {
    wh_words_fixed(&said->words, value, decimals);
}

/* Writes a value, the words between, and its limit. However close they are, their texts differ. */
static void put_against(said_t *said, wh_real_t value, const char *between, wh_real_t limit,
                        const char *unit) {
    const int decimals = wh_words_apart(value, limit, 3);
    put_fixed(said, value, decimals);
    put_text(said, unit);
    put_text(said, between);
    put_text(said, " (limit ");
    wh_words_short(&said->words, limit, SHORT_DIGITS, decimals);
    put_text(said, unit);
    put_text(said, ")");
}

/* Does this for large numbers: no decimals where none are needed. */
static void put_whole_against(said_t *said, wh_real_t value, const char *between, wh_real_t limit) {
    const int decimals = wh_words_apart(value, limit, 0);
    put_fixed(said, value, decimals);
    put_text(said, between);
    put_fixed(said, limit, decimals);
}

static const char *degree_of(const said_t *said) {
    return said->names->degree ? said->names->degree : " deg";
}

static void put_name(said_t *said, wh_name_kind_t kind, int32_t index) {
    wh_names_put(said->names, &said->words, kind, index);
}

static void put_parts(said_t *said, const char *before, const char *after) {
    put_text(said, before);
    put_name(said, WH_NAME_PART, said->event->parts[0]);
    put_text(said, " and ");
    put_name(said, WH_NAME_PART, said->event->parts[1]);
    put_text(said, after);
}

/* -------------------------------------------------------------------------------------------- near misses */

/* A condition of the check, and its text. */
typedef struct {
    const char *name, *relation, *unit;
    int decimals;
    wh_real_t value, limit, margin;
} condition_t;

/* Between two slices the window is smaller; the margin, which comes from the same operations, shows
 * that. */
static wh_real_t projz_limit(const wh_proximity_t *p, const wh_tolerance_t *limits) {
    const wh_real_t height = wh_real_abs(p->dr_proj_z);
    if (!limits) {
        return height + p->margin_projz;
    }
    const wh_real_t inside = WH_SWEEP_INSIDE * limits->projz;
    const bool is_inside = p->margin_projz == inside - height && p->margin_projz != limits->projz - height;
    return is_inside ? inside : limits->projz;
}

static condition_t find_condition(const said_t *said, unsigned failed) {
    const wh_proximity_t *p = &said->event->measured;
    const wh_tolerance_t *limits = said->names->tolerance;
    const wh_real_t height = wh_real_abs(p->dr_proj_z);
    if (failed == WH_FAILED_PROJZ) {
        const condition_t projz = {"|dr_proj_z| ",         "below ",       " mm", 3, height,
                                   projz_limit(p, limits), p->margin_projz};
        return projz;
    }
    if (failed == WH_FAILED_PROJXY) {
        const condition_t projxy = {"|dr_proj_xy| ",
                                    "below ",
                                    " mm",
                                    3,
                                    p->dr_proj_xy_norm,
                                    limits ? limits->projxy : p->dr_proj_xy_norm + p->margin_projxy,
                                    p->margin_projxy};
        return projxy;
    }
    const condition_t planar = {"n1_proj_n2 ",
                                "above ",
                                "",
                                6,
                                p->n1_proj_n2,
                                limits ? limits->planar : p->n1_proj_n2 - p->margin_planar,
                                p->margin_planar};
    return planar;
}

/* The fewest decimals, at least `least`, with which the difference is not zero. */
static int decimals_for(wh_real_t difference, int least) {
    int decimals = least;
    wh_real_t unit = WH_REAL(1);
    for (int i = 0; i < least; ++i) {
        unit /= WH_REAL(10);
    }
    while (difference > 0 && difference < unit && decimals < 15) {
        unit /= WH_REAL(10);
        ++decimals;
    }
    return decimals;
}

static void put_condition(said_t *said, unsigned failed) {
    const condition_t condition = find_condition(said, failed);
    const int decimals = decimals_for(-condition.margin, condition.decimals);
    put_text(said, condition.name);
    put_fixed(said, condition.value, decimals);
    put_text(said, " is not ");
    put_text(said, condition.relation);
    wh_words_short(&said->words, condition.limit, said->names->tolerance ? LIMIT_DIGITS : SHORT_DIGITS,
                   decimals);
    if (condition.margin < 0) {
        put_text(said, " (by ");
        put_fixed(said, -condition.margin, decimals);
        put_text(said, condition.unit);
        put_text(said, ")");
    } else {
        put_text(said, " (it is equal)");
    }
    if (failed == WH_FAILED_PLANAR) {
        put_text(said, ": tilted by ");
        put_fixed(said, wh_deg_from_rad(wh_acos(condition.value)), 3);
        put_text(said, degree_of(said));
    }
}

/* Writes the failed condition number `index`. */
static void say_failed(said_t *said, size_t index) {
    unsigned rest = said->event->measured.failed & (WH_FAILED_PROJZ | WH_FAILED_PROJXY | WH_FAILED_PLANAR);
    if (rest == 0 && index == 0) {
        put_text(said, "ready, but not taken");
    }
    for (; index > 0 && rest != 0; --index) {
        rest &= rest - 1;
    }
    if (rest != 0) {
        put_condition(said, rest & (0U - rest));
    }
}

/* ------------------------------------------------------------------------------------------ other reasons */

/* Writes about vacuum, holding, and injected faults. */
static void say_of_physics(said_t *said) {
    const wh_event_t *event = said->event;
    switch ((int)event->kind) {
    case WH_EVENT_SLIPPED:
        put_text(said, "the motion asks for ");
        put_whole_against(said, event->value, " mm/s^2, the pads carry ", event->limit);
        break;
    case WH_EVENT_VACUUM_LOST:
        put_whole_against(said, 100 * event->value, " % of the full vacuum, the sensor wants ",
                          100 * event->limit);
        break;
    case WH_EVENT_FAULT_ARMED:
    case WH_EVENT_FAULT_CLEARED:
        put_text(said, wh_fault_name((wh_fault_kind_t)event->parts[1]));
        put_text(said, ", fault ");
        wh_words_integer(&said->words, (int64_t)event->parts[0] + said->names->first);
        break;
    default:
        break;
    }
}

static void say_place(said_t *said) {
    const wh_vec3_t *at = &said->event->at;
    put_fixed(said, at->x, 3);
    put_text(said, ", ");
    put_fixed(said, at->y, 3);
    put_text(said, ", ");
    put_fixed(said, at->z, 3);
    put_text(said, " mm");
}

/* Parts without a gap touch. */
static void say_gap(said_t *said) {
    if (said->event->kind == WH_EVENT_TOO_CLOSE && said->event->value > 0) {
        put_parts(said, "", ": ");
        put_against(said, said->event->value, " apart", said->event->limit, " mm");
    } else {
        put_parts(said, "", " touch at ");
        say_place(said);
    }
}

/* Writes about a part that has too many near parts to check all of them. */
static void say_crowd(said_t *said) {
    put_name(said, WH_NAME_PART, said->event->parts[0]);
    put_text(said, " is near to ");
    if (said->event->limit > 0) {
        put_fixed(said, said->event->value, 0);
        put_text(said, " parts and wafers at once, of which ");
        put_fixed(said, said->event->limit, 0);
        put_text(said, " can be looked at");
    } else {
        put_text(said, "more parts and wafers than can be looked at");
    }
    put_text(said,
             ": whether it touches one is not known (keep it farther away, or give it a smaller shape)");
}

static void say_of_contact(said_t *said) {
    switch ((int)said->event->kind) {
    case WH_EVENT_TOO_CLOSE:
    case WH_EVENT_HIT:
        say_gap(said);
        break;
    case WH_EVENT_UNDECIDED:
        if (said->event->parts[1] == WH_NONE) {
            say_crowd(said);
        } else {
            put_parts(said, "whether ", " touch could not be decided");
        }
        break;
    default:
        say_of_physics(said);
        break;
    }
}

static void say_pushed(said_t *said) {
    const wh_event_t *event = said->event;
    if (event->other != WH_NONE) {
        put_text(said, event->wafer == WH_NONE ? "its blade goes through " : "it goes through ");
        put_name(said, WH_NAME_WAFER, event->other);
    } else if (event->value > event->limit) {
        put_text(said, "down through its slot, ");
        put_against(said, event->value, " below the plane", event->limit, " mm");
    } else {
        put_text(said, "up through a slot, its face now at ");
        put_fixed(said, -event->value, 3);
        put_text(said, " mm over the plane");
    }
}

/* Writes how a wafer was set down. */
static void say_of_cell(said_t *said) {
    const wh_event_t *event = said->event;
    switch ((int)event->kind) {
    case WH_EVENT_RELEASED_UNSUPPORTED:
        if (event->limit > 0) {
            put_text(said, "in the air, ");
            put_against(said, event->height, " above its slot", event->limit, " mm");
            break;
        }
        put_text(said, "in no slot, ");
        if (event->value > 0) {
            put_text(said, "tilted by ");
            put_fixed(said, wh_deg_from_rad(event->value), 3);
            put_text(said, degree_of(said));
            put_text(said, ", ");
        }
        put_fixed(said, event->height, 3);
        put_text(said, " mm above the nearest slot below or the floor");
        break;
    case WH_EVENT_SLOT_OCCUPIED:
        put_name(said, WH_NAME_WAFER, event->other);
        put_text(said, " lies in that slot");
        break;
    case WH_EVENT_PLACED_OFF_CENTRE:
        put_against(said, event->value, " beside the centre", event->limit, " mm");
        break;
    case WH_EVENT_PLACED_ASKEW:
        put_text(said, "tilted by ");
        put_against(said, wh_deg_from_rad(event->value), "", wh_deg_from_rad(event->limit), degree_of(said));
        break;
    case WH_EVENT_SETTLED:
        put_fixed(said, event->value, 3);
        put_text(said, " mm lower");
        break;
    case WH_EVENT_PUSHED_THROUGH:
        say_pushed(said);
        break;
    default:
        say_of_contact(said);
        break;
    }
}

static void say_measured(said_t *said) {
    const wh_proximity_t *p = &said->event->measured;
    put_text(said, "|dr_proj_z| ");
    put_fixed(said, wh_real_abs(p->dr_proj_z), 3);
    put_text(said, " mm, |dr_proj_xy| ");
    put_fixed(said, p->dr_proj_xy_norm, 3);
    put_text(said, " mm, n1_proj_n2 ");
    put_fixed(said, p->n1_proj_n2, 6);
}

static void say_only_reason(said_t *said) {
    switch ((int)said->event->kind) {
    case WH_EVENT_HANDED_OVER:
        put_text(said, "from ");
        put_name(said, WH_NAME_GRIPPER, said->event->other);
        put_text(said, ", ");
        say_measured(said);
        break;
    case WH_EVENT_PICKED:
        say_measured(said);
        break;
    case WH_EVENT_CONTESTED:
        put_text(said, "ready, but ");
        put_name(said, WH_NAME_GRIPPER, said->event->other);
        put_text(said, " holds it");
        break;
    case WH_EVENT_BAD_INPUT:
        put_text(said, wh_status_text(said->event->status));
        break;
    default:
        say_of_cell(said);
        break;
    }
}

static void say_reason(said_t *said, size_t index) {
    if (said->event->kind == WH_EVENT_NEAR_MISS) {
        say_failed(said, index);
    } else if (index == 0) {
        say_only_reason(said);
    }
}

static said_t begin(const wh_event_t *event, const wh_event_names_t *names, char *buffer, size_t size) {
    static const wh_event_names_t none = {NULL, NULL, 0, NULL, NULL};
    said_t said;
    said.words = wh_words_begin(buffer, size);
    said.event = event;
    said.names = names ? names : &none;
    return said;
}

size_t wh_event_reason(const wh_event_t *event, const wh_event_names_t *names, size_t index, char *buffer,
                       size_t size) {
    said_t said = begin(event, names, buffer, size);
    say_reason(&said, index);
    return said.words.length;
}

/* ----------------------------------------------------------------------------------------- the whole text */

/* The event's name with spaces. */
static void say_what(said_t *said) {
    for (const char *c = wh_event_name(said->event->kind); *c != '\0'; ++c) {
        const char one[2] = {(char)(*c == '_' ? ' ' : *c), '\0'};
        put_text(said, one);
    }
}

static void say_whom(said_t *said) {
    const wh_event_t *event = said->event;
    if (event->wafer != WH_NONE) {
        put_text(said, ": ");
        put_name(said, WH_NAME_WAFER, event->wafer);
    }
    if (event->gripper != WH_NONE) {
        put_text(said, event->wafer != WH_NONE ? ", " : ": ");
        put_name(said, WH_NAME_GRIPPER, event->gripper);
    }
}

size_t wh_event_text(const wh_event_t *event, const wh_event_names_t *names, char *buffer, size_t size) {
    said_t said = begin(event, names, buffer, size);
    say_what(&said);
    say_whom(&said);
    for (size_t index = 0; wh_event_reason(event, names, index, NULL, 0) > 0; ++index) {
        put_text(&said, index == 0 ? ": " : "; ");
        say_reason(&said, index);
    }
    return said.words.length;
}
