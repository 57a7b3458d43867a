/* Within the document. */
#ifndef WH_REPORT_DOCUMENT_INTERNAL_H
#define WH_REPORT_DOCUMENT_INTERNAL_H

#include "../text/json.h"
#include "document.h"

double wh_document_seconds(const wh_signals_t *signals, int64_t slice);

/* The robot's axes have names; a chuck's is its gripper's. */
void wh_document_name_axis(const wh_layout_t *layout, size_t axis, char *name, size_t size);

/* A list: `put` writes each of its elements, from 0 to count - 1. */
typedef void wh_document_put_t(wh_json_text_t *text, const wh_document_t *document, size_t i);
void wh_document_put_each(wh_json_text_t *text, const wh_document_t *document, const char *key, size_t count,
                          wh_document_put_t *put);

/* An index; null for WH_NONE. */
void wh_document_put_index(wh_json_text_t *text, const char *key, int32_t index);

/* The members r and q. */
void wh_document_put_pose(wh_json_text_t *text, const wh_pose_t *pose);

/* The document's members of these names. */
void wh_document_put_thinning(wh_json_text_t *text, const wh_signals_t *signals);
void wh_document_put_tracks(wh_json_text_t *text, const wh_document_t *document);

#endif
