/* What stl.c and stl_facets.c share. */
#ifndef WH_LAYOUT_STL_INTERNAL_H
#define WH_LAYOUT_STL_INTERNAL_H

#include "stl.h"

typedef struct {
    const char *path;
    const char *at, *end; /* of what is still to be read */
    const char *begin;
    unsigned line;
    wh_real_t mm_per_unit;
    wh_vec3_t *corners; /* three a facet, room for WH_STL_FACETS */
    size_t facets;
    char *message;
    size_t message_size;
} wh_stl_t;

/* Writes "path" and the rest, and returns false. */
bool wh_stl_refuse(wh_stl_t *stl, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Reads the facets of either format. */
bool wh_stl_read_facets(wh_stl_t *stl);

#endif
