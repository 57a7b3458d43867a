#include "new_cell.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../layout/layout.h"
#include "../mcs/definitions.h"

const uint64_t wh_new_cell_sizes[] = {100, 125, 150, 200, 300, 0};

/* Where FOUPs and aligner stand about the robot: degrees, and mm from its axis. */
static const struct {
    double x, y, heading;
} places[WH_NEW_FOUPS] = {{760, 0, 0}, {380, 658.179, 60}, {380, -658.179, -60}, {-380, 658.179, 120}};

static const char *stack_of(const wh_new_cell_t *cell) {
    return cell->wafer < 200 ? "CASSETTE" : "FOUP";
}

/* ------------------------------------------------------------------------------------------- layout.lua */

static void write_blades(const wh_new_cell_t *cell, FILE *out) {
    if (cell->blades == 2) {
        fputs("  -- Two blades back to back on one wrist; R is that of the wrist.\n"
              "  robot = { r = { min = 50, max = 700, home = 150 } },\n"
              "  shapes = { arm = { reach = 0, link = 360 } },\n"
              "  grippers = {\n"
              "    { name = \"FRONT\", at = { 250, 0, 0 } },\n"
              "    { name = \"BACK\", at = { -250, 0, 10 }, rpy = { 0, 0, 180 } },\n",
              out);
    } else {
        fputs("  grippers = {\n    { name = \"EE\" },\n", out);
    }
    fputs(cell->aligner ? "    { name = \"CHUCK\", on = \"ALIGN\" },\n  },\n" : "  },\n", out);
}

static void write_stations(const wh_new_cell_t *cell, FILE *out) {
    fputs("  stations = {\n", out);
    for (uint64_t i = 0; i < cell->foups; ++i) {
        fprintf(out,
                "    %s%" PRIu64
                " = { %s, at = { %.10g, %.10g, 900 }, rpy = { 0, 0, %.10g }, retract = 440 },\n",
                stack_of(cell), i + 1, cell->wafer < 200 ? "slots = 25" : "kind = \"foup\"", places[i].x,
                places[i].y, places[i].heading);
    }
    if (cell->aligner) {
        fputs(
            "    ALIGN = { kind = \"prealigner\", at = { -640, 0, 950 }, rpy = { 0, 0, 180 }, retract = 320 "
            "},\n",
            out);
    }
    fputs("  },\n", out);
}

static bool write_layout(const wh_new_cell_t *cell, FILE *out) {
    if (cell->tool) {
        return wh_new_tool_write_layout(cell, out);
    }
    fprintf(out,
            "-- A cell to start from: mm, degrees, seconds. Other fields and their defaults: lua/README.md.\n"
            "-- Check it with `waferhand layout layout.lua`, draw it with `--svg cell.svg`.\n"
            "local wafers = {}\n"
            "for slot = 1, 3 do\n"
            "  wafers[slot] = { name = (\"W%%02d\"):format(slot), station = \"%s1\", slot = slot }\n"
            "end\n\n"
            "---@type waferhand.layout\n"
            "return {\n"
            "  wafer = { diameter = %" PRIu64 " },\n"
            "  tolerance = \"strict\",\n"
            "  check = \"swept\", -- between slices, too\n"
            "  seat = true, -- the vacuum draws a wafer onto the pads\n"
            "  placing = { drop = %g }, -- mm that a wafer bears to fall as it is let go\n",
            stack_of(cell), cell->wafer, (double)WH_USUAL_DROP);
    fputs(cell->collision ? "  collision = true, -- look for collisions while stepping\n" : "", out);
    write_blades(cell, out);
    write_stations(cell, out);
    fputs("  wafers = wafers,\n}\n", out);
    return !ferror(out);
}

/* ------------------------------------------------------------------------------------------- script.lua */

/* Without a second stack wafers go to other slots of the first one. */
static void write_put(const wh_new_cell_t *cell, const char *slot, FILE *out) {
    fprintf(out, "put(\"%s%d\", %s)\n", stack_of(cell), cell->foups > 1 ? 2 : 1, slot);
}

/* One wafer is turned while the next one comes. */
static void write_swaps(const wh_new_cell_t *cell, FILE *out) {
    fprintf(out,
            "get(\"%s1\", 1)\n"
            "put(\"ALIGN\", 1)\n"
            "for slot = 2, 3 do\n"
            "  rotate(\"ALIGN\", 90)\n"
            "  get(\"%s1\", slot)\n"
            "  swap(\"ALIGN\", 1)\n  ",
            stack_of(cell), stack_of(cell));
    write_put(cell, "first + slot - 2, { gripper = \"BACK\" }", out);
    fputs("end\nget(\"ALIGN\", 1)\n", out);
    write_put(cell, "first + 2", out);
}

