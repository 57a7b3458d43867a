/* The member `scans` of a run's document: see report/document.h. */
#ifndef WH_REPORT_SCANS_DOCUMENT_H
#define WH_REPORT_SCANS_DOCUMENT_H

#include "../record/signals.h"
#include "../text/json.h"

void wh_scans_document_put(wh_json_text_t *text, const wh_signals_t *signals, const wh_record_t *record);

#endif
