/* Numbers among the arguments: what is one, and whether it is within its range. Who asks says what was expected. */
#ifndef WH_TEXT_NUMBER_H
#define WH_TEXT_NUMBER_H

#include <stdbool.h>
#include <stdint.h>

/* A number from min to max and nothing else, such as 1000000 or 1e6; `value` gets whatever number the text begins with. */
bool wh_number_read(const char *text, double min, double max, double *value);

/* A whole number in decimal digits and nothing else, of all 64 bits, which a double has not; `value` likewise. */
bool wh_number_read_whole(const char *text, uint64_t *value);

#endif
