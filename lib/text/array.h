/* Arrays that grow by doubling as items are added. Without memory, host code ends the program.
 *
 *     run->marks = wh_array_grow(run->marks, run->mark_count, &run->mark_capacity, sizeof *run->marks);
 *     run->marks[run->mark_count++] = slice;
 */
#ifndef WH_TEXT_ARRAY_H
#define WH_TEXT_ARRAY_H

#include <stddef.h>

/* Ends the program with status 2 and "waferhand: out of memory" on standard error. */
__attribute__((noreturn)) void wh_memory_out(void);

/* Returns the result of malloc or a similar function; if it is null, the program ends as above. */
void *wh_memory_need(void *made);

/* A copy of a text. It is never null; the caller frees it. */
char *wh_text_copy(const char *text);

/* Copies a name such as near_miss into `size` bytes, cut if too long, with blanks for its underscores. */
void wh_text_words(char *to, size_t size, const char *name);

/* Makes room for at least `needed` items of `size` bytes. `items` is null at the beginning, `capacity` is
 * then 0. Returns the new place of the items; the caller frees them. */
void *wh_array_reserve(void *items, size_t needed, size_t *capacity, size_t size);

/* Makes room for one more item after `count`. */
void *wh_array_grow(void *items, size_t count, size_t *capacity, size_t size);

/* `count` items, all zero; the array does not need to grow. It is never null; the caller frees them. */
void *wh_array_new(size_t count, size_t size);

#endif
