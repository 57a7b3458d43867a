/* Each circle that three crossings agree on collects the crossings that fit it. The cheapest explanation of
 * all crossings wins, if no other has nearly as low a cost. */
#include "centring.h"

#include "angle_internal.h"
#include "check_internal.h"
#include "mismatch_internal.h"
#include "solve_internal.h"

/* The number of explanations that are kept: they are maximal sets of crossings, and few sets agree. */
#define GUESSES 12
#define STEPS 25
/* The cost, in squared deviations, of leaving out a crossing for the notch, a further one for the same
 * notch, and one without reason. An explanation that costs more by MARGIN is rejected: 1 : 8,000. */
#define COST_NOTCH 8
#define COST_SAME_NOTCH 2
#define COST_OTHER 30
#define MARGIN 18
/* A crossing joins a circle if its distance is at most this number of deviations. */
#define GATE 5
/* For the deviation the sine between beam and rim counts at least as this. */
#define LEAST_SINE 0.1
/* A radius without confirmation counts as likely up to this number of its deviations. */
#define LIKELY 3
/* The least standard deviation of a crossing, mm. */
#define LEAST_SD 1e-6

/* A circle and its members: bit i for crossing i. */
typedef struct {
    uint32_t members;
    int32_t used;
    double x, y, radius;
    double covariance[3][3]; /* of x, y, radius */
    double mismatch, cost;
} guess_t;

typedef struct {
    const wh_centring_t *known;
    const wh_crossing_t *crossings;
    size_t count;
    guess_t guesses[GUESSES];
    size_t guess_count;
} search_t;

/* The relation of a crossing to a circle. */
typedef struct {
    double off;      /* distance outside of the circle */
    double x, y;     /* direction from the centre */
    double variance; /* of `off`, without the circle's own variance */
    bool fits_edge;
} stand_t;

static stand_t stand(const search_t *search, const guess_t *guess, size_t i) {
    const wh_crossing_t *crossing = &search->crossings[i];
    const double dx = crossing->x - guess->x;
    const double dy = crossing->y - guess->y;
    const double distance = sqrt(dx * dx + dy * dy);
    stand_t s = {distance - guess->radius, dx / distance, dy / distance, 0, false};
    const double through = s.x * crossing->vx + s.y * crossing->vy;
    const double least =
        LEAST_SINE * LEAST_SINE * (crossing->vx * crossing->vx + crossing->vy * crossing->vy);
    const double square = through * through > least ? through * through : least;
    const wh_centring_t *of = search->known;
    s.variance = square * of->sd_time * of->sd_time + of->sd_place * of->sd_place + LEAST_SD * LEAST_SD;
    s.fits_edge = crossing->edge == WH_CROSSING_IN ? through < 0 : through > 0;
    return s;
}

/* The square of its distance in deviations, including the circle's own. */
static double strangeness(const guess_t *guess, const stand_t *s) {
    const double at[3] = {s->x, s->y, 1};
    double variance = s->variance;
    for (size_t i = 0; i < 3; ++i) {
        for (size_t j = 0; j < 3; ++j) {
            variance += at[i] * guess->covariance[i][j] * at[j];
        }
    }
    return s->off * s->off / variance;
}

static bool has(const guess_t *guess, size_t i) {
    return (guess->members >> i & 1) != 0;
}

/* ----------------------------------------------------------------------------------------------- the fit */

/* Takes a step of Gauss and Newton; returns its length, or a negative number. */
static double step(const search_t *search, guess_t *guess, wh_normal_t *normal) {
    const wh_centring_t *known = search->known;
    wh_normal_begin(normal, known->sd_radius > 0 ? 3 : 2);
    guess->mismatch = 0;
    for (size_t i = 0; i < search->count; ++i) {
        if (has(guess, i)) {
            const stand_t s = stand(search, guess, i);
            const double derivatives[3] = {s.x, s.y, 1};
            wh_normal_add(normal, derivatives, s.off, 1 / s.variance);
            guess->mismatch += s.off * s.off / s.variance;
        }
    }
    if (known->sd_radius > 0) {
        const double derivatives[3] = {0, 0, 1};
        const double weight = 1 / (known->sd_radius * known->sd_radius);
        const double off = known->radius - guess->radius;
        wh_normal_add(normal, derivatives, off, weight);
        guess->mismatch += off * off * weight;
    }
    if (!wh_normal_solve(normal)) {
        return -1;
    }
    const double dr = known->sd_radius > 0 ? normal->right[2] : 0;
    guess->x += normal->right[0];
    guess->y += normal->right[1];
    guess->radius += dr;
    return fabs(normal->right[0]) + fabs(normal->right[1]) + fabs(dr);
}

