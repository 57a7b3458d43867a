#include "stl.h"

#include <endian.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../text/array.h"
#include "../text/output.h"

/* The rounding of a file's numbers, relative to the largest: seven digits, or a single float. */
static const wh_real_t file_digits = 1e-6;
enum { HEAD = 80, COUNT = 4, FACET = 50, NORMAL = 12, WORD = 64 };

typedef struct {
    const char *path;
    const char *at, *end; /* the rest, which is still to be read */
    const char *begin;
    unsigned line;
    wh_real_t mm_per_unit;
    bool any_body;      /* it need not be convex */
    wh_vec3_t *corners; /* three for each facet, room for as many facets as the file can have */
    size_t facets;
    char *message;
    size_t message_size;
} stl_t;

/* Writes the path and the formatted text into the message, and returns false. */
__attribute__((format(printf, 2, 3))) static bool refuse(stl_t *stl, const char *format, ...) {
    const int length = snprintf(stl->message, stl->message_size, "%s", stl->path);
    if (length >= 0 && (size_t)length < stl->message_size) {
        va_list arguments;
        va_start(arguments, format);
        (void)vsnprintf(stl->message + length, stl->message_size - (size_t)length, format, arguments);
        va_end(arguments);
    }
    return false;
}

/* Adds one corner. `where` is its place in the file, for the message. */
static bool take_corner(stl_t *stl, const double xyz[3], size_t corner, const char *where) {
    const double scaled[3] = {xyz[0] * stl->mm_per_unit, xyz[1] * stl->mm_per_unit,
                              xyz[2] * stl->mm_per_unit};
    for (size_t i = 0; i < 3; ++i) {
        if (!(scaled[i] >= -WH_CONVEX_LARGEST && scaled[i] <= WH_CONVEX_LARGEST)) {
            return refuse(stl, "%s: a coordinate of %g times %g mm (expected -%g to %g mm)", where, xyz[i],
                          stl->mm_per_unit, WH_CONVEX_LARGEST, WH_CONVEX_LARGEST);
        }
    }
    stl->corners[3 * stl->facets + corner] = wh_vec3(scaled[0], scaled[1], scaled[2]);
    return true;
}

static bool too_many(stl_t *stl) {
    return refuse(stl, ": more than %d facets", WH_STL_FACETS);
}

/* ------------------------------------------------------------------------------------------------- binary */

static uint32_t little_endian(const char *bytes) {
    uint32_t value;
    memcpy(&value, bytes, sizeof value);
    return le32toh(value);
}

