#include "waferhand/waferhand_collision.h"
