/* Within the room: the line that says what is wrong, or missing. */
#ifndef WH_ESTIMATE_REASON_INTERNAL_HPP
#define WH_ESTIMATE_REASON_INTERNAL_HPP

#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "value.h"

namespace wh_estimate {

/* Appends to a reason, which keeps what fits. */
void tell(char *reason, const char *format, ...) __attribute__((format(printf, 2, 3)));

inline void tell(char *reason, const char *format, ...) {
    const size_t length = std::strlen(reason);
    va_list arguments;
    va_start(arguments, format);
    (void)std::vsnprintf(reason + length, WH_ESTIMATE_REASON - length, format, arguments);
    va_end(arguments);
}

} // namespace wh_estimate

#endif
