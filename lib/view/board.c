#include "board.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/inks.h"
#include "../layout/ports.h"
#include "../text/array.h"
#include "../wire/messages.h"
#include "cell.h"

/* The direction: to the side of the robot's front, and above. */
const wh_vec3_t wh_view_from = {1.1, -1.3, 1.1};

/* In dots. */
enum { WIDE = 5, HIGH = 7, ADVANCE = 6, LINE = 10, MARGIN = 3, DIGIT = 7 };

/* Mm: a wafer's radius around points of the layout, and the distance of the writing from the back. */
#define AROUND 150
#define THICK 4.0

/* Characters from the left edge to the command. */
#define COMMAND_COLUMN 10

/* The board's share of the cell's width. Its height above the cell is a share of height and depth, because
 * near things look taller to the camera. */
#define PART_OF_CELL 0.9
#define ABOVE 0.07

/* Counts of numbers of a rectangle in a mesh: four points, two triangles. */
enum { POINTS = 4, POINT_NUMBERS = 12, NUMBERS = 18 };

/* ------------------------------------------------------------------------------------------- characters */

/* Seven rows from the top, a byte each; the leftmost dot is 0x10. */
static const uint64_t dots[128] = {
    ['!'] = 0x04040404040004,  ['"'] = 0x0a0a0a00000000, ['#'] = 0x0a0a1f0a1f0a0a, ['%'] = 0x19190204081313,
    ['\''] = 0x04040400000000, ['('] = 0x02040808080402, [')'] = 0x08040202020408, ['*'] = 0x00150e1f0e1500,
    ['+'] = 0x0004041f040400,  [','] = 0x000000000c0408, ['-'] = 0x0000001f000000, ['.'] = 0x00000000000c0c,
    ['/'] = 0x01010204081010,  ['0'] = 0x0e11131519110e, ['1'] = 0x040c040404040e, ['2'] = 0x0e11010204081f,
    ['3'] = 0x0e11010601110e,  ['4'] = 0x02060a121f0202, ['5'] = 0x1f101e0101110e, ['6'] = 0x0e10101e11110e,
    ['7'] = 0x1f010202040404,  ['8'] = 0x0e11110e11110e, ['9'] = 0x0e11110f01010e, [':'] = 0x000c0c000c0c00,
    [';'] = 0x000c0c000c0408,  ['<'] = 0x02040810080402, ['='] = 0x00001f001f0000, ['>'] = 0x08040201020408,
    ['?'] = 0x0e110102040004,  ['A'] = 0x0e11111f111111, ['B'] = 0x1e11111e11111e, ['C'] = 0x0e11101010110e,
    ['D'] = 0x1e11111111111e,  ['E'] = 0x1f10101e10101f, ['F'] = 0x1f10101e101010, ['G'] = 0x0e11101711110e,
    ['H'] = 0x1111111f111111,  ['I'] = 0x0e04040404040e, ['J'] = 0x0702020202120c, ['K'] = 0x11121418141211,
    ['L'] = 0x1010101010101f,  ['M'] = 0x111b1515111111, ['N'] = 0x11191915131311, ['O'] = 0x0e11111111110e,
    ['P'] = 0x1e11111e101010,  ['Q'] = 0x0e11111115120d, ['R'] = 0x1e11111e141211, ['S'] = 0x0f10100e01011e,
    ['T'] = 0x1f040404040404,  ['U'] = 0x1111111111110e, ['V'] = 0x11111111110a04, ['W'] = 0x11111115151b11,
    ['X'] = 0x11110a040a1111,  ['Y'] = 0x11110a04040404, ['Z'] = 0x1f01020408101f, ['['] = 0x0e08080808080e,
    [']'] = 0x0e02020202020e,  ['_'] = 0x0000000000001f};

static uint64_t dots_of(char character) {
    static const uint64_t box = 0x1f11111111111f;
    const int c = toupper((unsigned char)character);
    return c == ' ' ? 0 : c < 128 && dots[c] != 0 ? dots[c] : box;
}

static unsigned row_of(uint64_t left, unsigned row) {
    return (unsigned)(left >> 8U * (HIGH - 1 - row)) & 0x1fU;
}

