#include "array.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void wh_memory_out(void) {
    fputs("waferhand: out of memory\n", stderr);
    exit(2);
}

void *wh_memory_need(void *made) {
    if (!made) {
        wh_memory_out();
    }
    return made;
}

char *wh_text_copy(const char *text) {
    return wh_memory_need(strdup(text));
}

void wh_text_words(char *to, size_t size, const char *name) {
    (void)snprintf(to, size, "%s", name);
    for (char *c = strchr(to, '_'); c; c = strchr(c, '_')) {
        *c = ' ';
    }
}

void *wh_array_reserve(void *items, size_t needed, size_t *capacity, size_t size) {
    if (needed <= *capacity) {
        return items;
    }
    const size_t doubled = *capacity > 0 ? 2 * *capacity : 64;
    *capacity = needed > doubled ? needed : doubled;
    return wh_memory_need(realloc(items, *capacity * size));
}

void *wh_array_grow(void *items, size_t count, size_t *capacity, size_t size) {
    return wh_array_reserve(items, count + 1, capacity, size);
}

void *wh_array_new(size_t count, size_t size) {
    /* For no items some systems allocate nothing. It allocates no more items than asked for; otherwise
     * sanitizers would not detect the use of one too many. */
    return wh_memory_need(calloc(count > 0 ? count : 1, size));
}
