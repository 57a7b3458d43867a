/* Shared by the files that judge a layout: feasibility.c, contact.c, room.c, blades.c, lifted.c, sight.c,
 * rests.c, pockets.c, mesh_size.c, units.c. */
#ifndef WH_SURVEY_FEASIBILITY_INTERNAL_H
#define WH_SURVEY_FEASIBILITY_INTERNAL_H

#include "feasibility.h"

/* How far a station is tilted, deg. */
double wh_feasibility_tilt(const wh_station_t *station);

/* Finds all contacts at the start, and all contacts if every taught slot held a wafer. Both need parts. */
void wh_feasibility_contacts(wh_feasibility_t *check);
void wh_feasibility_full(wh_feasibility_t *check);

/* The room of a wafer that a GET lifts. Needs parts. */
void wh_feasibility_lifted(wh_feasibility_t *check, size_t station);

/* Finds meshes whose size must be a mistake: too small or too large. */
void wh_feasibility_sizes(wh_feasibility_t *check);

/* Numbers that look as if they were in radians, in metres, or per metre. */
void wh_feasibility_units(wh_feasibility_t *check);

/* Finds what beams and edge sensors cannot see. */
void wh_feasibility_sight(wh_feasibility_t *check);

/* The wafer that an edge grip will take, turned as it lies on that blade, with its middle at the wanted
 * place. */
wh_edge_wafer_t wh_feasibility_lying(const wh_layout_t *layout, size_t wafer);

/* Notches that an edge grip would take over one of its rests, and wafers that it would not hold. */
void wh_feasibility_rests(wh_feasibility_t *check);
void wh_feasibility_pockets(wh_feasibility_t *check);

/* The room at a station, and of the robot's blades beside one another. Both need parts. */
void wh_feasibility_room(wh_feasibility_t *check, size_t station);
void wh_feasibility_blades(wh_feasibility_t *check);

#endif