/* Bits `from` to before `to` of a row, counted from the left. */
static unsigned bits_between(unsigned from, unsigned to) {
    return (0x1fU >> from) & ~(0x1fU >> to) & 0x1fU;
}

/* A rectangle of a character with its left upper dot at x, y; in dots. */
typedef struct {
    double left, right, top, bottom;
} rectangle_t;

/* Takes the next rectangle out of the rest of a character: a row's run of dots, down to the last row with
 * the same dots. Returns false if no dot is left. */
static bool take_rectangle(uint64_t *left, rectangle_t *rectangle) {
    unsigned row = 0, from = 0, below;
    while (row < HIGH && row_of(*left, row) == 0) {
        ++row;
    }
    if (row == HIGH) {
        return false;
    }
    while ((row_of(*left, row) & bits_between(from, from + 1)) == 0) {
        ++from;
    }
    unsigned to = from;
    while (to < WIDE && (row_of(*left, row) & bits_between(to, to + 1)) != 0) {
        ++to;
    }
    const unsigned run = bits_between(from, to);
    for (below = row; below < HIGH && (row_of(*left, below) & run) == run; ++below) {
        *left &= ~((uint64_t)run << 8U * (HIGH - 1 - below));
    }
    *rectangle = (rectangle_t){from, to, row, below};
    return true;
}

/* ------------------------------------------------------------------------------------------------ lines */

/* Adds a rectangle to a mesh with room for WH_VIEW_RECTANGLES of them; all points come first. */
static void put_rectangle(float *numbers, size_t index, const rectangle_t *r, double dot) {
    const double x[POINTS] = {r->left, r->right, r->right, r->left};
    const double y[POINTS] = {-r->bottom, -r->bottom, -r->top, -r->top};
    float *points = numbers + index * POINT_NUMBERS;
    for (size_t i = 0; i < POINTS; ++i) {
        points[3 * i] = (float)(x[i] * dot / 1000);
        points[3 * i + 1] = (float)(y[i] * dot / 1000);
        points[3 * i + 2] = 0;
    }
}

static void put_corners(float *numbers, size_t index) {
    static const size_t corners[NUMBERS - POINT_NUMBERS] = {0, 1, 2, 0, 2, 3};
    for (size_t i = 0; i < NUMBERS - POINT_NUMBERS; ++i) {
        numbers[i] = (float)(index * POINTS + corners[i]);
    }
}

/* Fills the mesh in a body's shape with a text; without a rectangle the body has no shape. */
static void put_text(waferhand_viewer_link *body, const char *text, double dot) {
    waferhand_viewer_geometry *shape = body->geom;
    float *points = shape->float_data + 2;
    size_t count = 0;
    for (size_t column = 0; text[column] != '\0'; ++column) {
        uint64_t left = dots_of(text[column]);
        rectangle_t rectangle;
        while (count < WH_VIEW_RECTANGLES && take_rectangle(&left, &rectangle)) {
            rectangle.left += (double)(column * ADVANCE);
            rectangle.right += (double)(column * ADVANCE);
            put_rectangle(points, count++, &rectangle, dot);
        }
    }
    for (size_t i = 0; i < count; ++i) {
        put_corners(points + count * POINT_NUMBERS + i * (NUMBERS - POINT_NUMBERS), i);
    }
    shape->float_data[0] = (float)(count * POINTS);
    shape->float_data[1] = (float)(count * 2);
    shape->num_float_data = (int32_t)(2 + count * NUMBERS);
    body->num_geom = count > 0;
}

/* One byte is used for each character, whatever its bytes are. */
static void copy_line(const char *text, size_t most, char line[WH_VIEW_COLUMNS + 1]) {
    size_t count = 0;
    for (; *text != '\0' && count < most; ++text) {
        if (((unsigned char)*text & 0xc0U) != 0x80U) { /* otherwise it continues a character */
            line[count++] = *text;
        }
    }
    line[count] = '\0';
}

/* ----------------------------------------------------------------------------------------------- bodies */

