#include "names.h"

const char *wh_record_wafer_name(const wh_record_t *record, int32_t wafer) {
    const wh_layout_t *layout = record->layout;
    return layout && wh_is_index(wafer, layout->wafer_count) ? layout->wafers[wafer].name : NULL;
}

const char *wh_record_gripper_name(const wh_record_t *record, int32_t gripper) {
    const wh_layout_t *layout = record->layout;
    return layout && wh_is_index(gripper, layout->machine.gripper_count) ? layout->grippers[gripper].name
                                                                         : NULL;
}

const char *wh_record_station_name(const wh_record_t *record, int32_t station) {
    const wh_layout_t *layout = record->layout;
    return layout && wh_is_index(station, layout->station_count) ? layout->stations[station].name : NULL;
}

const char *wh_record_rank_text(wh_rank_t rank) {
    static const char *const texts[] = {
        [WH_RANK_NONE] = NULL,
        [WH_RANK_PREALIGNER] = "puts onto prealigners",
        [WH_RANK_SINGLE] = "puts into stations with one slot",
        [WH_RANK_SEVERAL] = "puts into stations with several slots",
        [WH_RANK_FOUP] = "puts into FOUPs",
    };
    return texts[rank];
}
