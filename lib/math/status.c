#include "status.h"

static const struct {
    wh_status_t number;
    const char *name, *text;
} catalogue[] = {
#define WH_STATUS(number, name, text) {WH_STATUS_##name, #name, text},
#include "status.def"
#undef WH_STATUS
};

const char *wh_status_text(wh_status_t status) {
    for (size_t i = 0; i < sizeof catalogue / sizeof catalogue[0]; ++i) {
        if (catalogue[i].number == status) {
            return catalogue[i].text;
        }
    }
    return "unknown status";
}

const char *wh_status_name(wh_status_t status) {
    for (size_t i = 0; i < sizeof catalogue / sizeof catalogue[0]; ++i) {
        if (catalogue[i].number == status) {
            return catalogue[i].name;
        }
    }
    return "UNKNOWN";
}