enum { BACK, UNIT, FIRST_LINE, FIRST_SEGMENT = FIRST_LINE + WH_VIEW_LINES };
enum { BODIES = FIRST_SEGMENT + WH_VIEW_DIGITS * WH_VIEW_SEGMENTS };

static void set_colour(waferhand_viewer_geometry *shape, uint32_t hex, float opacity) {
    const wh_view_colour_t colour = wh_view_colour(hex, opacity);
    memcpy(shape->color, colour.rgba, sizeof shape->color);
}

/* A box with its middle at a place on the board, in mm. */
static void make_box(waferhand_viewer_geometry *shape, const wh_vec3_t *half, const wh_vec3_t *middle) {
    const wh_view_colour_t colour = wh_view_colour(wh_ink_stage.light, 1);
    const wh_convex_t box = {.kind = WH_CONVEX_BOX, .half = *half};
    wh_pose_t place = wh_pose_identity();
    place.r = *middle;
    wh_view_geometry_make(&box, &place, &colour, false, shape);
}

/* Makes room for a text, which begins at a place on the board. */
static void make_text(waferhand_viewer_geometry *shape, double left, double top) {
    const wh_vec3_t here = {0, 0, 0};
    const wh_vec3_t place = {left, top, THICK / 2};
    make_box(shape, &here, &place);
    wh_view_geometry_free(shape);
    shape->type = WH_VIEW_TRIANGLES;
    shape->float_data = wh_array_new(2 + WH_VIEW_RECTANGLES * (size_t)NUMBERS, sizeof(float));
}

/* Segment s of a digit, a to g, about the digit's left lower corner, in dots. */
static void make_segment(waferhand_viewer_geometry *shape, size_t s, double dot) {
    static const double middles[WH_VIEW_SEGMENTS][2] = {{2.5, 6.5}, {4.5, 5}, {4.5, 2},  {2.5, 0.5},
                                                        {0.5, 2.0}, {0.5, 5}, {2.5, 3.5}};
    const bool lies = s == 0 || s == 3 || s == 6;
    const wh_vec3_t half = wh_vec3((lies ? 1.4 : 0.45) * dot, (lies ? 0.45 : 1.4) * dot, THICK / 4);
    const wh_vec3_t middle = wh_vec3(middles[s][0] * dot, middles[s][1] * dot, THICK / 2);
    make_box(shape, &half, &middle);
}

/* The board's size, in dots. */
static const double board_width = WH_VIEW_COLUMNS * ADVANCE + 2 * MARGIN;
static const double board_height = WH_VIEW_LINES * LINE + 2 * MARGIN - (LINE - HIGH);

static double top_of(int line) {
    return board_height - MARGIN - line * LINE;
}

/* Adds the bodies, each with an unfinished shape. */
static void add_bodies(wh_view_board_t *board) {
    static const char *const names[FIRST_SEGMENT] = {"back", "s", "command", "hit", "with"};
    for (size_t i = 0; i < BODIES; ++i) {
        const size_t segment = i < FIRST_SEGMENT ? 0 : i - FIRST_SEGMENT;
        char time[16];
        (void)snprintf(time, sizeof time, "time %zu%c", segment / WH_VIEW_SEGMENTS + 1,
                       "abcdefg"[segment % WH_VIEW_SEGMENTS]);
        (void)wh_view_bodies_add(&board->bodies, "board", i < FIRST_SEGMENT ? names[i] : time);
        (void)wh_view_bodies_add_shape(&board->bodies);
    }
    wh_view_bodies_open(&board->bodies);
}

static waferhand_viewer_geometry *shape_of(const wh_view_board_t *board, size_t body) {
    return board->bodies.load.link[body].geom;
}

