/* The words of a layout's enumerations, each list in the enumeration's order and up to a null. */
#ifndef WH_LAYOUT_WORDS_H
#define WH_LAYOUT_WORDS_H

extern const char *const wh_layout_check_words[];        /* wh_check_t */
extern const char *const wh_layout_handover_words[];     /* wh_handover_t */
extern const char *const wh_layout_vacuum_check_words[]; /* wh_vacuum_check_t */
extern const char *const wh_layout_beam_stuck_words[];   /* wh_beam_stuck_t of a beam */
extern const char *const wh_layout_touch_stuck_words[];  /* wh_beam_stuck_t of a probe */
extern const char *const wh_layout_grip_words[];         /* wh_grip_kind_t */
extern const char *const wh_layout_phase_words[];        /* wh_grip_phase_t */
extern const char *const wh_layout_mount_words[];        /* wh_mount_kind_t */
extern const char *const wh_layout_robot_words[];        /* wh_chain_kind_t */
extern const char *const wh_layout_side_words[];         /* of an elbow: left, right */
extern const char *const wh_layout_door_words[];         /* shut, open */
extern const char *const wh_layout_shape_words[];        /* wh_shape_t */
extern const char *const wh_layout_station_words[];      /* kinds of stations: see wh_layout_station_kind */
#define WH_LAYOUT_LOAD_PORT 4                            /* the index of "load_port" among them */
extern const char *const wh_layout_stop_words[];         /* wh_layout_stop_t from WH_LAYOUT_STOP_RAMP on */
extern const char *const wh_layout_face_words[];         /* wh_station_face_t from WH_STATION_FACE_UP on */
extern const char *const wh_layout_vacuum_words[];       /* models: ideal, delayed */
extern const char *const wh_layout_unit_words[];         /* of a mesh: mm, cm, m, inch */

#endif
