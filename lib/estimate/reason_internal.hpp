/* Internal to the room: the line that gives the error, or the missing measurements. */
#ifndef WH_ESTIMATE_REASON_INTERNAL_HPP
#define WH_ESTIMATE_REASON_INTERNAL_HPP

#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "value.h"

namespace wh_estimate {

/* Appends to a reason, as far as there is room. */
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
