/* The name that a user may have meant, for messages about an unknown word. */
#ifndef WH_TEXT_NEAREST_H
#define WH_TEXT_NEAREST_H

#include <stddef.h>

/* Words and names of more bytes are near to no name. */
#define WH_NEAREST_BYTES 63

/* The one of `count` names that needs the fewest slips of the keyboard to become the word. A slip is a byte
 * left out, inserted or replaced, or two neighbours in the wrong order. Capital letters count as small
 * letters. More than one slip for every three bytes of the longer one is too many, but one is always near,
 * unless nothing of the word remains. If several names are equally near, the first is returned. Returns
 * null if none is near. The result is one of the pointers in `names`. Cost: for each name the product of
 * both lengths. */
const char *wh_text_nearest(const char *word, const char *const *names, size_t count);

/* Room for the text of wh_text_did_you_mean, including `before` and `mark` of a few bytes. */
#define WH_NEAREST_TEXT 96

/* Writes this: "; did you mean run?" if `before` is "; " and the name has no mark. An option's mark is its
 * dashes. It is "" if no name is near. Returns the text. */
const char *wh_text_did_you_mean(char text[WH_NEAREST_TEXT], const char *before, const char *mark,
                                 const char *nearest);

#endif
