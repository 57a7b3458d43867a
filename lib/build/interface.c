/* The input of interface.awk, once it is preprocessed. */
#include "waferhand.h"