static double single(const char *bytes) {
    const uint32_t bits = little_endian(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

static bool read_binary(stl_t *stl) {
    const uint32_t count = little_endian(stl->begin + HEAD);
    for (stl->at = stl->begin + HEAD + COUNT; stl->facets < count; ++stl->facets, stl->at += FACET) {
        for (size_t corner = 0; corner < 3; ++corner) {
            const char *bytes = stl->at + NORMAL + 12 * corner;
            const double xyz[3] = {single(bytes), single(bytes + 4), single(bytes + 8)};
            char where[WORD];
            (void)snprintf(where, sizeof where, ": byte %zu", (size_t)(bytes - stl->begin));
            if (!take_corner(stl, xyz, corner, where)) {
                return false;
            }
        }
    }
    return true;
}

/* -------------------------------------------------------------------------------------------------- ASCII */

static bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* Reads the next word, cut if it is long, with every unprintable byte as '?'; empty at the end. stl->line is
 * its line. */
static void next_word(stl_t *stl, char word[WORD]) {
    for (; stl->at < stl->end && is_space(*stl->at); ++stl->at) {
        stl->line += *stl->at == '\n';
    }
    size_t length = 0;
    for (; stl->at < stl->end && !is_space(*stl->at); ++stl->at) {
        if (length < WORD - 1) {
            word[length++] = *stl->at;
            if (*stl->at < ' ' || *stl->at > '~') {
                word[length - 1] = '?';
            }
        }
    }
    word[length] = '\0';
}

static void skip_line(stl_t *stl) {
    while (stl->at < stl->end && *stl->at != '\n') {
        ++stl->at;
    }
}

static bool refuse_word(stl_t *stl, const char *word, const char *expected) {
    if (word[0] == '\0') {
        return refuse(stl, ":%u: the file ends (expected %s)", stl->line, expected);
    }
    return refuse(stl, ":%u: \"%s\" (expected %s)", stl->line, word, expected);
}

static bool read_number(stl_t *stl, double *number) {
    char word[WORD];
    next_word(stl, word);
    char *behind = word;
    *number = strtod(word, &behind);
    return (behind != word && *behind == '\0' && *number - *number == 0) ||
           refuse_word(stl, word, "a number");
}

static bool read_corner(stl_t *stl, size_t corner) {
    double xyz[3];
    char where[WORD];
    for (size_t i = 0; i < 3; ++i) {
        if (!read_number(stl, &xyz[i])) {
            return false;
        }
    }
    (void)snprintf(where, sizeof where, ":%u", stl->line);
    return take_corner(stl, xyz, corner, where);
}

/* Reads what follows the word `facet`. The normal may be anything: some programs write none. */
static bool read_facet(stl_t *stl) {
    static const char *const words[] = {"normal", "",       "",       "",        "outer",   "loop",
                                        "vertex", "vertex", "vertex", "endloop", "endfacet"};
    size_t corner = 0;
    bool good = true;
    for (size_t i = 0; good && i < sizeof words / sizeof words[0]; ++i) {
        char word[WORD];
        next_word(stl, word);
        good = words[i][0] == '\0' || strcasecmp(word, words[i]) == 0 || refuse_word(stl, word, words[i]);
        if (good && words[i][0] == 'v') {
            good = read_corner(stl, corner++);
        }
    }
    return good;
}

static bool read_text(stl_t *stl) {
    char word[WORD];
    stl->line = 1;
    next_word(stl, word);
    skip_line(stl);
    for (next_word(stl, word); strcasecmp(word, "facet") == 0; next_word(stl, word)) {
        if (stl->facets == WH_STL_FACETS) {
            return too_many(stl);
        }
        if (!read_facet(stl)) {
            return false;
        }
        ++stl->facets;
    }
    if (strcasecmp(word, "endsolid") != 0) {
        return refuse_word(stl, word, "facet or endsolid");
    }
    skip_line(stl);
    next_word(stl, word);
    return word[0] == '\0' || refuse_word(stl, word, "the end of the file: one solid");
}

/* Binary files may begin with `solid` too, but only a binary file has the length that its count asks for. */
static bool read_facets(stl_t *stl) {
    const size_t length = (size_t)(stl->end - stl->begin);
    if (length >= HEAD + COUNT) {
        const uint32_t count = little_endian(stl->begin + HEAD);
        if (length == HEAD + COUNT + FACET * (size_t)count) {
            return count <= WH_STL_FACETS ? read_binary(stl) : too_many(stl);
        }
    }
    char word[WORD];
    next_word(stl, word);
    stl->at = stl->begin;
    if (strcasecmp(word, "solid") == 0) {
        return read_text(stl);
    }
    return refuse(stl,
                  ": %zu bytes (expected the word solid, or 80 bytes, a count of facets, and 50 bytes for "
                  "each)",
                  length);
}

/* --------------------------------------------------------------------------------------------- the points */

static int compare_numbers(wh_real_t a, wh_real_t b) {
    return (a > b) - (a < b);
}

static int compare(const void *left, const void *right) {
    const wh_vec3_t *a = left;
    const wh_vec3_t *b = right;
    int order = compare_numbers(a->x, b->x);
    order = order != 0 ? order : compare_numbers(a->y, b->y);
    return order != 0 ? order : compare_numbers(a->z, b->z);
}

/* The different corners, sorted, in memory of their own. */
static wh_vec3_t *different(const wh_vec3_t *corners, size_t corner_count, size_t *count) {
    wh_vec3_t *points = wh_array_new(corner_count, sizeof *points);
    memcpy(points, corners, corner_count * sizeof *points);
    qsort(points, corner_count, sizeof *points, compare);
    *count = 0;
    for (size_t i = 0; i < corner_count; ++i) {
        if (*count == 0 || compare(&points[*count - 1], &points[i]) != 0) {
            points[(*count)++] = points[i];
        }
    }
    return points;
}

/* The longest edge of the box around the points, and their largest coordinate. */
typedef struct {
    wh_real_t size, coordinate;
} extent_t;

static wh_real_t largest(wh_real_t a, wh_real_t b, wh_real_t c) {
    return wh_real_max(a, wh_real_max(b, c));
}

static extent_t extent_of(const wh_vec3_t *points, size_t count) {
    const wh_convex_t mesh = {.kind = WH_CONVEX_MESH, .points = points, .point_count = count};
    const wh_pose_t here = wh_pose_identity();
    wh_vec3_t low;
    wh_vec3_t high;
    wh_convex_bounds(&mesh, &here, &low, &high);
    const wh_vec3_t edge = wh_vec3_subtract(&high, &low);
    return (extent_t){largest(edge.x, edge.y, edge.z),
                      wh_real_max(largest(-low.x, -low.y, -low.z), largest(high.x, high.y, high.z))};
}

/* The unit normal of a facet. Returns the facet's height on its longest edge; 0 if it has no normal. */
static wh_real_t normal_of(const wh_vec3_t *corners, wh_vec3_t *normal) {
    const wh_vec3_t ab = wh_vec3_subtract(&corners[1], &corners[0]);
    const wh_vec3_t ac = wh_vec3_subtract(&corners[2], &corners[0]);
    const wh_vec3_t bc = wh_vec3_subtract(&corners[2], &corners[1]);
    *normal = wh_vec3_cross(&ab, &ac);
    const wh_real_t area = wh_vec3_norm(normal);
    if (!(area > 0)) {
        return 0;
    }
    *normal = wh_vec3_scale(1 / area, normal);
    return area / largest(wh_vec3_norm(&ab), wh_vec3_norm(&ac), wh_vec3_norm(&bc));
}

/* Refuses a body that has corners on both sides of a facet's plane. The thinner the facet, the more the
 * rounding of the file's numbers turns its plane. A facet whose plane may be turned too far says nothing. */
static bool check_facet(stl_t *stl, size_t facet, const wh_vec3_t *points, size_t count, extent_t extent) {
    const wh_vec3_t *corners = &stl->corners[3 * facet];
    wh_vec3_t normal;
    const wh_real_t height = normal_of(corners, &normal);
    if (!(height > 10 * file_digits * extent.coordinate)) {
        return true;
    }
    const wh_real_t flat = (WH_STL_FLAT + file_digits * extent.coordinate / height) * extent.size;
    wh_real_t before = 0;
    wh_real_t behind = 0;
    for (size_t i = 0; i < count; ++i) {
        const wh_vec3_t from = wh_vec3_subtract(&points[i], &corners[0]);
        before = wh_real_max(before, wh_vec3_dot(&from, &normal));
        behind = wh_real_max(behind, -wh_vec3_dot(&from, &normal));
    }
    if (before > flat && behind > flat) {
        return refuse(
            stl,
            ": facet %zu has corners %g and %g mm off its plane, on either side (expected a convex body)",
            facet + 1, before, behind);
    }
    return true;
}

static bool check_points(stl_t *stl, const wh_vec3_t *points, size_t count) {
    if (!stl->any_body && count > WH_STL_POINTS) {
        return refuse(stl, ": %zu different corners (expected at most %d)", count, WH_STL_POINTS);
    }
    const wh_convex_t mesh = {.kind = WH_CONVEX_MESH,
                              .points = points,
                              .point_count = count,
                              .body_from_shape = wh_pose_identity()};
    if (wh_convex_validate(&mesh) != WH_OK) {
        return refuse(stl, ": %zu facets with %zu different corners (expected a body, at least %g mm thick)",
                      stl->facets, count, WH_CONVEX_THINNEST);
    }
    const extent_t extent = extent_of(points, count);
    for (size_t facet = 0; !stl->any_body && facet < stl->facets; ++facet) {
        if (!check_facet(stl, facet, points, count, extent)) {
            return false;
        }
    }
    return true;
}

/* ----------------------------------------------------------------------------------------------- the file */

/* Reads the text or bytes that the rest of `stl` says how to take. */
static bool parse(stl_t *stl, const char *bytes, size_t length, wh_vec3_t **points, size_t *count) {
    stl->at = stl->begin = bytes;
    stl->end = bytes + length;
    stl->line = 1;
    if (!(stl->mm_per_unit > 0 && wh_real_is_finite(stl->mm_per_unit))) {
        return refuse(stl, ": %g mm a unit (expected a positive number)", stl->mm_per_unit);
    }
    if (length > WH_STL_BYTES) {
        return refuse(stl, ": more than %zu bytes", WH_STL_BYTES);
    }
    const size_t most = length / FACET + 1; /* no facet is shorter, as text neither */
    stl->corners =
        wh_array_new(3 * (most < WH_STL_FACETS ? most : (size_t)WH_STL_FACETS), sizeof *stl->corners);
    bool good = read_facets(stl);
    if (good) {
        size_t found = 0;
        wh_vec3_t *mine = different(stl->corners, 3 * stl->facets, &found);
        good = check_points(stl, mine, found);
        if (good) {
            *points = mine;
            *count = found;
        } else {
            free(mine);
        }
    }
    free(stl->corners);
    return good;
}

bool wh_stl_parse(const char *path, const char *bytes, size_t length, wh_real_t mm_per_unit,
                  wh_vec3_t **points, size_t *count, char *message, size_t size) {
    stl_t stl = {.path = path, .mm_per_unit = mm_per_unit, .message = message, .message_size = size};
    return parse(&stl, bytes, length, points, count);
}

/* Opens a regular file. It does not wait for the other end of a pipe. Null: the message says why. `most` is
 * set to the bytes to read: one more than the file has, or than are taken. */
static FILE *open_regular(stl_t *stl, size_t *most) {
    struct stat status;
    const int fd = open(stl->path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) {
        (void)refuse(stl, ": %s", strerror(errno));
        return NULL;
    }
    if (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
        (void)refuse(stl, ": it is no regular file");
        (void)close(fd);
        return NULL;
    }
    *most = (status.st_size < (off_t)WH_STL_BYTES ? (size_t)status.st_size : WH_STL_BYTES) + 1;
    return wh_memory_need(fdopen(fd, "rb"));
}

static bool read_file(stl_t *stl, wh_vec3_t **points, size_t *count) {
    wh_output_note_input(stl->path);
    size_t most = 0;
    FILE *file = open_regular(stl, &most);
    if (file == NULL) {
        return false;
    }
    wh_output_keep(stl->path);
    char *bytes = wh_array_new(most, 1);
    const size_t length = fread(bytes, 1, most, file);
    const bool good =
        ferror(file) != 0 ? refuse(stl, ": %s", strerror(errno)) : parse(stl, bytes, length, points, count);
    free(bytes);
    (void)fclose(file);
    return good;
}

bool wh_stl_read(const char *path, wh_real_t mm_per_unit, wh_vec3_t **points, size_t *count, char *message,
                 size_t size) {
    stl_t stl = {.path = path, .mm_per_unit = mm_per_unit, .message = message, .message_size = size};
    return read_file(&stl, points, count);
}

bool wh_stl_read_body(const char *path, wh_real_t mm_per_unit, wh_vec3_t **points, size_t *count,
                      char *message, size_t size) {
    stl_t stl = {
        .path = path, .mm_per_unit = mm_per_unit, .any_body = true, .message = message, .message_size = size};
    return read_file(&stl, points, count);
}