static void make_shapes(wh_view_board_t *board) {
    static const uint32_t red = 0xff8080;
    const double dot = board->dot;
    const wh_vec3_t half = wh_vec3(board_width / 2 * dot, board_height / 2 * dot, THICK / 2);
    const wh_vec3_t middle = wh_vec3(half.x, half.y, -THICK / 2);
    make_box(shape_of(board, BACK), &half, &middle);
    set_colour(shape_of(board, BACK), wh_ink_stage.dark, 0.85F);
    /* The point is between the last two digits, its dots in the middle of its place. */
    make_text(shape_of(board, UNIT), (MARGIN + (WH_VIEW_DIGITS - 1) * DIGIT - 2.5) * dot, top_of(0) * dot);
    put_text(&board->bodies.load.link[UNIT], ". s", dot);
    for (int line = 0; line < WH_VIEW_LINES; ++line) {
        const int column = line == WH_VIEW_COMMAND ? COMMAND_COLUMN : 0;
        make_text(shape_of(board, FIRST_LINE + (size_t)line), (MARGIN + column * ADVANCE) * dot,
                  top_of(line) * dot);
        put_text(&board->bodies.load.link[FIRST_LINE + line], "", dot);
    }
    set_colour(shape_of(board, FIRST_LINE + WH_VIEW_HIT), red, 1);
    set_colour(shape_of(board, FIRST_LINE + WH_VIEW_HIT_WITH), red, 1);
    for (size_t i = FIRST_SEGMENT; i < BODIES; ++i) {
        make_segment(shape_of(board, i), (i - FIRST_SEGMENT) % WH_VIEW_SEGMENTS, dot);
    }
}

/* ------------------------------------------------------------------------------------------------ place */

typedef struct {
    wh_vec3_t low, high;
} bounds_t;

static double lower(double a, double b) {
    return a < b ? a : b;
}

static void include(bounds_t *bounds, const wh_vec3_t *low, const wh_vec3_t *high) {
    bounds->low =
        wh_vec3(lower(bounds->low.x, low->x), lower(bounds->low.y, low->y), lower(bounds->low.z, low->z));
    bounds->high = wh_vec3(wh_real_max(bounds->high.x, high->x), wh_real_max(bounds->high.y, high->y),
                           wh_real_max(bounds->high.z, high->z));
}

static void include_around(bounds_t *bounds, const wh_vec3_t *middle) {
    const wh_vec3_t around = {AROUND, AROUND, AROUND};
    const wh_vec3_t low = wh_vec3_subtract(middle, &around);
    const wh_vec3_t high = wh_vec3_add(middle, &around);
    include(bounds, &low, &high);
}

/* The box of the layout's fixed parts, with its wafers and the robot's foot. */
static bounds_t bounds_of(const wh_layout_t *layout) {
    const wh_pose_t base = wh_pose_identity();
    bounds_t bounds = {{-AROUND, -AROUND, 0}, {AROUND, AROUND, AROUND}};
    for (size_t i = 0; i < layout->world.part_count; ++i) {
        const wh_part_t *part = &layout->world.parts[i];
        wh_vec3_t low, high;
        if (part->kind == WH_PART_FIXED || part->kind == WH_PART_LEDGE) {
            wh_convex_bounds(&part->convex, &base, &low, &high);
            include(&bounds, &low, &high);
        }
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        include_around(&bounds, &layout->places[s].base_from_station.r);
    }
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        if (!wh_layout_is_outside(&layout->start[w].base_from_wafer)) {
            include_around(&bounds, &layout->start[w].base_from_wafer.r);
        }
    }
    return bounds;
}

/* Half of a box's extent along a level direction. */
static double extent(const bounds_t *bounds, const wh_vec3_t *direction) {
    const wh_vec3_t size = wh_vec3_subtract(&bounds->high, &bounds->low);
    return (wh_real_abs(direction->x) * size.x + wh_real_abs(direction->y) * size.y) / 2;
}

static void place_board(wh_view_board_t *board, const wh_layout_t *layout) {
    const bounds_t bounds = bounds_of(layout);
    const double length = wh_real_sqrt(wh_view_from.x * wh_view_from.x + wh_view_from.y * wh_view_from.y);
    const wh_vec3_t nearer = wh_vec3(wh_view_from.x / length, wh_view_from.y / length, 0);
    const wh_vec3_t right = wh_vec3(-nearer.y, nearer.x, 0);
    const double width = 2 * PART_OF_CELL * extent(&bounds, &right);
    const double back = extent(&bounds, &nearer);
    const wh_vec3_t sum = wh_vec3_add(&bounds.low, &bounds.high);
    const double above = ABOVE * (bounds.high.z - bounds.low.z + 2 * back);
    wh_pose_t *pose = &board->base_from_board;
    board->dot = width / board_width;
    pose->R = (wh_mat3_t){{{right.x, 0, nearer.x}, {right.y, 0, nearer.y}, {0, 1, 0}}};
    pose->r = wh_vec3(sum.x / 2 - back * nearer.x - width / 2 * right.x,
                      sum.y / 2 - back * nearer.y - width / 2 * right.y, bounds.high.z + above);
}