/* Moves the guess to the best circle for its members; false if there is none within reach. */
static bool fit(const search_t *search, guess_t *guess) {
    const wh_centring_t *known = search->known;
    wh_normal_t normal;
    wh_normal_begin(&normal, 2);
    double moved = 1;
    for (int i = 0; i < STEPS && moved > 1e-10; ++i) {
        moved = step(search, guess, &normal);
        const double dx = guess->x - known->x;
        const double dy = guess->y - known->y;
        const double far = 2 * known->reach;
        if (!(moved >= 0 && dx * dx + dy * dy <= far * far)) {
            return false;
        }
    }
    for (size_t i = 0; i < 3; ++i) {
        for (size_t j = 0; j < 3; ++j) {
            guess->covariance[i][j] = i < normal.terms && j < normal.terms ? normal.matrix[i][j] : 0;
        }
    }
    return moved <= 1e-10 && guess->mismatch <= wh_mismatch_limit(guess->used - 2);
}

/* ---------------------------------------------------------------------------------------------- the notch */

static double direction_of(const stand_t *s) {
    return wh_align_atan2(s->y, s->x);
}

/* True if the notch's direction is known, and the notch may be there. */
static bool in_notch_arc(const search_t *search, const stand_t *s) {
    const wh_centring_t *known = search->known;
    if (!known->notch_known || known->notch_width == 0) {
        return false;
    }
    const double aside = fabs(wh_align_wrap(direction_of(s) - known->notch_direction));
    return aside <= known->notch_width / (2 * known->radius) + 3 * known->sd_notch;
}

/* True if its distance inside the circle fits a notch. */
static bool is_in_notch(const search_t *search, const stand_t *s) {
    const wh_centring_t *known = search->known;
    if (known->notch_known) {
        return in_notch_arc(search, s);
    }
    return known->notch_width > 0 && s->off < 0 && s->off >= -known->notch_depth;
}

/* Finds the left-out crossing that is furthest in, where a notch may be; false if there is none. */
static bool find_notch(const search_t *search, const guess_t *guess, stand_t *deepest) {
    bool found = false;
    for (size_t i = 0; i < search->count; ++i) {
        const stand_t s = stand(search, guess, i);
        if (!has(guess, i) && is_in_notch(search, &s) && (!found || s.off < deepest->off)) {
            *deepest = s;
            found = true;
        }
    }
    return found;
}

/* Gives each crossing its use for this circle, and returns the cost. For the notch it leaves out the
 * crossing that is furthest in, and those within the notch's width of it. */
static double explain(const search_t *search, const guess_t *guess, wh_crossing_use_t use[WH_CROSSINGS]) {
    stand_t deepest = {0, 1, 0, 0, false};
    const bool notched = find_notch(search, guess, &deepest);
    double cost = guess->mismatch + (notched ? COST_NOTCH - COST_SAME_NOTCH : 0);
    for (size_t i = 0; i < search->count; ++i) {
        const stand_t s = stand(search, guess, i);
        use[i] = WH_CROSSING_USED;
        if (!has(guess, i)) {
            const bool same =
                notched && is_in_notch(search, &s) &&
                fabs(wh_align_wrap(direction_of(&s) - direction_of(&deepest))) * guess->radius <=
                    search->known->notch_width;
            use[i] = same ? WH_CROSSING_NOTCH : WH_CROSSING_OTHER;
            cost += same ? COST_SAME_NOTCH : COST_OTHER;
        }
    }
    return cost;
}

/* -------------------------------------------------------------------------------------------- the search */

/* The crossing with the least distance that may join; false if there is none. */
static bool next_member(const search_t *search, const guess_t *guess, size_t *next) {
    double least = GATE * GATE;
    bool found = false;
    for (size_t i = 0; i < search->count; ++i) {
        const stand_t s = stand(search, guess, i);
        if (!has(guess, i) && s.fits_edge && !in_notch_arc(search, &s) && strangeness(guess, &s) < least) {
            least = strangeness(guess, &s);
            *next = i;
            found = true;
        }
    }
    return found;
}

