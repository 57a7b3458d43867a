/* Faults on purpose as layouts and scripts describe them: a table with kind, whom it concerns, when and how much. */
#ifndef WH_LAYOUT_LAYOUT_FAULTS_H
#define WH_LAYOUT_LAYOUT_FAULTS_H

#include "../script/reader.h"
#include "layout.h"

/* Reads the fault that the reader is at; raises the reader's errors. `first` is the slice that `after = 0` means. */
wh_fault_t wh_layout_read_fault(wh_reader_t *reader, const wh_layout_t *layout, int64_t first);

#endif
