/* Within lib/cell: how the cell says something about a release. */
#ifndef WH_CELL_CELL_INTERNAL_H
#define WH_CELL_CELL_INTERNAL_H

#include "cell/station.h"

/* A copy of events[release] as another kind, appended to the list; null when that is full. */
wh_event_t *wh_cell_append(wh_event_list_t *list, size_t release, wh_event_kind_t kind);

#endif