/* Adds one crossing after the other, while they all fit one circle. */
static void gather(const search_t *search, guess_t *guess) {
    size_t next = 0;
    while (next_member(search, guess, &next)) {
        guess_t wider = *guess;
        wider.members |= UINT32_C(1) << next;
        ++wider.used;
        if (!fit(search, &wider)) {
            return;
        }
        *guess = wider;
    }
}

/* True if all members fit, and the centre is within reach. */
static bool is_sound(const search_t *search, const guess_t *guess) {
    const wh_centring_t *known = search->known;
    const double dx = guess->x - known->x;
    const double dy = guess->y - known->y;
    if (dx * dx + dy * dy > known->reach * known->reach) {
        return false;
    }
    for (size_t i = 0; i < search->count; ++i) {
        const stand_t s = stand(search, guess, i);
        if (has(guess, i) && (!s.fits_edge || in_notch_arc(search, &s))) {
            return false;
        }
    }
    return true;
}

/* True if an explanation already has all of these crossings. */
static bool is_known(const search_t *search, uint32_t members) {
    for (size_t k = 0; k < search->guess_count; ++k) {
        if ((members & ~search->guesses[k].members) == 0) {
            return true;
        }
    }
    return false;
}

/* If all places are taken, the most expensive one is replaced. */
static void keep(search_t *search, const guess_t *guess) {
    size_t place = search->guess_count;
    if (place < GUESSES) {
        ++search->guess_count;
    } else {
        place = 0;
        for (size_t k = 1; k < GUESSES; ++k) {
            place = search->guesses[k].cost > search->guesses[place].cost ? k : place;
        }
        if (search->guesses[place].cost <= guess->cost) {
            return;
        }
    }
    search->guesses[place] = *guess;
}

static void try_three(search_t *search, size_t i, size_t j, size_t k) {
    const uint32_t members = UINT32_C(1) << i | UINT32_C(1) << j | UINT32_C(1) << k;
    const wh_crossing_t *c = search->crossings;
    if ((c[i].beam == c[j].beam && c[j].beam == c[k].beam) || is_known(search, members)) {
        return;
    }
    const wh_centring_t *known = search->known;
    guess_t guess = {.members = members, .used = 3, .x = known->x, .y = known->y, .radius = known->radius};
    if (!fit(search, &guess) || !is_sound(search, &guess)) {
        return;
    }
    gather(search, &guess);
    if (is_sound(search, &guess) && !is_known(search, guess.members)) {
        wh_crossing_use_t use[WH_CROSSINGS];
        guess.cost = explain(search, &guess, use);
        keep(search, &guess);
    }
}

static void search_all(search_t *search) {
    for (size_t i = 0; i < search->count; ++i) {
        for (size_t j = i + 1; j < search->count; ++j) {
            for (size_t k = j + 1; k < search->count; ++k) {
                try_three(search, i, j, k);
            }
        }
    }
}

/* ---------------------------------------------------------------------------------------------- the whole */

static double root_of(double square) {
    return sqrt(square > 0 ? square : 0);
}

static void tell(const search_t *search, const guess_t *guess, wh_centre_t *centre) {
    const double xx = guess->covariance[0][0];
    const double yy = guess->covariance[1][1];
    const double xy = guess->covariance[0][1];
    centre->x = guess->x;
    centre->y = guess->y;
    centre->radius = guess->radius;
    centre->sd_x = sqrt(xx);
    centre->sd_y = sqrt(yy);
    centre->sd_centre = root_of((xx + yy) / 2 + root_of((xx - yy) * (xx - yy) / 4 + xy * xy));
    centre->mismatch = guess->mismatch;
    centre->used = guess->used;
    for (size_t i = 0; i < WH_CROSSINGS; ++i) {
        centre->use[i] = WH_CROSSING_OTHER;
    }
    (void)explain(search, guess, centre->use);
}

/* The other explanations that cost little more than the best one. Those within `agree` enlarge its
 * deviations; of the others the cheapest is returned, or null. */
