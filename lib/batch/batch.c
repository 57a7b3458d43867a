#include "batch/batch_internal.h"

/* A wafer's first number in each half; the others follow at steps of WH_BATCH_BLOCK. */
static size_t near_half(size_t wafer) {
    return wafer / WH_BATCH_BLOCK * WH_BATCH_HALF + wafer % WH_BATCH_BLOCK;
}

static size_t far_half(const wh_batch_t *batch, size_t wafer) {
    return WH_BATCH_NUMBERS(batch->wafer_count) / 2 + near_half(wafer);
}

static void put(wh_real_t *numbers, const wh_vec3_t *v) {
    numbers[0] = v->x;
    numbers[WH_BATCH_BLOCK] = v->y;
    numbers[2 * WH_BATCH_BLOCK] = v->z;
}

static void put_pose(const wh_batch_t *batch, size_t wafer, const wh_pose_t *pose) {
    wh_real_t *at = &batch->numbers[near_half(wafer)];
    const wh_vec3_t e1 = wh_mat3_column(&pose->R, 0);
    const wh_vec3_t e2 = wh_mat3_column(&pose->R, 1);
    const wh_vec3_t n1 = wh_mat3_column(&pose->R, 2);
    put(at, &n1);
    put(&at[3 * WH_BATCH_BLOCK], &pose->r);
    at = &batch->numbers[far_half(batch, wafer)];
    put(at, &e1);
    put(&at[3 * WH_BATCH_BLOCK], &e2);
}

static wh_pose_t get_pose(const wh_batch_t *batch, size_t wafer) {
    const wh_real_t *near = &batch->numbers[near_half(wafer)];
    const wh_real_t *far = &batch->numbers[far_half(batch, wafer)];
    const wh_vec3_t n1 = wh_batch_vector(near);
    const wh_vec3_t e1 = wh_batch_vector(far);
    const wh_vec3_t e2 = wh_batch_vector(&far[3 * WH_BATCH_BLOCK]);
    const wh_pose_t pose = {{{{e1.x, e2.x, n1.x}, {e1.y, e2.y, n1.y}, {e1.z, e2.z, n1.z}}},
                            wh_batch_vector(&near[3 * WH_BATCH_BLOCK])};
    return pose;
}

static wh_batch_code_t fastest(void) {
#if WH_BATCH_HAS_AVX2
    if (__builtin_cpu_supports("avx2")) {
        return WH_BATCH_AVX2;
    }
#endif
    return WH_BATCH_PORTABLE;
}

wh_status_t wh_batch_init(wh_batch_t *batch, const wh_pose_t *base_from_wafers, size_t wafer_count,
                          wh_real_t *numbers, size_t number_count) {
    if (!batch || (wafer_count != 0 && (!base_from_wafers || !numbers))) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    /* the other way round, the product might not fit */
    if (wafer_count > INT32_MAX ||
        number_count / WH_BATCH_NUMBERS(1) < (wafer_count + WH_BATCH_BLOCK - 1) / WH_BATCH_BLOCK) {
        return WH_STATUS_BAD_CAPACITY;
    }
    batch->numbers = numbers;
    batch->wafer_count = wafer_count;
    batch->code = fastest();
    const size_t half = WH_BATCH_NUMBERS(wafer_count) / 2;
    for (size_t i = wafer_count / WH_BATCH_BLOCK * WH_BATCH_HALF; i < half; ++i) {
        numbers[i] = (wh_real_t)NAN;
        numbers[half + i] = (wh_real_t)NAN;
    }
    for (size_t w = 0; w < wafer_count; ++w) {
        put_pose(batch, w, &base_from_wafers[w]);
    }
    return WH_OK;
}

wh_status_t wh_batch_use(wh_batch_t *batch, wh_batch_code_t code) {
    if (!batch) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if ((unsigned)code > (unsigned)fastest()) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    batch->code = code;
    return WH_OK;
}

wh_status_t wh_batch_place(wh_batch_t *batch, size_t wafer, const wh_pose_t *base_from_wafer) {
    if (!batch || !base_from_wafer) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (wafer >= batch->wafer_count) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    put_pose(batch, wafer, base_from_wafer);
    return WH_OK;
}

wh_status_t wh_batch_wafer(const wh_batch_t *batch, size_t wafer, wh_pose_t *base_from_wafer) {
    if (!batch || !base_from_wafer) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (wafer >= batch->wafer_count) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    *base_from_wafer = get_pose(batch, wafer);
    return WH_OK;
}
