/* Fields by recipe: a number, or numbers by the names of recipes with `default`. Stations' fields say which
 * recipes a tool has; wafers, lots and steps name one of them. */
#include <stdio.h>
#include <string.h>

#include "../text/nearest.h"
#include "layout_internal.h"
#include "layout_tool.h"

/* The number of a recipe that a station has; a new one is kept. */
static int32_t keep_recipe(wh_reader_t *reader, wh_flow_recipes_t *recipes, const char *name) {
    const int32_t known = wh_flow_recipe_named(recipes, name);
    if (known > 0) {
        return known;
    }
    if (recipes->count == WH_FLOW_RECIPES) {
        wh_reader_refuse(reader, name, NULL, "at most %d recipes in a layout", WH_FLOW_RECIPES);
    }
    (void)snprintf(recipes->names[recipes->count], WH_FLOW_RECIPE_BYTES, "%s", name);
    return ++recipes->count;
}

/* An entry of the table at which the reader is. */
static double read_entry(wh_reader_t *reader, const char *name, const wh_reader_field_t *row) {
    return strncmp(row->type, "integer", strlen("integer")) == 0
               ? wh_reader_whole(reader, name, (int32_t)row->least - 1, (int32_t)row->least,
                                 (int32_t)row->most)
               : wh_reader_number(reader, name, (wh_real_t)WH_FIELD_FOLLOWS, (wh_real_t)row->least,
                                  (wh_real_t)row->most);
}

double wh_layout_read_by_recipe(wh_reader_t *reader, const char *field, wh_flow_recipes_t *recipes,
                                double by[WH_FLOW_RECIPES], bool *is_table) {
    const wh_reader_field_t *row = wh_reader_row(reader, field);
    *is_table = wh_reader_push(reader, field) == LUA_TTABLE;
    lua_pop(reader->L, 1);
    if (*is_table) {
        (void)wh_reader_enter(reader, field);
    }
    const double usual = *is_table                      ? read_entry(reader, "default", row)
                         : wh_reader_has(reader, field) ? read_entry(reader, field, row)
                                                        : row->usual;
    for (size_t i = 0; i < WH_FLOW_RECIPES; ++i) {
        by[i] = usual;
    }
    if (!*is_table) {
        return usual;
    }
    size_t count = 0;
    const wh_timed_name_t *names =
        wh_layout_read_keys(reader, WH_FLOW_RECIPES + 1, sizeof *names, "recipes", &count);
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(names[i].name, "default") != 0) {
            const int32_t recipe = keep_recipe(reader, recipes, names[i].name);
            by[recipe - 1] = read_entry(reader, names[i].name, row);
        }
    }
    wh_reader_leave(reader);
    return usual;
}

/* "a recipe of the layout: nitride, oxide". */
static void list_recipes(const wh_flow_recipes_t *recipes, char text[], size_t size) {
    size_t used = (size_t)snprintf(text, size, "%s",
                                   recipes && recipes->count > 0
                                       ? "a recipe that stations of the layout have: "
                                       : "nothing: no station of the layout has times by recipe");
    for (int32_t i = 0; recipes && i < recipes->count && used < size; ++i) {
        used += (size_t)snprintf(text + used, size - used, "%s%s", i > 0 ? ", " : "", recipes->names[i]);
    }
}

int32_t wh_layout_find_recipe(const wh_reader_t *reader, const wh_flow_recipes_t *recipes, const char *field,
                              const char *name) {
    const int32_t found = recipes ? wh_flow_recipe_named(recipes, name) : 0;
    if (found == 0) {
        char expected[WH_FLOW_RECIPES * 16], meant[WH_NEAREST_TEXT];
        const char *names[WH_FLOW_RECIPES];
        const size_t count = recipes ? (size_t)recipes->count : 0;
        for (size_t i = 0; i < count; ++i) {
            names[i] = recipes->names[i];
        }
        list_recipes(recipes, expected, sizeof expected);
        wh_reader_refuse(reader, field, name, "%s%s", expected,
                         wh_text_did_you_mean(meant, "; ", "", wh_text_nearest(name, names, count)));
    }
    return found;
}

int32_t wh_layout_read_recipe(wh_reader_t *reader, const wh_flow_recipes_t *recipes) {
    char name[WH_NAME_SIZE];
    if (!wh_reader_has(reader, "recipe")) {
        return 0;
    }
    wh_reader_text(reader, "recipe", NULL, name, sizeof name);
    return wh_layout_find_recipe(reader, recipes, "recipe", name);
}
