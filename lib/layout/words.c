#include "words.h"

#include <stddef.h>

const char *const wh_layout_check_words[] = {"sampled", "swept", NULL};
const char *const wh_layout_handover_words[] = {"new_first", "same_slice", NULL};
const char *const wh_layout_vacuum_check_words[] = {"both", "get", "put", "none", NULL};
const char *const wh_layout_beam_stuck_words[] = {"no", "dark", "lit", NULL};
const char *const wh_layout_touch_stuck_words[] = {"no", "closed", "open", NULL};
const char *const wh_layout_grip_words[] = {"vacuum", "edge", "passive", NULL};
const char *const wh_layout_phase_words[] = {"open",   "closing", "closed", "jammed",
                                             "missed", "opening", NULL};
const char *const wh_layout_mount_words[] = {"chuck", "stage", "pins", "flipper", NULL};
const char *const wh_layout_robot_words[] = {"TRZY", "TRZ", "SCARA", NULL};
const char *const wh_layout_side_words[] = {"left", "right", NULL};
const char *const wh_layout_door_words[] = {"shut", "open", NULL};
const char *const wh_layout_shape_words[] = {"normal", "uniform", NULL};
const char *const wh_layout_station_words[] = {"slots", "prealigner", "foup", "flipper", "load_port", NULL};
const char *const wh_layout_stop_words[] = {"ramp", "freeze", NULL};
const char *const wh_layout_face_words[] = {"up", "down", NULL};
const char *const wh_layout_vacuum_words[] = {"ideal", "delayed", NULL};
const char *const wh_layout_unit_words[] = {"mm", "cm", "m", "inch", NULL};
