/* Arrays that grow as items are added, by doubling; and what host code does without memory: the program ends.
 *
 *     run->marks = wh_array_grow(run->marks, run->mark_count, &run->mark_capacity, sizeof *run->marks);
 *     run->marks[run->mark_count++] = slice;
 */
#ifndef WH_TEXT_ARRAY_H
#define WH_TEXT_ARRAY_H

#include <stddef.h>

/* Ends the program with status 2 and "waferhand: out of memory" on standard error. */
__attribute__((noreturn)) void wh_memory_out(void);

/* What malloc or its like returned; if that is null, the program ends so. */
void *wh_memory_need(void *made);

/* A copy of a text. Never null; the caller frees it. */
char *wh_text_copy(const char *text);

/* Copies a name such as near_miss into `size` bytes, as far as they go, with blanks for its underscores. */
void wh_text_words(char *to, size_t size, const char *name);

/* Makes room for at least `needed` items of `size` bytes. `items` is null at the beginning, `capacity` is
 * then 0. Returns where the items are now; the caller frees them. */
void *wh_array_reserve(void *items, size_t needed, size_t *capacity, size_t size);

/* Makes room for one item more than the `count` that are there. */
void *wh_array_grow(void *items, size_t count, size_t *capacity, size_t size);

/* `count` items, all zero, that need not grow. Never null; the caller frees them. */
void *wh_array_new(size_t count, size_t size);

#endif
