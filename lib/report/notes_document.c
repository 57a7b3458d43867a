#include "notes_document.h"

#include <ctype.h>

bool wh_notes_document_looked(const wh_record_t *record) {
    return record->checked && record->counted.moving == 0;
}

static void note_counted(const wh_record_t *record, char note[], size_t size) {
    const wh_counted_record_t *counted = &record->counted;
    const long long all = record->slices;
    if (!counted->is_wanted || wh_record_is_timed(record)) {
        return;
    }
    const int length = snprintf(note, size,
                                "Played %lld of %lld slices: nothing was decided in the others. Curves go "
                                "through every 10 ms of their motion.",
                                all - counted->left_out, all);
    if (record->checked && counted->moving > 0) {
        (void)snprintf(note + length, size - (size_t)length,
                       " C%s were looked for in %lld of %lld slices, so that their curves are not shown.",
                       &WH_RECORD_COUNTED_UNLOOKED[1], all - counted->moving, all);
    }
}

static void note_unlooked(const wh_record_t *record, char note[], size_t size) {
    if (record->unlooked) {
        (void)snprintf(note, size, "%c%s.", toupper((unsigned char)record->unlooked[0]),
                       record->unlooked + 1);
    }
}

static void note_alone(const wh_record_t *record, char note[], size_t size) {
    if (record->times_alone) {
        (void)snprintf(note, size, "%s: " WH_RECORD_SOME_ALONE ".", record->times_alone);
    }
}

static void note_never_came(const wh_record_t *record, char note[], size_t size) {
    if (record->never_came) {
        (void)snprintf(note, size, "Never came, and so were not tried: %s.", record->never_came);
    }
}

/* Behind the notes of a log, or in their place: what nobody looked at. */
void wh_notes_document_put(wh_json_text_t *text, const wh_document_t *document) {
    static void (*const kinds[])(const wh_record_t *record, char note[],
                                 size_t size) = {note_counted, note_unlooked, note_alone, note_never_came};
    wh_json_text_begin(text, "notes", '[');
    for (size_t i = 0; i < document->note_count; ++i) {
        wh_json_text_value(text, NULL, wh_json_text(document->notes[i]));
    }
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i) {
        char note[2000] = "";
        kinds[i](document->record, note, sizeof note);
        if (note[0] != '\0') {
            wh_json_text_value(text, NULL, wh_json_text(note));
        }
    }
    wh_json_text_end(text, ']');
}
