/* The layout and the script of a tool to start from, whose robots are times alone. */
#include <inttypes.h>

#include "new_cell.h"

static bool has_locks(const wh_new_cell_t *cell) {
    return cell->locks > 0;
}

/* The robot that serves the modules. */
static const char *inner_of(const wh_new_cell_t *cell) {
    return has_locks(cell) ? "VAC" : "R";
}

static const char *outer_of(const wh_new_cell_t *cell) {
    return has_locks(cell) ? "ATM" : "R";
}

/* ------------------------------------------------------------------------------------------- layout.lua */

static void write_robots(const wh_new_cell_t *cell, FILE *out) {
    fputs("  robots = {\n", out);
    if (has_locks(cell)) {
        fputs("    ATM = { kind = \"timed\", pick = 3, place = 3, move = 2, at = \"LP1\" },\n", out);
    }
    fprintf(out, "    %s = { kind = \"timed\", %spick = 4, place = 4, move = 2, at = \"%s1\" },\n  },\n",
            inner_of(cell), cell->blades == 2 ? "arms = 2, " : "", has_locks(cell) ? "PM" : "LP");
}

static void write_locks(const wh_new_cell_t *cell, FILE *out) {
    for (uint64_t i = 0; i < cell->locks; ++i) {
        fprintf(out,
                "    LL%c = {\n"
                "      pump = { down = 20, up = 15 },\n"
                "      by = { ATM = { side = \"atmosphere\" }, VAC = { side = \"vacuum\" } },\n"
                "    },\n",
                (char)('A' + (int)i));
    }
}

bool wh_new_tool_write_layout(const wh_new_cell_t *cell, FILE *out) {
    fputs(
        "-- A tool to start from, whose robots are times alone: seconds. Other fields: lua/manual/flows.md.\n"
        "---@type waferhand.timed_layout\n"
        "return {\n",
        out);
    write_robots(cell, out);
    fputs("  stations = {\n", out);
    for (uint64_t i = 1; i <= cell->foups; ++i) {
        fprintf(out, "    LP%" PRIu64 " = { kind = \"load_port\", by = \"%s\" },\n", i, outer_of(cell));
    }
    if (cell->aligner) {
        fprintf(out, "    AL = { process = 5, by = \"%s\" },\n", outer_of(cell));
    }
    write_locks(cell, out);
    for (uint64_t i = 1; i <= cell->modules; ++i) {
        fprintf(out, "    PM%" PRIu64 " = { process = 90, by = \"%s\" },\n", i, inner_of(cell));
    }
    fputs("  },\n}\n", out);
    return !ferror(out);
}

/* ------------------------------------------------------------------------------------------- script.lua */

static void write_lots(const wh_new_cell_t *cell, FILE *out) {
    fputs("  lots = {\n", out);
    for (uint64_t i = 1; i <= cell->foups; ++i) {
        fprintf(out,
                "    { name = \"%c\", wafers = { \"LP%" PRIu64 "\", 1, 25 }, back = \"LP%" PRIu64 "\" },\n",
                (char)('A' + (int)i - 1), i, i);
    }
    fputs("  },\n", out);
}

/* A step of parallel places, `first` the last letter of the first one. */
static void write_places(const char *stem, char first, uint64_t count, FILE *out) {
    fputs("{ ", out);
    for (uint64_t i = 0; i < count; ++i) {
        fprintf(out, "%s\"%s%c\"", i > 0 ? ", " : "", stem, (char)(first + (int)i));
    }
    fputs(" }", out);
}

static void write_route(const wh_new_cell_t *cell, FILE *out) {
    fputs(cell->aligner ? "  routes = { usual = { \"AL\", " : "  routes = { usual = { ", out);
    if (has_locks(cell)) {
        write_places("LL", 'A', cell->locks, out);
        fputs(", ", out);
    }
    write_places("PM", '1', cell->modules, out);
    if (has_locks(cell)) {
        fputs(", ", out);
        write_places("LL", 'A', cell->locks, out);
    }
    fputs(" } },\n", out);
}

bool wh_new_tool_write_script(const wh_new_cell_t *cell, FILE *out) {
    fputs("-- Run it with `waferhand run script.lua`, again at each save with `--watch`. Another rule:\n"
          "-- `--set rule=first_come`; longest_wait, backward and swap are the others: lua/manual/flows.md.\n"
          "cell \"layout.lua\"\n\n"
          "local told = flow {\n",
          out);
    write_lots(cell, out);
    write_route(cell, out);
    fprintf(out,
            "  rule = params.rule or \"%s\",\n"
            "}\n"
            "expect(told.wafers == %" PRIu64 ", \"all wafers are back\")\n",
            cell->blades == 2 ? "swap" : "backward", 25 * cell->foups);
    return !ferror(out);
}
