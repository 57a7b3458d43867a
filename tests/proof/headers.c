/* The functions that stand in headers, for WP to prove once. */
#include "core/grasp_internal.h"
#include "core/hash.h"
#include "core/horizon_internal.h"
