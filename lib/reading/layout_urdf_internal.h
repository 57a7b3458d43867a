/* Shared by layout_urdf.c, which reads joints and tools, and layout_urdf_parts.c, which reads the links'
 * shapes. */
#ifndef WH_READING_LAYOUT_URDF_INTERNAL_H
#define WH_READING_LAYOUT_URDF_INTERNAL_H

#include "../bodies/urdf.h"
#include "layout_internal.h"

/* The state of reading a `urdf`, while the reader is at its robot. */
typedef struct {
    wh_reader_t *reader;
    wh_layout_t *layout;
    size_t first, count; /* the robot's axes among the machine's */
    char name[512];      /* of the file, as the layout has it */
    char path[1024];
    char lengths[2 * WH_NAME_SIZE]; /* the field that has the arm's lengths, such as "shapes.arm" */
    const wh_urdf_file_t *file;
    wh_urdf_map_t map;
} wh_reading_urdf_t;

/* The fields that name the end-effector of each arm. */
extern const char *const wh_reading_tool_fields[WH_URDF_ARMS];

/* Makes the parts of the robot's links. Refuses shapes that cannot be read, and links that no part of the
 * arm is. */
void wh_layout_make_urdf_parts(const wh_reading_urdf_t *urdf, const wh_urdf_findings_t *findings);

#endif
