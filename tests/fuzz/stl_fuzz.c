/* Any bytes as an STL file: either one line gives the reason for refusing it and nothing is handed
 * out, or the points form a body, sorted, without duplicates. */
#include <stdlib.h>
#include <string.h>

#include "bodies/stl.h"
#include "fuzz.h"

static bool is_before(const wh_vec3_t *a, const wh_vec3_t *b) {
    if (a->x != b->x) {
        return a->x < b->x;
    }
    return a->y != b->y ? a->y < b->y : a->z < b->z;
}

static void check_body(const wh_vec3_t *points, size_t count) {
    const wh_convex_t mesh = {.kind = WH_CONVEX_MESH,
                              .points = points,
                              .point_count = count,
                              .body_from_shape = wh_pose_identity()};
    REQUIRE(count >= 4 && count <= WH_STL_POINTS);
    REQUIRE(wh_convex_validate(&mesh) == WH_OK);
    for (size_t i = 1; i < count; ++i) {
        REQUIRE(is_before(&points[i - 1], &points[i]));
    }
}

static bool is_line(const char *message) {
    for (; *message >= ' ' && *message <= '~'; ++message) {
    }
    return *message == '\0';
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    wh_vec3_t *points = NULL;
    size_t count = 0;
    char message[200] = "";
    if (wh_stl_parse("f.stl", (const char *)data, size, 25.4, &points, &count, message, sizeof message)) {
        check_body(points, count);
        REQUIRE(message[0] == '\0');
        free(points);
    } else {
        REQUIRE(points == NULL && count == 0);
        REQUIRE(strncmp(message, "f.stl:", 6) == 0 && is_line(message));
    }
    return 0;
}
