#include "passive.h"

#include "face.h"
#include "sweep_internal.h"

/* Down to 2^-50 of a slice. */
#define HALVINGS 50

/* The wafer's face towards pads or a support. */
static void see(const wh_passive_t *passive, const wh_pose_t *base_from_wafer, const wh_pose_t *plane,
                wh_pose_t *base_from_face) {
    wh_face_frame(base_from_wafer, passive->thickness,
                  wh_face_seen(base_from_wafer, passive->thickness, plane), base_from_face);
}

/* The face towards them, and its height above their plane. */
static wh_real_t height_of(const wh_passive_t *passive, const wh_pose_t *base_from_wafer,
                           const wh_pose_t *plane, wh_pose_t *base_from_face) {
    see(passive, base_from_wafer, plane, base_from_face);
    const wh_vec3_t dr = wh_vec3_subtract(&base_from_face->r, &plane->r);
    const wh_vec3_t n = wh_mat3_column(&plane->R, 2);
    return wh_vec3_dot(&dr, &n);
}

/* Tests (7) and (8). */
static bool is_over(const wh_passive_t *passive, const wh_pose_t *base_from_wafer, const wh_pose_t *plane) {
    wh_pose_t face;
    wh_proximity_t p;
    see(passive, base_from_wafer, plane, &face);
    return wh_proximity_measure(&face, plane, &passive->tolerance, &p) == WH_OK &&
           (p.failed & ~(unsigned)WH_FAILED_PROJZ) == 0;
}

static void lift(wh_pose_t *base_from_wafer, const wh_pose_t *plane, wh_real_t way) {
    const wh_vec3_t n = wh_mat3_column(&plane->R, 2);
    const wh_vec3_t up = wh_vec3_scale(way, &n);
    base_from_wafer->r = wh_vec3_add(&base_from_wafer->r, &up);
}

/* One slice, as the functions below use it. */
typedef struct {
    const wh_passive_t *passive;
    const wh_pose_t *begin, *end; /* of the pads */
    const wh_sweep_t *sweep;      /* the motion between them, if sweeping is built */
    const wh_pose_t *support;     /* null: none */
    const wh_passive_wafer_t *wafer;
} slice_t;

/* The pads at an instant; only 0 or 1 if sweeping is not built. */
static void pads_at(const slice_t *slice, wh_real_t t, wh_pose_t *pads) {
    if (WH_SWEEP_BUILT) {
        wh_sweep_pose_at(slice->sweep, t, pads);
    } else {
        *pads = t < 1 ? *slice->begin : *slice->end;
    }
}

/* Carries like the table: a product that would not pass wh_pose_validate is mended; otherwise the next
 * slice would refuse it. */
static void carry(const wh_pose_t *pads, const wh_pose_t *gripper_from_wafer, wh_pose_t *base_from_wafer) {
    wh_pose_compose_to(pads, gripper_from_wafer, base_from_wafer);
    if (!wh_mat3_is_orthonormal(&base_from_wafer->R)) {
        wh_mat3_orthonormalise(&base_from_wafer->R);
    }
}

/* The wafer at an instant: at its own place, or where the pads carry it. */
static void wafer_at(const slice_t *slice, const wh_pose_t *pads, wh_pose_t *base_from_wafer) {
    if (slice->wafer->carried) {
        carry(pads, &slice->wafer->gripper_from_wafer, base_from_wafer);
    } else {
        *base_from_wafer = slice->wafer->base_from_wafer;
    }
}

/* The distance between the contact plane and the other plane at an instant: the pads' plane, or the
 * support's for a carried wafer. */
static wh_real_t gap_at(const slice_t *slice, wh_real_t t) {
    wh_pose_t pads;
    wh_pose_t wafer;
    wh_pose_t face;
    pads_at(slice, t, &pads);
    wafer_at(slice, &pads, &wafer);
    const bool to_support = slice->wafer->carried && slice->support;
    return height_of(slice->passive, &wafer, to_support ? slice->support : &pads, &face);
}

/* Finds the slice's end, or with sweeping the instant at which the planes meet; false if they do not. */
static bool meet(const slice_t *slice, wh_real_t *instant) {
    wh_real_t from = 0;
    *instant = 1;
    if (!(gap_at(slice, 0) >= -WH_PASSIVE_FLAT) || !(gap_at(slice, 1) <= 0)) {
        return false;
    }
    for (int i = 0; slice->passive->check == WH_CHECK_SWEPT && i < HALVINGS; ++i) {
        const wh_real_t middle = from + (*instant - from) / 2;
        *(gap_at(slice, middle) > 0 ? &from : instant) = middle;
    }
    return true;
}

