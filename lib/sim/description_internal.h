/* The parts of a simulator that do not change during a run. */
#ifndef WH_SIM_DESCRIPTION_INTERNAL_H
#define WH_SIM_DESCRIPTION_INTERNAL_H

#include "simulator.h"

/* The hash over configuration, physics, stations, edge sensors and counts. Cost: linear in stations. */
uint64_t wh_simulator_describe(const wh_simulator_t *simulator) WH_SYMBOL(wh_simulator_describe);

#endif
