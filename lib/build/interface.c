/* The input of interface.awk, once it is preprocessed. */
#include "waferhand.h"
#if defined(WH_INTERFACE_COLLISION)
#include "waferhand_collision.h"
#endif
