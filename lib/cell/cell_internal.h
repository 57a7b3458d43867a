/* Within lib/cell: how the cell says something about a release. */
#ifndef WH_CELL_CELL_INTERNAL_H
#define WH_CELL_CELL_INTERNAL_H

#include "station.h"

/* A copy of the list's events[release] as another kind, appended to it; null when it is full. */
wh_event_t *wh_cell_append(size_t release, wh_event_list_t *list, wh_event_kind_t kind);

#endif
