#include "put.h"

#include <math.h>

#include "../record/quaternion.h"

void wh_put_text(wh_json_text_t *text, const char *key, const char *value) {
    wh_json_text_value(text, key, wh_json_text(value));
}

void wh_put_exact(wh_json_text_t *text, const char *key, double value) {
    wh_json_text_number(text, key, value, 0, true);
}

void wh_put_list(wh_json_text_t *text, const char *key, const double values[], size_t count) {
    wh_json_text_begin(text, key, '[');
    for (size_t i = 0; i < count; ++i) {
        wh_put_exact(text, NULL, values[i]);
    }
    wh_json_text_end(text, ']');
}

void wh_put_point(wh_json_text_t *text, const char *key, const wh_vec3_t *point) {
    const double values[] = {point->x, point->y, point->z};
    wh_put_list(text, key, values, 3);
}

void wh_put_pose(wh_json_text_t *text, const wh_pose_t *pose) {
    double q[4];
    wh_quaternion_from_matrix(&pose->R, NULL, q);
    wh_put_point(text, "r", &pose->r);
    wh_put_list(text, "q", q, 4);
}

void wh_put_index(wh_json_text_t *text, const char *key, int32_t index) {
    wh_put_exact(text, key, index == WH_NONE ? HUGE_VAL : index);
}
