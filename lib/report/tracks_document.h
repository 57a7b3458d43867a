/* The members `tracks` and `marks` of a document: all that changes over time. While a run goes on: the
 * part that has been added since, and the present.
 */
#ifndef WH_REPORT_TRACKS_DOCUMENT_H
#define WH_REPORT_TRACKS_DOCUMENT_H

#include "../text/json.h"
#include "document.h"

/* How many points, steps, stays and marks have been written. Zero: none, so all of them are due. */
typedef struct {
    size_t axes[WH_AXES], own[WH_GRIPPERS], vacuum[WH_GRIPPERS];
    size_t proximity[WH_GRIPPERS][WH_MEASURES];
    size_t valves[WH_GRIPPERS], sensors[WH_GRIPPERS], nearest[WH_GRIPPERS];
    size_t stays, marks;
} wh_tracks_written_t;

/* Write what is due, and note it in `written`. A curve's last point comes again: its slope may only now be
 * known. So a reader drops its own points from the first one on that comes. */
void wh_tracks_put(wh_json_text_t *text, const wh_document_t *document, wh_tracks_written_t *written);
void wh_marks_put(wh_json_text_t *text, const wh_document_t *document, wh_tracks_written_t *written);

/* Notes all that is there, as if it were written. */
void wh_tracks_note(const wh_signals_t *signals, wh_tracks_written_t *written);

/* True if steps, stays or marks are due. */
bool wh_tracks_have_news(const wh_signals_t *signals, const wh_tracks_written_t *written);

/* True if points that were written are no more: they were thinned again. */
bool wh_tracks_are_anew(const wh_signals_t *signals, const wh_tracks_written_t *written);

/* Writes the last sample of each curve, whether it is a point or not: { t, axes [value], grippers [{ r, q }
 * or null], vacuum [value], proximity [[value]] }, nulls for curves that have none at present. */
void wh_tracks_put_now(wh_json_text_t *text, const char *key, const wh_signals_t *signals);

#endif
