/* Within --segments: the parts of a file in C. */
#ifndef WH_PRINT_SEGMENTS_INTERNAL_H
#define WH_PRINT_SEGMENTS_INTERNAL_H

#include "segments.h"

/* Room for a prefix: a file's name. */
#define WH_SEGMENTS_PREFIX 256

/* The state of writing. */
typedef struct {
    FILE *out;
    const wh_segments_t *of;
    char prefix[WH_SEGMENTS_PREFIX], upper[WH_SEGMENTS_PREFIX];
    char **lines; /* of the script; none if it cannot be read again */
    size_t line_count, line_capacity;
    bool *is_told; /* by command: its line was written */
} wh_segments_writer_t;

/* With a point or an exponent: a whole number would be of another type. */
void wh_segments_put_real(FILE *out, double value);

/* Numbers in braces. C99 has no empty braces: at least one, 0, is written. */
void wh_segments_put_reals(FILE *out, const wh_real_t values[], size_t count);
void wh_segments_put_doubles(FILE *out, const double values[], size_t count);

void wh_segments_put_vector(FILE *out, const wh_vec3_t *v);
void wh_segments_put_tolerance(FILE *out, const wh_tolerance_t *tolerance);
void wh_segments_put_pose(FILE *out, const wh_pose_t *pose);
void wh_segments_put_limits(FILE *out, const wh_limits_t *limits);
void wh_segments_put_travel(FILE *out, const wh_travel_t *travel);
void wh_segments_put_bool(FILE *out, bool value);
void wh_segments_put_fault(FILE *out, const wh_fault_t *fault);

/* An array with each item on lines of its own; without items nothing. */
void wh_segments_put_array(const wh_segments_writer_t *writer, const char *type, const char *name,
                           size_t count, void (*put)(const wh_segments_writer_t *writer, size_t i));

/* ", NAME_ARRAY, COUNT" of an array that was written, or ", NULL, 0". */
void wh_segments_put_reference(const wh_segments_writer_t *writer, const char *name, size_t count);

/* Robots, doors, the machine, stations and wafers. */
void wh_segments_put_cell(const wh_segments_writer_t *writer);

/* Rims, edge sensors, beams and grips, and orders; then the member `parts` of the run. */
void wh_segments_put_parts(const wh_segments_writer_t *writer);
void wh_segments_put_parts_member(const wh_segments_writer_t *writer);

#endif