static const guess_t *find_rival(const search_t *search, const guess_t *best, wh_centre_t *centre) {
    const guess_t *rival = NULL;
    double widest[3] = {0, 0, 0};
    for (size_t k = 0; k < search->guess_count; ++k) {
        const guess_t *guess = &search->guesses[k];
        const double dx = guess->x - best->x;
        const double dy = guess->y - best->y;
        const double square = dx * dx + dy * dy;
        if (guess == best || guess->cost >= best->cost + MARGIN) {
            continue;
        }
        if (square > search->known->agree * search->known->agree) {
            rival = rival == NULL || guess->cost < rival->cost ? guess : rival;
        } else {
            widest[0] = dx * dx > widest[0] ? dx * dx : widest[0];
            widest[1] = dy * dy > widest[1] ? dy * dy : widest[1];
            widest[2] = square > widest[2] ? square : widest[2];
        }
    }
    centre->sd_x = sqrt(centre->sd_x * centre->sd_x + widest[0]);
    centre->sd_y = sqrt(centre->sd_y * centre->sd_y + widest[1]);
    centre->sd_centre = sqrt(centre->sd_centre * centre->sd_centre + widest[2]);
    return rival;
}

/* Finds the two crossings of three that belong to one beam, and the third. */
static void find_pair(const search_t *search, const guess_t *guess, size_t of[3]) {
    size_t count = 0;
    for (size_t i = 0; i < search->count && count < 3; ++i) {
        of[count] = i;
        count += has(guess, i) ? 1 : 0;
    }
    const wh_crossing_t *c = search->crossings;
    size_t alone = 0;
    if (c[of[0]].beam == c[of[1]].beam) {
        alone = 2;
    } else if (c[of[0]].beam == c[of[2]].beam) {
        alone = 1;
    }
    const size_t third = of[alone];
    of[alone] = of[2];
    of[2] = third;
}

static double not_below(double value, double least) {
    return value < 0 ? (value > -least ? -least : value) : (value < least ? least : value);
}

/* The shift of the centre if the radius had not changed by `grown` but a beam stood at another place. */
static void doubt(const search_t *search, const guess_t *guess, double grown, double *dx, double *dy) {
    size_t of[3] = {0, 0, 0};
    find_pair(search, guess, of);
    const stand_t a = stand(search, guess, of[0]);
    const stand_t b = stand(search, guess, of[1]);
    const stand_t c = stand(search, guess, of[2]);
    const wh_crossing_t *third = &search->crossings[of[2]];
    const double by = grown / not_below(a.x * b.y - a.y * b.x, LEAST_SINE);
    const double x = by * (b.y - a.y); /* if the third crossing's beam does */
    const double y = by * (a.x - b.x);
    const double least = LEAST_SINE * sqrt(third->vx * third->vx + third->vy * third->vy);
    const double time = (grown - c.x * x - c.y * y) / not_below(c.x * third->vx + c.y * third->vy, least);
    const double far_x = x + time * third->vx; /* if the pair's beam does, along the way */
    const double far_y = y + time * third->vy;
    const bool farther = far_x * far_x + far_y * far_y > x * x + y * y;
    *dx = farther ? far_x : x;
    *dy = farther ? far_y : y;
}

/* Three crossings and an inexact radius cannot contradict each other, so the radius must be likely by
 * itself. */
static bool is_likely(const search_t *search, const guess_t *guess, wh_centre_t *centre) {
    const double sd = search->known->sd_radius;
    const double grown = guess->radius - search->known->radius;
    if (guess->used > WH_CROSSINGS_LEAST || !(sd > 0)) {
        return true;
    }
    double dx, dy;
    doubt(search, guess, grown, &dx, &dy);
    centre->sd_x = sqrt(centre->sd_x * centre->sd_x + dx * dx);
    centre->sd_y = sqrt(centre->sd_y * centre->sd_y + dy * dy);
    centre->sd_centre = sqrt(centre->sd_centre * centre->sd_centre + dx * dx + dy * dy);
    return grown * grown <= LIKELY * LIKELY * sd * sd;
}

