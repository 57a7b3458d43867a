/* Numbers and small structs as C source. */
#include <ctype.h>
#include <inttypes.h>
#include <string.h>

#include "../text/digits.h"
#include "segments_internal.h"

void wh_segments_put_real(FILE *out, double value) {
    char text[WH_DIGITS];
    wh_digits(value, text);
    fprintf(out, "%s%s", text, strpbrk(text, ".en") ? "" : ".0");
}

void wh_segments_put_doubles(FILE *out, const double values[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        fputs(i > 0 ? ", " : "{", out);
        wh_segments_put_real(out, values[i]);
    }
    fputs(count > 0 ? "}" : "{0.0}", out);
}

void wh_segments_put_reals(FILE *out, const wh_real_t values[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        fputs(i > 0 ? ", " : "{", out);
        wh_segments_put_real(out, (double)values[i]);
    }
    fputs(count > 0 ? "}" : "{0.0}", out);
}

void wh_segments_put_vector(FILE *out, const wh_vec3_t *v) {
    wh_segments_put_reals(out, (const wh_real_t[]){v->x, v->y, v->z}, 3);
}

void wh_segments_put_tolerance(FILE *out, const wh_tolerance_t *tolerance) {
    wh_segments_put_reals(out, (const wh_real_t[]){tolerance->projz, tolerance->projxy, tolerance->planar},
                          3);
}

void wh_segments_put_pose(FILE *out, const wh_pose_t *pose) {
    for (size_t row = 0; row < 3; ++row) {
        fputs(row > 0 ? ", " : "{{{", out);
        wh_segments_put_reals(out, pose->R.m[row], 3);
    }
    fputs("}}, ", out);
    wh_segments_put_vector(out, &pose->r);
    fputs("}", out);
}

void wh_segments_put_limits(FILE *out, const wh_limits_t *limits) {
    wh_segments_put_reals(out, (const wh_real_t[]){limits->speed, limits->acceleration, limits->jerk}, 3);
}

void wh_segments_put_travel(FILE *out, const wh_travel_t *travel) {
    wh_segments_put_reals(out, (const wh_real_t[]){travel->min, travel->max}, 2);
}

void wh_segments_put_bool(FILE *out, bool value) {
    fputs(value ? "true" : "false", out);
}

static void put_time(FILE *out, int64_t slice) {
    if (slice == WH_FAULT_FOREVER) {
        fputs(", WH_FAULT_FOREVER", out);
    } else {
        fprintf(out, ", %" PRId64, slice);
    }
}

void wh_segments_put_fault(FILE *out, const wh_fault_t *fault) {
    fputs("{WH_FAULT_", out);
    for (const char *c = wh_fault_name(fault->kind); *c != '\0'; ++c) {
        fputc(toupper((unsigned char)*c), out);
    }
    fprintf(out, ", %" PRId32 ", %" PRId32 ", ", fault->target, fault->other);
    wh_segments_put_real(out, (double)fault->value);
    fputs(", ", out);
    wh_segments_put_pose(out, &fault->offset);
    put_time(out, fault->from);
    put_time(out, fault->until);
    fputs("}", out);
}

void wh_segments_put_array(const wh_segments_writer_t *writer, const char *type, const char *name,
                           size_t count, void (*put)(const wh_segments_writer_t *writer, size_t i)) {
    if (count == 0) {
        return;
    }
    fprintf(writer->out, "static const %s %s_%s[%zu] = {\n", type, writer->prefix, name, count);
    for (size_t i = 0; i < count; ++i) {
        put(writer, i);
        fputs(i + 1 < count ? ",\n" : "};\n\n", writer->out);
    }
}

void wh_segments_put_reference(const wh_segments_writer_t *writer, const char *name, size_t count) {
    if (count == 0) {
        fputs("NULL, 0", writer->out);
    } else {
        fprintf(writer->out, "%s_%s, %zu", writer->prefix, name, count);
    }
}
