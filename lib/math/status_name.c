/* This is a separate file, because a linker keeps or drops all strings of a file together. */
#include "status.h"

static const struct {
    wh_status_t number;
    const char *name;
} names[] = {
#define WH_STATUS(number, name, text) {WH_STATUS_##name, #name},
#include "status.def"
#undef WH_STATUS
};

const char *wh_status_name(wh_status_t status) {
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        if (names[i].number == status) {
            return names[i].name;
        }
    }
    return "UNKNOWN";
}