/* Puts the wafer onto the plane of the pads and moves it with them to the slice's end. */
static bool take(const slice_t *slice, wh_passive_wafer_t *wafer) {
    wh_real_t t;
    wh_pose_t pads;
    wh_pose_t face;
    if (!meet(slice, &t)) {
        return false;
    }
    pads_at(slice, t, &pads);
    if (!is_over(slice->passive, &wafer->base_from_wafer, &pads)) {
        return false;
    }
    lift(&wafer->base_from_wafer, &pads, -height_of(slice->passive, &wafer->base_from_wafer, &pads, &face));
    wh_pose_relative_to(&pads, &wafer->base_from_wafer, &wafer->gripper_from_wafer);
    wh_mat3_orthonormalise(&wafer->gripper_from_wafer.R);
    carry(slice->end, &wafer->gripper_from_wafer, &wafer->base_from_wafer);
    wafer->carried = true;
    return !slice->support || height_of(slice->passive, &wafer->base_from_wafer, slice->support, &face) > 0;
}

static bool leave(const slice_t *slice, wh_passive_wafer_t *wafer) {
    wh_real_t t;
    wh_pose_t pads;
    wh_pose_t face;
    if (!slice->support || !meet(slice, &t)) {
        return false;
    }
    pads_at(slice, t, &pads);
    wafer_at(slice, &pads, &wafer->base_from_wafer);
    if (!is_over(slice->passive, &wafer->base_from_wafer, slice->support)) {
        return false;
    }
    lift(&wafer->base_from_wafer, slice->support,
         -height_of(slice->passive, &wafer->base_from_wafer, slice->support, &face));
    wafer->carried = false;
    return true;
}

static wh_status_t validate_wafer(const wh_passive_wafer_t *wafer) {
    const wh_status_t status = wh_pose_validate(&wafer->base_from_wafer);
    return status == WH_OK && wafer->carried ? wh_pose_validate(&wafer->gripper_from_wafer) : status;
}

static wh_status_t validate_planes(const wh_pose_t *begin, const wh_pose_t *end, const wh_pose_t *support) {
    wh_status_t status = wh_pose_validate(begin);
    if (status == WH_OK) {
        status = wh_pose_validate(end);
    }
    return status == WH_OK && support ? wh_pose_validate(support) : status;
}

static wh_status_t validate(const wh_passive_t *passive) {
    if (!wh_real_is_finite(passive->thickness)) {
        return WH_STATUS_NOT_FINITE;
    }
    if (!WH_SWEEP_BUILT && passive->check == WH_CHECK_SWEPT) {
        return WH_STATUS_NOT_BUILT;
    }
    const bool good = passive->thickness >= 0 && passive->thickness <= WH_FACE_THICKEST &&
                      (passive->check == WH_CHECK_SAMPLED || passive->check == WH_CHECK_SWEPT);
    return good ? wh_tolerance_validate(&passive->tolerance) : WH_STATUS_OUT_OF_RANGE;
}

/* `after` begins as the wafer and receives its new state if something happens to it. */
static wh_passive_change_t change_of(const slice_t *slice, wh_passive_wafer_t *after) {
    const bool carried = slice->wafer->carried;
    if (carried ? leave(slice, after) : take(slice, after)) {
        return carried ? WH_PASSIVE_LEFT : WH_PASSIVE_TAKEN;
    }
    *after = *slice->wafer;
    wafer_at(slice, slice->end, &after->base_from_wafer);
    return WH_PASSIVE_STAYS;
}

wh_status_t wh_passive_step(const wh_passive_t *passive, const wh_pose_t *begin, const wh_pose_t *end,
                            const wh_pose_t *base_from_support, wh_passive_wafer_t *wafer,
                            wh_passive_change_t *change) {
    if (!passive || !begin || !end || !wafer || !change) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_status_t status = validate(passive);
    if (status == WH_OK) {
        status = validate_planes(begin, end, base_from_support);
    }
    if (status == WH_OK) {
        status = validate_wafer(wafer);
    }
    if (status == WH_OK) {
        wh_sweep_t sweep;
        wh_passive_wafer_t after = *wafer;
        if (WH_SWEEP_BUILT) {
            wh_sweep_between(begin, end, &sweep);
        }
        const slice_t slice = {passive, begin, end, &sweep, base_from_support, wafer};
        *change = change_of(&slice, &after);
        *wafer = after;
    }
    return status;
}

wh_pads_t wh_passive_pads(const wh_pads_t *pads) {
    static const wh_pads_t usual = {WH_PASSIVE_FRICTION, 0, 1, WH_REAL(9.81)};
    wh_pads_t passive = pads->mass > 0 ? *pads : usual;
    passive.force = 0;
    return passive;
}

wh_real_t wh_passive_limit(const wh_pads_t *pads, const wh_mat3_t *base_from_gripper) {
    const wh_vec3_t n = wh_mat3_column(base_from_gripper, 2);
    const wh_real_t across = wh_real_sqrt(n.x * n.x + n.y * n.y);
    return 1000 * pads->gravity * (pads->friction * n.z - across);
}
