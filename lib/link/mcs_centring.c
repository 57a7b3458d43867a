/* What the beams at a door told, once a blade has passed them. */
#include "mcs_process_internal.h"

static waferhand_crossing crossing_of(const wh_mcs_crossing_t *from, wh_crossing_use_t use) {
    const wh_crossing_t *crossing = &from->crossing;
    const waferhand_crossing message = {crossing->beam, (int32_t)crossing->edge,
                                        (int32_t)use,   from->time,
                                        crossing->x,    crossing->y,
                                        crossing->vx,   crossing->vy};
    return message;
}

static waferhand_centre centre_of(const wh_centre_t *from) {
    const waferhand_centre message = {from->x,    from->y,        from->radius, from->sd_x,
                                      from->sd_y, from->mismatch, from->used};
    return message;
}

void wh_mcs_process_tell_centring(void *user, const wh_mcs_t *mcs) {
    wh_mcs_process_t *control = user;
    const wh_mcs_centring_t *centring = &mcs->centring;
    waferhand_crossing crossings[WH_CROSSINGS];
    waferhand_centre centres[2];
    const waferhand_mcs now = wh_mcs_process_message(control, 0, 0, WH_OK, "", "");
    for (size_t i = 0; i < centring->count; ++i) {
        crossings[i] = crossing_of(&centring->crossings[i], centring->centres.candidates[0].use[i]);
    }
    for (int32_t i = 0; i < centring->centres.count; ++i) {
        centres[i] = centre_of(&centring->centres.candidates[i]);
    }
    const waferhand_centring message = {.utime = mcs->pass.seq * mcs->layout->slice_us,
                                        .seq = mcs->pass.seq,
                                        .run = now.run,
                                        .layout_hash = now.layout_hash,
                                        .number = (int32_t)mcs->pass.number,
                                        .station = centring->station,
                                        .gripper = centring->gripper,
                                        .status = (int32_t)centring->status,
                                        .missed = (int32_t)centring->missed,
                                        .crossing_count = (int32_t)centring->count,
                                        .centre_count = centring->centres.count,
                                        .crossings = crossings,
                                        .centres = centres};
    const int size = waferhand_centring_encode(control->encoded, 0, (int)sizeof control->encoded, &message);
    if (size > 0) {
        (void)wh_node_publish(control->node, WH_CHANNEL_LATCH, control->encoded, (size_t)size);
    }
}
