/* The layout that a cell message describes: enough for a simulator, without the file. */
#ifndef WH_LINK_CELL_LAYOUT_H
#define WH_LINK_CELL_LAYOUT_H

#include "messages.h"

/* Builds the layout in memory that wh_link_layout_free releases; null for a message that no layout could have made:
 * poses, tolerances, counts, names and slots are checked. The machine but its number of grippers, and the stations'
 * parameters of GET and PUT, are not in the message and zero. */
wh_layout_t *wh_link_layout_from_cell(const waferhand_cell *cell);
void wh_link_layout_free(wh_layout_t *layout);

#endif
