/* The functions that stand in headers; WP proves them here once. */
#include "grasp/encounter_internal.h"
#include "grasp/grasp_internal.h"
#include "grasp/horizon_internal.h"
#include "math/hash.h"
