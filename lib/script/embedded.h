/* The Lua files below lua/, built into the program: made by lib/packaging/embed. */
#ifndef WH_SCRIPT_EMBEDDED_H
#define WH_SCRIPT_EMBEDDED_H

#include <stddef.h>

typedef struct {
    const char *name;          /* the path below lua/, such as "mcs/patterns.lua" */
    const unsigned char *text; /* `size` bytes, and a zero after them */
    size_t size;
} wh_embedded_t;

/* Sorted by name. */
extern const wh_embedded_t wh_embedded[];
extern const size_t wh_embedded_count;

#endif
