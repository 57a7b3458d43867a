#include "config.h"

/* See WH_ABI_SYMBOL in config.h. */
const char WH_ABI_SYMBOL = 1;
