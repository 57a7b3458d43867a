#include "inks.h"

const wh_ink_look_t wh_ink_looks[WH_INKS] = {
    [WH_INK_WALL] = {"wall", "obstacle", {0x78838f, 0x8d99a6}, ".16", {0x8b95a0, 0x6f7b87}},
    [WH_INK_SHELL] = {"shell", "FOUP, body", {0x9aa3ad, 0x6f7a86}, ".12", {0x9aa3ad, 0x6f7a86}},
    [WH_INK_LEDGE] = {"ledge", "ledge", {0x5b6671, 0xa3aeb9}, ".5", {0x77828d, 0x8d98a3}},
    [WH_INK_WAFER] = {"wafer", "wafer", {0xcf7d12, 0xf0a94a}, ".04", {0xe0ac4b, 0xd9aa55}},
    [WH_INK_ARM] = {"arm", "arm", {0x2f6bb3, 0x6ea4e6}, ".3", {0x9db0c4, 0x5f7388}},
    [WH_INK_CHUCK] = {"chuck", "chuck", {0x7b4bb0, 0xb48be0}, ".5", {0x8b6fb5, 0x8f76b8}},
    [WH_INK_BLADE] = {"blade", "blade", {0x0b857a, 0x3cc4b6}, ".5", {0x0b5fa5, 0x6fb3f2}},
};

const wh_ink_material_t wh_ink_materials[WH_INKS] = {
    [WH_INK_WALL] = {"obstacle", 0.19, 0.23, 0.27, 0.18, 0, 0.9},
    [WH_INK_SHELL] = {"shell", 0.33, 0.37, 0.42, 0.16, 0, 0.6},
    [WH_INK_LEDGE] = {"ledge", 0.11, 0.14, 0.17, 1, 0, 0.8},
    [WH_INK_WAFER] = {"wafer", 0.62, 0.21, 0.006, 1, 0.2, 0.35},
    [WH_INK_ARM] = {"arm", 0.028, 0.147, 0.45, 1, 0.1, 0.5},
    [WH_INK_CHUCK] = {"chuck", 0.2, 0.072, 0.43, 1, 0.1, 0.5},
    [WH_INK_BLADE] = {"blade", 0.003, 0.235, 0.195, 1, 0.1, 0.4},
};

const wh_colour_t wh_ink_series[WH_INK_SERIES] = {{0x0b5fa5, 0x6fb3f2}, {0xb84a00, 0xff9a5c},
                                                  {0x00745a, 0x45cfa4}, {0x8b3a8f, 0xdc9be3},
                                                  {0x756000, 0xe3c94f}, {0x5a6673, 0xa7b3bf}};

const wh_colour_t wh_ink_edge = {0x35404b, 0xc9d2db};
const wh_colour_t wh_ink_stage = {0xeef1f4, 0x131a21};

wh_part_ink_t wh_ink_of(const wh_part_t *part) {
    static const wh_part_ink_t of_kind[] = {
        [WH_PART_FIXED] = WH_INK_WALL,  [WH_PART_LEDGE] = WH_INK_LEDGE, [WH_PART_ARM] = WH_INK_ARM,
        [WH_PART_BLADE] = WH_INK_BLADE, [WH_PART_CHUCK] = WH_INK_CHUCK, [WH_PART_DOOR] = WH_INK_WALL,
        [WH_PART_WAFER] = WH_INK_WAFER};
    return part->kind == WH_PART_FIXED && part->owner != WH_NONE ? WH_INK_SHELL : of_kind[part->kind];
}
