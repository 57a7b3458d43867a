/* Any bytes as outputs.txt: valves are set if and only if the parser reports the file as good, and
 * then to 0 or 1. A good file stays good, with the same valves, if the white space around the
 * values changes.
 *
 * The first byte chooses the count. */
#include <string.h>

#include "fuzz.h"
#include "link/outputs.h"

#define UNSET 7

static void check_valves(const wh_outputs_look_t *look, const int32_t *valves, size_t count) {
    for (size_t i = 0; i < WH_GRIPPERS + 1; ++i) {
        const bool set = look->finding == WH_OUTPUTS_GOOD && i < count;
        REQUIRE(set ? valves[i] == WH_VALVE_OPEN || valves[i] == WH_VALVE_CLOSED : valves[i] == UNSET);
    }
}

static void check_look(const wh_outputs_look_t *look, size_t count, size_t size) {
    REQUIRE((unsigned)look->finding < WH_OUTPUTS_FINDINGS);
    REQUIRE(look->finding != WH_OUTPUTS_GOOD || look->found == count);
    REQUIRE(look->finding != WH_OUTPUTS_SHORT || (look->found > 0 && look->found < count));
    REQUIRE(look->finding != WH_OUTPUTS_LONG || look->found > count || look->oversize);
    REQUIRE(look->oversize == (size > WH_OUTPUTS_BYTES && count >= 1 && count <= WH_GRIPPERS));
    REQUIRE(memchr(look->text, '\0', sizeof look->text) != NULL);
}

/* Writes the valves as the program would, and reads them back. */
static void check_rewritten(const int32_t *valves, size_t count) {
    char text[2 * WH_GRIPPERS];
    for (size_t i = 0; i < count; ++i) {
        text[2 * i] = (char)('0' + valves[i]);
        text[2 * i + 1] = '\n';
    }
    int32_t again[WH_GRIPPERS];
    REQUIRE(wh_outputs_parse(text, 2 * count, count, again).finding == WH_OUTPUTS_GOOD);
    REQUIRE(memcmp(again, valves, count * sizeof *valves) == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size == 0) {
        return 0;
    }
    const size_t count = data[0] % (WH_GRIPPERS + 2);
    int32_t valves[WH_GRIPPERS + 1];
    for (size_t i = 0; i < WH_GRIPPERS + 1; ++i) {
        valves[i] = UNSET;
    }
    const wh_outputs_look_t look = wh_outputs_parse((const char *)data + 1, size - 1, count, valves);
    check_valves(&look, valves, count);
    check_look(&look, count, size - 1);
    if (look.finding == WH_OUTPUTS_GOOD) {
        check_rewritten(valves, count);
    }
    return 0;
}
