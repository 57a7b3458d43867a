/* The name that somebody may have meant: for messages about a word that is no name of its kind. */
#ifndef WH_TEXT_NEAREST_H
#define WH_TEXT_NEAREST_H

#include <stddef.h>

/* Words and names of more bytes are near to nothing. */
#define WH_NEAREST_BYTES 63

/* The one of `count` names that the fewest slips of the keyboard turn into the word: a byte left out, put in
 * or replaced, or two neighbours in the wrong order. Capital letters count as small ones. More than one slip
 * for every three bytes of the longer one is too many, but one is always near, unless nothing of the word is
 * left. If several names are as near, the first is returned. Null where nothing is near. The result is one of
 * the pointers in `names`.
 * Cost: for each name the product of both lengths. */
const char *wh_text_nearest(const char *word, const char *const *names, size_t count);

/* Room for what wh_text_did_you_mean writes, before and mark of a few bytes included. */
#define WH_NEAREST_TEXT 96

/* Says so: "; did you mean run?" where `before` is "; " and nothing marks the name. An option's mark is its
 * dashes. "" if nothing is near. Returns the text. */
const char *wh_text_did_you_mean(char text[WH_NEAREST_TEXT], const char *before, const char *mark,
                                 const char *nearest);

#endif
