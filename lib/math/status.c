#include "status.h"

/* The texts of the library alone: a firmware links no text that no function of the library returns. */
static const struct {
    wh_status_t number;
    const char *text;
} texts[] = {
#define WH_STATUS_OF_LIBRARY
#define WH_STATUS(number, name, text) {WH_STATUS_##name, text},
#include "status.def"
#undef WH_STATUS
#undef WH_STATUS_OF_LIBRARY
};

const char *wh_status_text(wh_status_t status) {
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; ++i) {
        if (texts[i].number == status) {
            return texts[i].text;
        }
    }
    return "unknown status";
}
