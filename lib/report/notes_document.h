/* The notes of a report's document: what a log did not tell, and what nobody looked at or for. */
#ifndef WH_REPORT_NOTES_DOCUMENT_H
#define WH_REPORT_NOTES_DOCUMENT_H

#include "../text/json.h"
#include "document.h"

/* Writes the list `notes`: the document's own, then those of its record. */
void wh_notes_document_put(wh_json_text_t *text, const wh_document_t *document);

/* True if collisions were looked for wherever something moved: then there are curves of clearances. */
bool wh_notes_document_looked(const wh_record_t *record);

#endif
