/* Within the room: the line that says what is wrong, or missing. */
#ifndef WH_ESTIMATE_REASON_INTERNAL_HPP
#define WH_ESTIMATE_REASON_INTERNAL_HPP

#include "value.h"

namespace wh_estimate {

/* Appends to a reason, which keeps what fits. */
__attribute__((format(printf, 2, 3))) void tell(char reason[WH_ESTIMATE_REASON], const char *format, ...);

} // namespace wh_estimate

#endif
