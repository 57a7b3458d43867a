#include "svg.h"

#include <string.h>

#include "utf8.h"

/* U+FFFE and U+FFFF are UTF-8, but not characters of XML. */
static bool is_noncharacter(const char *text, size_t bytes) {
    return bytes == 3 && (memcmp(text, "\xef\xbf\xbe", 3) == 0 || memcmp(text, "\xef\xbf\xbf", 3) == 0);
}

static const char *entity_of(char character) {
    static const char characters[] = "&<>\"";
    static const char *const entities[] = {"&amp;", "&lt;", "&gt;", "&quot;"};
    const char *found = strchr(characters, character);
    return found && *found != '\0' ? entities[found - characters] : NULL;
}

void wh_svg_text(FILE *out, const char *text) {
    while (*text != '\0') {
        const size_t bytes = wh_utf8_bytes(text);
        const char *entity = entity_of(*text);
        if (entity) {
            fputs(entity, out);
        } else if (bytes == 0 || (unsigned char)*text < ' ' || is_noncharacter(text, bytes)) {
            fputs(WH_UTF8_REPLACEMENT, out);
        } else {
            fwrite(text, 1, bytes, out);
        }
        text += bytes > 0 ? bytes : 1;
    }
}

static bool overlap(const wh_svg_box_t *a, const wh_svg_box_t *b) {
    return a->x < b->x + b->width && b->x < a->x + a->width && a->y < b->y + b->height &&
           b->y < a->y + a->height;
}

static bool is_free(const wh_svg_labels_t *labels, const wh_svg_box_t *box) {
    for (size_t i = 0; i < labels->count; ++i) {
        if (overlap(&labels->taken[i], box)) {
            return false;
        }
    }
    return true;
}

void wh_svg_label(wh_svg_labels_t *labels, double x, double y, const char *text) {
    if (labels->count == WH_SVG_LABELS) {
        return;
    }
    const double width = 0.6 * labels->size * (double)wh_utf8_count(text);
    wh_svg_box_t box = {x - width / 2, y - labels->size, width, 1.15 * labels->size};
    box.x = box.x + width < labels->right ? box.x : labels->right - width;
    box.x = box.x > labels->left ? box.x : labels->left;
    for (size_t tries = 0; tries < WH_SVG_LABELS && !is_free(labels, &box); ++tries) {
        box.y += box.height;
    }
    labels->taken[labels->count++] = box;
    fprintf(labels->out, "<text class=\"label\" x=\"%.1f\" y=\"%.1f\">", box.x + width / 2,
            box.y + labels->size);
    wh_svg_text(labels->out, text);
    fputs("</text>\n", labels->out);
}
