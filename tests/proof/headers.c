/* The functions that stand in headers, for WP to prove once. */
#include "core/hash.h"
