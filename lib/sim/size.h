/* The sizes of the library's structs, by their names: for callers that are not C, which take sizes and
 * offsets from interface.json beside the installed library, and ask here whether it is of this build. */
#ifndef WH_SIM_SIZE_H
#define WH_SIM_SIZE_H

#include "../math/config.h"

WH_HEADER_BEGIN

/* The bytes of the struct with this name, such as "wh_grasp_t". 0: there is none of this name in the public
 * headers, or it is null. Cost: linear in the structs, about 140. */
size_t wh_size(const char *name) WH_SYMBOL(wh_size);

WH_HEADER_END

#endif