static wh_status_t judge(const search_t *search, wh_centres_t *centres) {
    const guess_t *best = NULL;
    for (size_t k = 0; k < search->guess_count; ++k) {
        best = best == NULL || search->guesses[k].cost < best->cost ? &search->guesses[k] : best;
    }
    if (best == NULL) {
        centres->count = 0;
        return WH_STATUS_CENTRE_NOT_SURE;
    }
    tell(search, best, &centres->candidates[0]);
    const bool likely = is_likely(search, best, &centres->candidates[0]);
    const guess_t *rival = find_rival(search, best, &centres->candidates[0]);
    centres->count = 1;
    if (rival != NULL) {
        centres->count = 2;
        tell(search, rival, &centres->candidates[1]);
    }
    return likely && rival == NULL ? WH_OK : WH_STATUS_CENTRE_NOT_SURE;
}

wh_centring_t wh_centring_nominal(double radius) {
    const wh_centring_t known = {
        .radius = radius, .reach = 5, .sd_time = 3e-6, .notch_width = 3.5, .notch_depth = 1.3};
    return known;
}

wh_status_t wh_centring_validate(const wh_centring_t *known, wh_bad_field_t *bad) {
    if (known == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_field_check_t found = wh_field_check_begin();
    wh_field_check(&found, "radius", WH_NONE, known->radius, 10, 300);
    wh_field_check(&found, "sd_radius", WH_NONE, known->sd_radius, 0, 1);
    wh_field_check(&found, "x", WH_NONE, known->x, -300, 300);
    wh_field_check(&found, "y", WH_NONE, known->y, -300, 300);
    wh_field_check(&found, "reach", WH_NONE, known->reach, 0.1, known->radius / 3);
    wh_field_check(&found, "sd_time", WH_NONE, known->sd_time, 0, 1e-3);
    wh_field_check(&found, "sd_place", WH_NONE, known->sd_place, 0, 1);
    wh_field_check(&found, "notch_width", WH_NONE, known->notch_width, 0, 100);
    if (found.status == WH_OK && known->notch_width > 0) {
        wh_field_check(&found, "notch_depth", WH_NONE, known->notch_depth, 0, 10);
    }
    if (found.status == WH_OK && known->notch_width > 0 && known->notch_known) {
        wh_field_check(&found, "notch_direction", WH_NONE, known->notch_direction, -WH_ALIGN_TURN,
                       WH_ALIGN_TURN);
        wh_field_check(&found, "sd_notch", WH_NONE, known->sd_notch, 0, 1);
    }
    wh_field_check(&found, "agree", WH_NONE, known->agree, 0, 1);
    return wh_field_check_end(&found, bad);
}

static wh_status_t check_crossing(const wh_crossing_t *crossing) {
    wh_field_check_t found = wh_field_check_begin();
    const double vx = crossing->vx;
    const double vy = crossing->vy;
    wh_field_check(&found, "x", WH_NONE, crossing->x, -1e3, 1e3);
    wh_field_check(&found, "y", WH_NONE, crossing->y, -1e3, 1e3);
    wh_field_check(&found, "vx", WH_NONE, vx, -1e4, 1e4);
    wh_field_check(&found, "vy", WH_NONE, vy, -1e4, 1e4);
    wh_field_check(&found, "v", WH_NONE, vx * vx + vy * vy, 1e-4, 1e8);
    wh_field_check(&found, "beam", WH_NONE, crossing->beam, 0, INT32_MAX);
    wh_field_check(&found, "edge", WH_NONE, (double)crossing->edge, WH_CROSSING_IN, WH_CROSSING_OUT);
    return wh_field_check_end(&found, NULL);
}

static wh_status_t check_crossings(const wh_crossing_t *crossings, size_t count) {
    if (count > WH_CROSSINGS) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    bool two_beams = false;
    for (size_t i = 0; i < count; ++i) {
        const wh_status_t status = check_crossing(&crossings[i]);
        if (status != WH_OK) {
            return status;
        }
        two_beams = two_beams || crossings[i].beam != crossings[0].beam;
    }
    return count < WH_CROSSINGS_LEAST || !two_beams ? WH_STATUS_TOO_FEW_SAMPLES : WH_OK;
}

wh_status_t wh_centring_solve(const wh_centring_t *known, const wh_crossing_t *crossings, size_t count,
                              wh_centres_t *centres) {
    if (known == NULL || crossings == NULL || centres == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_status_t status = wh_centring_validate(known, NULL);
    status = status == WH_OK ? check_crossings(crossings, count) : status;
    if (status != WH_OK) {
        return status;
    }
    search_t search = {.known = known, .crossings = crossings, .count = count};
    search_all(&search);
    return judge(&search, centres);
}
