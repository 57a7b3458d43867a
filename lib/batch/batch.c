#include "batch_internal.h"

static void put(float *numbers, const wh_vec3_t *v) {
    numbers[0] = (float)v->x;
    numbers[WH_BATCH_LANES] = (float)v->y;
    numbers[2 * WH_BATCH_LANES] = (float)v->z;
}

static size_t smaller(size_t a, size_t b) {
    return a < b ? a : b;
}

/* A sphere about the mean of the wafers' origins. It is too large by a hundred-thousandth, which covers the
 * rounding to float. */
static void put_sphere(float *sphere, const wh_pose_t *wafers, size_t count) {
    wh_vec3_t sum = {0, 0, 0};
    for (size_t i = 0; i < count; ++i) {
        sum = wh_vec3_add(&sum, &wafers[i].r);
    }
    const wh_vec3_t centre = wh_vec3_scale(1 / (wh_real_t)count, &sum);
    wh_real_t farthest = 0;
    for (size_t i = 0; i < count; ++i) {
        const wh_vec3_t d = wh_vec3_subtract(&wafers[i].r, &centre);
        const wh_real_t distance = wh_vec3_norm(&d);
        farthest = farthest < distance ? distance : farthest;
    }
    put(sphere, &centre);
    sphere[3 * WH_BATCH_LANES] = (float)(farthest * WH_REAL(1.00001));
}

/* Writes the numbers of a block of wafers. A wafer that cannot be sieved gets NaN, which leaves it to the
 * full check. */
static void put_block(const wh_batch_t *batch, size_t block) {
    const size_t first = block * WH_BATCH_LANES;
    const size_t count = smaller(batch->wafer_count - first, WH_BATCH_LANES);
    const wh_vec3_t unknown = wh_vec3((wh_real_t)NAN, (wh_real_t)NAN, (wh_real_t)NAN);
    const wh_pose_t *wafers = &batch->base_from_wafers[first];
    float *sphere = &batch->numbers[block / WH_BATCH_LANES * WH_BATCH_SPHERES + block % WH_BATCH_LANES];
    float *origins = &batch->numbers[wh_batch_origins(batch->wafer_count) + block * WH_BATCH_BLOCK];
    float *normals = &batch->numbers[wh_batch_normals(batch->wafer_count) + block * WH_BATCH_BLOCK];
    bool whole = true;
    for (size_t i = 0; i < count; ++i) {
        const wh_vec3_t n1 = wh_mat3_column(&wafers[i].R, 2);
        const bool fits = wh_pose_validate(&wafers[i]) == WH_OK && wh_batch_fits(&wafers[i].r);
        put(&origins[i], fits ? &wafers[i].r : &unknown);
        put(&normals[i], fits ? &n1 : &unknown);
        whole = whole && fits;
    }
    if (whole) {
        put_sphere(sphere, wafers, count);
    } else {
        put(sphere, &unknown);
    }
}

static wh_batch_code_t fastest(void) {
#if WH_BATCH_HAS_AVX2
    if (__builtin_cpu_supports("avx2")) {
        return WH_BATCH_AVX2;
    }
#endif
    return WH_BATCH_PORTABLE;
}

wh_status_t wh_batch_init(wh_batch_t *batch, wh_pose_t *base_from_wafers, size_t wafer_count, float *numbers,
                          size_t number_count) {
    if (!batch || (wafer_count != 0 && (!base_from_wafers || !numbers))) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    /* It divides, because the product might not fit. */
    if (wafer_count > INT32_MAX || number_count / 64 < WH_BATCH_LINES(wafer_count)) {
        return WH_STATUS_BAD_CAPACITY;
    }
    const wh_extent_t poses = {base_from_wafers, wafer_count * sizeof *base_from_wafers};
    const wh_extent_t room = {numbers, WH_BATCH_NUMBERS(wafer_count) * sizeof *numbers};
    if (wh_extents_overlap(poses, room)) {
        return WH_STATUS_OVERLAP;
    }
    batch->base_from_wafers = base_from_wafers;
    batch->numbers = numbers;
    batch->wafer_count = wafer_count;
    batch->code = fastest();
    for (size_t i = 0; i < WH_BATCH_NUMBERS(wafer_count); ++i) {
        numbers[i] = (float)INFINITY;
    }
    for (size_t b = 0; b < WH_BATCH_WORDS(wafer_count); ++b) {
        put_block(batch, b);
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
    batch->base_from_wafers[wafer] = *base_from_wafer;
    put_block(batch, wafer / WH_BATCH_LANES);
    return WH_OK;
}
