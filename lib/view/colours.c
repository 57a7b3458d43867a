#include "colours.h"

#define SERIES 6

/* How far a held wafer's colour goes from its gripper's to the page's behind it. */
#define PALER 0.42F

static wh_view_colour_t from_hex(uint32_t hex, float opacity) {
    const wh_view_colour_t colour = {(float)(hex >> 16 & 0xffU) / 255, (float)(hex >> 8 & 0xffU) / 255,
                                     (float)(hex & 0xffU) / 255, opacity};
    return colour;
}

static uint32_t gripper_hex(size_t gripper) {
    static const uint32_t series[SERIES] = {0x0b5fa5, 0xb84a00, 0x00745a, 0x8b3a8f, 0x756000, 0x5a6673};
    return series[gripper % SERIES];
}

static float mixed(float from, float to, float share) {
    return from + share * (to - from);
}

wh_view_colour_t wh_view_colour_of_part(const wh_part_t *part) {
    switch (part->kind) {
    case WH_PART_FIXED:
        return part->owner == WH_NONE ? from_hex(0x8b95a0, 0.35F) : from_hex(0x9aa3ad, 0.22F);
    case WH_PART_LEDGE:
        return from_hex(0x77828d, 1);
    case WH_PART_ARM:
        return from_hex(0x9db0c4, 1);
    case WH_PART_BLADE:
    case WH_PART_CHUCK:
        return from_hex(gripper_hex((size_t)part->owner), 1);
    case WH_PART_WAFER:
        break;
    }
    return wh_view_colour_of_wafer();
}

wh_view_colour_t wh_view_colour_of_wafer(void) {
    return from_hex(0xe0ac4b, 1);
}

wh_view_colour_t wh_view_colour_of_held(size_t gripper) {
    const wh_view_colour_t pure = from_hex(gripper_hex(gripper), 1);
    const wh_view_colour_t page = from_hex(0xeef1f4, 1);
    const wh_view_colour_t pale = {mixed(pure.red, page.red, PALER), mixed(pure.green, page.green, PALER),
                                   mixed(pure.blue, page.blue, PALER), 1};
    return pale;
}

wh_view_colour_t wh_view_colour_of_notch(void) {
    return from_hex(0x35404b, 1);
}
