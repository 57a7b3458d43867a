#include "inks.h"

const wh_ink_look_t wh_ink_looks[WH_INKS] = {
    [WH_INK_WALL] = {"wall", "obstacle", {0x78838f, 0x8d99a6}, ".16"},
    [WH_INK_SHELL] = {"shell", "FOUP, body", {0x9aa3ad, 0x6f7a86}, ".12"},
    [WH_INK_LEDGE] = {"ledge", "ledge", {0x5b6671, 0xa3aeb9}, ".5"},
    [WH_INK_WAFER] = {"wafer", "wafer", {0xcf7d12, 0xf0a94a}, ".04"},
    [WH_INK_ARM] = {"arm", "arm", {0x2f6bb3, 0x6ea4e6}, ".3"},
    [WH_INK_CHUCK] = {"chuck", "chuck", {0x7b4bb0, 0xb48be0}, ".5"},
    [WH_INK_BLADE] = {"blade", "blade", {0x0b857a, 0x3cc4b6}, ".5"},
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

wh_part_ink_t wh_ink_of(const wh_part_t *part) {
    static const wh_part_ink_t of_kind[] = {
        [WH_PART_FIXED] = WH_INK_WALL,  [WH_PART_LEDGE] = WH_INK_LEDGE, [WH_PART_ARM] = WH_INK_ARM,
        [WH_PART_BLADE] = WH_INK_BLADE, [WH_PART_CHUCK] = WH_INK_CHUCK, [WH_PART_DOOR] = WH_INK_WALL,
        [WH_PART_WAFER] = WH_INK_WAFER};
    return part->kind == WH_PART_FIXED && part->owner != WH_NONE ? WH_INK_SHELL : of_kind[part->kind];
}