void wh_view_board_open(wh_view_board_t *board, const wh_layout_t *layout) {
    memset(board, 0, sizeof *board);
    place_board(board, layout);
    add_bodies(board);
    make_shapes(board);
    for (size_t i = 0; i < BODIES; ++i) {
        wh_view_bodies_place(&board->bodies, i, &board->base_from_board);
    }
    board->tenths = -1;
    (void)wh_view_board_set_time(board, 0);
}

int wh_view_board_room(const wh_view_board_t *board) {
    const int shape = waferhand_viewer_geometry_encoded_size(shape_of(board, UNIT));
    const int most = (int)((2 + WH_VIEW_RECTANGLES * NUMBERS) * sizeof(float));
    return waferhand_viewer_load_encoded_size(&board->bodies.load) + WH_VIEW_LINES * (shape + most);
}

bool wh_view_board_write(wh_view_board_t *board, wh_view_line_t line, const char *text) {
    char written[WH_VIEW_COLUMNS + 1];
    copy_line(text, WH_VIEW_COLUMNS - (line == WH_VIEW_COMMAND ? COMMAND_COLUMN : 0), written);
    if (strcmp(written, board->lines[line]) == 0) {
        return false;
    }
    memcpy(board->lines[line], written, sizeof written);
    put_text(&board->bodies.load.link[FIRST_LINE + (int)line], written, board->dot);
    return true;
}

/* ------------------------------------------------------------------------------------------------- time */

/* Bit s: segment s is on. The last entry is for no digit. */
static const uint8_t segments[11] = {0x3f, 0x06, 0x5b, 0x4f, 0x66, 0x6d, 0x7d, 0x07, 0x7f, 0x6f, 0};

static void show_digit(wh_view_board_t *board, size_t place, size_t digit) {
    wh_pose_t shown = board->base_from_board;
    /* The tenths are one dot further to the right. */
    const double left = MARGIN + (double)(place * DIGIT) + (place + 1 == WH_VIEW_DIGITS);
    const wh_vec3_t at = wh_vec3(left * board->dot, (top_of(0) - HIGH) * board->dot, 0);
    wh_pose_t away = shown;
    shown.r = wh_pose_point(&board->base_from_board, &at);
    away.r.z = -WH_VIEW_AWAY;
    for (size_t s = 0; s < WH_VIEW_SEGMENTS; ++s) {
        const size_t body = FIRST_SEGMENT + place * WH_VIEW_SEGMENTS + s;
        wh_view_bodies_place(&board->bodies, body, segments[digit] >> s & 1U ? &shown : &away);
    }
}

bool wh_view_board_set_time(wh_view_board_t *board, int64_t utime) {
    const int64_t shown = utime / 100000 % 1000000; /* as many as the digits show */
    int64_t tenths = shown;
    board->bodies.draw.timestamp = utime / 1000;
    if (shown == board->tenths) {
        return false;
    }
    board->tenths = shown;
    for (size_t place = WH_VIEW_DIGITS; place-- > 0; tenths /= 10) {
        const bool leads = tenths == 0 && place + 2 < WH_VIEW_DIGITS;
        show_digit(board, place, leads ? 10 : (size_t)(tenths % 10));
    }
    return true;
}

void wh_view_board_free(wh_view_board_t *board) {
    for (int32_t i = 0; i < board->bodies.load.num_links; ++i) {
        board->bodies.load.link[i].num_geom = 1; /* a line without text has not shown its own yet */
    }
    wh_view_bodies_free(&board->bodies);
    memset(board, 0, sizeof *board);
}
