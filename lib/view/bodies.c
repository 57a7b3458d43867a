/* Bodies and their shapes in a LOAD message. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../link/messages.h"
#include "../text/array.h"
#include "../text/utf8.h"
#include "cell_internal.h"

/* Each byte of a name becomes three at most. */
#define WRITTEN_SIZE (3 * WH_NAME_SIZE)

/* How many bytes may stay as they are at `text`: none that the viewer would take for part of a path, or could not read. */
static size_t plain_bytes(const char *text) {
    const unsigned char first = (unsigned char)*text;
    if (first < ' ' || first == 0x7f || first == '/' || first == ':' || first == '%') {
        return 0;
    }
    return wh_utf8_bytes(text);
}

/* Two names never become the same. */
static void write_name(const char *name, char written[WRITTEN_SIZE]) {
    static const char digits[] = "0123456789ABCDEF";
    char *to = written;
    while (*name != '\0') {
        const size_t plain = plain_bytes(name);
        if (plain > 0) {
            memcpy(to, name, plain);
            to += plain;
            name += plain;
        } else {
            *to++ = '%';
            *to++ = digits[(unsigned char)*name >> 4U];
            *to++ = digits[(unsigned char)*name & 15U];
            ++name;
        }
    }
    *to = '\0';
}

static char *path_of(const char *folder, const char *name) {
    char written[WRITTEN_SIZE] = "";
    if (name) {
        write_name(name, written);
    }
    const size_t size = strlen(folder) + strlen(written) + 3;
    char *path = wh_array_new(size, 1);
    (void)snprintf(path, size, "%s%s%s", folder, name ? "::" : "", written);
    return path;
}

size_t wh_view_add_body(wh_view_cell_t *cell, const char *folder, const char *name) {
    const waferhand_viewer_link body = {.name = path_of(folder, name)};
    cell->load.link =
        wh_array_grow(cell->load.link, (size_t)cell->load.num_links, &cell->capacity, sizeof body);
    cell->load.link[cell->load.num_links] = body;
    return (size_t)cell->load.num_links++;
}

void wh_view_add_shape(wh_view_cell_t *cell, const wh_convex_t *convex, const wh_pose_t *body_from_shape,
                       const wh_view_colour_t *colour) {
    waferhand_viewer_link *body = &cell->load.link[cell->load.num_links - 1];
    /* The message's type has no place for a capacity: the array counts as full. */
    size_t capacity = (size_t)body->num_geom;
    body->geom = wh_array_grow(body->geom, capacity, &capacity, sizeof *body->geom);
    wh_view_geometry_make(convex, body_from_shape, colour, cell->detail >= WH_VIEW_BOXES,
                          &body->geom[body->num_geom++]);
}

static void free_body(waferhand_viewer_link *body) {
    for (int32_t i = 0; i < body->num_geom; ++i) {
        wh_view_geometry_free(&body->geom[i]);
    }
    free(body->geom);
    free(body->name);
}

void wh_view_cell_free(wh_view_cell_t *cell) {
    for (int32_t i = 0; i < cell->load.num_links; ++i) {
        free_body(&cell->load.link[i]);
    }
    free(cell->load.link);
    free(cell->draw.link_name);
    free(cell->draw.robot_num);
    free(cell->draw.position);
    free(cell->draw.quaternion);
    free(cell->places);
    memset(cell, 0, sizeof *cell);
}
