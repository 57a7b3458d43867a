/* Internal to sim: the names of things, as texts of events and tables write them. */
#ifndef WH_SIM_NAMES_INTERNAL_H
#define WH_SIM_NAMES_INTERNAL_H

#include "event_text.h"
#include "words_internal.h"

/* Writes the thing's own name; without one "wafer 0" by its index, and "none" for WH_NONE. */
void wh_names_put(const wh_event_names_t *names, wh_words_t *words, wh_name_kind_t kind, int32_t index)
    WH_SYMBOL(wh_names_put);

#endif
