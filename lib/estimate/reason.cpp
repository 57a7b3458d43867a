#include "reason_internal.hpp"

#include <cstdarg>
#include <cstdio>
#include <cstring>

void wh_estimate::tell(char reason[WH_ESTIMATE_REASON], const char *format, ...) {
    const size_t length = std::strlen(reason);
    va_list arguments;
    va_start(arguments, format);
    (void)std::vsnprintf(reason + length, WH_ESTIMATE_REASON - length, format, arguments);
    va_end(arguments);
}
