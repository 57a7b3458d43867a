/* Writes SVG: escapes text for it, and places labels so that they do not overlap. */
#ifndef WH_TEXT_SVG_H
#define WH_TEXT_SVG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Writes text in a form that is content or an attribute's value of well-formed XML; bytes that are not
 * UTF-8 become U+FFFD. */
void wh_svg_text(FILE *out, const char *text);

/* At most this number of labels is placed; more would cover the picture. */
#define WH_SVG_LABELS 300

typedef struct {
    double x, y, width, height;
} wh_svg_box_t;

/* Labels of one view. Units are those of the picture, with y down. */
typedef struct {
    FILE *out;
    double size;        /* of the letters */
    double left, right; /* labels stay between these */
    wh_svg_box_t taken[WH_SVG_LABELS];
    size_t count;
} wh_svg_labels_t;

/* Writes a label with its middle at x and its base line at y, or lower if other labels are in the way. */
void wh_svg_label(wh_svg_labels_t *labels, double x, double y, const char *text);

#endif
