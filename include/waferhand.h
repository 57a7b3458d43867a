#include "waferhand/waferhand.h"
