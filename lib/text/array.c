#include "array.h"

#include <stdlib.h>

void *wh_array_reserve(void *items, size_t needed, size_t *capacity, size_t size) {
    if (needed <= *capacity) {
        return items;
    }
    const size_t doubled = *capacity > 0 ? 2 * *capacity : 64;
    *capacity = needed > doubled ? needed : doubled;
    void *const grown = realloc(items, *capacity * size);
    if (!grown) {
        abort();
    }
    return grown;
}

void *wh_array_grow(void *items, size_t count, size_t *capacity, size_t size) {
    return wh_array_reserve(items, count + 1, capacity, size);
}

void *wh_array_new(size_t count, size_t size) {
    void *const items = calloc(count + 1, size);
    if (!items) {
        abort();
    }
    return items;
}
