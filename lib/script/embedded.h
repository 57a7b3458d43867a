/* Files built into the program by lib/build/embed: motion control's Lua files, compiled, and the page of a
 * report. */
#ifndef WH_SCRIPT_EMBEDDED_H
#define WH_SCRIPT_EMBEDDED_H

#include <stddef.h>

typedef struct {
    const char *name;          /* path below its folder, such as "mcs/patterns.lua" */
    const unsigned char *text; /* `size` bytes, and a zero after them */
    size_t size;
} wh_embedded_t;

/* Sorted by name. */
extern const wh_embedded_t wh_embedded[];
extern const size_t wh_embedded_count;

/* The files of lib/report/page. */
extern const wh_embedded_t wh_embedded_page[];
extern const size_t wh_embedded_page_count;

#endif
