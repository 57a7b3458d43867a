/* Members and elements of a document, as it comes (text/json.h). `key` is null for an element. */
#ifndef WH_REPORT_PUT_H
#define WH_REPORT_PUT_H

#include "../math/pose.h"
#include "../text/json.h"

/* A text, with U+FFFD for each byte that is not UTF-8; null for null. */
void wh_put_text(wh_json_text_t *text, const char *key, const char *value);

/* A number that reads back as an equal double; null for infinities and NaN. */
void wh_put_exact(wh_json_text_t *text, const char *key, double value);
void wh_put_list(wh_json_text_t *text, const char *key, const double values[], size_t count);
void wh_put_point(wh_json_text_t *text, const char *key, const wh_vec3_t *point);

/* The members r and q. */
void wh_put_pose(wh_json_text_t *text, const wh_pose_t *pose);

/* Null for WH_NONE. */
void wh_put_index(wh_json_text_t *text, const char *key, int32_t index);

#endif