static void write_moves(const wh_new_cell_t *cell, FILE *out) {
    fprintf(out, "for slot = 1, 3 do\n  get(\"%s1\", slot)\n", stack_of(cell));
    if (cell->aligner) {
        fputs("  put(\"ALIGN\", 1)\n  rotate(\"ALIGN\", 90)\n  get(\"ALIGN\", 1)\n", out);
    }
    fputs("  ", out);
    write_put(cell, "first + slot - 1", out);
    fputs("end\n", out);
}

static bool write_script(const wh_new_cell_t *cell, FILE *out) {
    if (cell->tool) {
        return wh_new_tool_write_script(cell, out);
    }
    fprintf(out,
            "-- Run it with `waferhand run script.lua`, again at each save with `--watch`, as a page with\n"
            "-- `waferhand report script.lua -o page.html`. Words of scripts: lua/README.md.\n"
            "cell \"layout.lua\"\n\n"
            "-- Three wafers go from %s1 %sto %s.\n"
            "local first = %d -- the slot of the first one\n",
            stack_of(cell), cell->aligner ? "by way of the prealigner " : "",
            cell->foups > 1 ? "the next one" : "slots above", cell->foups > 1 ? 1 : 11);
    if (cell->aligner && cell->blades == 2) {
        write_swaps(cell, out);
    } else {
        write_moves(cell, out);
    }
    fprintf(out,
            "\nfor number = 1, 3 do\n"
            "  expect_offset((\"W%%02d\"):format(number), \"%s%d\", first + number - 1, 0, 0, 0.01)\n"
            "end\n",
            stack_of(cell), cell->foups > 1 ? 2 : 1);
    return !ferror(out);
}

/* ------------------------------------------------------------------------------------------ for editors */

static bool write_settings(const wh_new_cell_t *cell, FILE *out) {
    (void)cell;
    fputs("{\n"
          "  \"runtime\": {\n"
          "    \"version\": \"Lua 5.4\",\n"
          "    \"builtin\": { \"debug\": \"disable\", \"io\": \"disable\", \"os\": \"disable\" }\n"
          "  },\n"
          "  \"type\": { \"checkTableShape\": true }\n"
          "}\n",
          out);
    return !ferror(out);
}

static bool write_definitions(const wh_new_cell_t *cell, FILE *out) {
    wh_sandbox_result_t result;
    char *text = wh_definitions_make(&result);
    (void)cell;
    const bool written = text && fputs(text, out) != EOF;
    free(text);
    return written;
}

/* A file of the cell, in the order of making; `write` returns false if `out` does not take it. */
typedef struct {
    const char *name;
    bool (*write)(const wh_new_cell_t *cell, FILE *out);
} new_file_t;

static const new_file_t files[] = {{"layout.lua", write_layout},
                                   {"script.lua", write_script},
                                   {"definitions.lua", write_definitions},
                                   {".luarc.json", write_settings},
                                   {NULL, NULL}};

/* ----------------------------------------------------------------------------------------------- making */

/* A file that is not there yet. False and errno if it cannot be made. */
static bool make_file(int folder, const new_file_t *file, const wh_new_cell_t *cell) {
    const int descriptor = openat(folder, file->name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    FILE *out = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
    if (!out) {
        return false;
    }
    const bool written = file->write(cell, out);
    return fclose(out) == 0 && written;
}

static bool make_files(const wh_new_cell_t *cell, const char *path) {
    const int folder = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const new_file_t *file = files;
    while (folder >= 0 && file->name && make_file(folder, file, cell)) {
        ++file;
    }
    const bool made = folder >= 0 && !file->name;
    if (!made) {
        fprintf(stderr, "%s/%s: %s (expected a file that can be written)\n", path, file->name,
                strerror(errno));
    }
    if (folder >= 0) {
        (void)close(folder);
    }
    return made;
}

bool wh_new_cell_is_free(const char *folder) {
    const bool is_free = access(folder, F_OK) != 0;
    if (!is_free) {
        fprintf(stderr, "%s: it is there already (expected a name that is free)\n", folder);
    }
    return is_free;
}

bool wh_new_cell_make(const wh_new_cell_t *cell, const char *folder) {
    if (mkdir(folder, 0777) != 0) {
        fprintf(stderr, "%s: %s (expected a folder that can be made)\n", folder, strerror(errno));
        return false;
    }
    return make_files(cell, folder);
}
