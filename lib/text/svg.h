/* Writing SVG: text made fit for it, and labels that keep out of each other's way. */
#ifndef WH_TEXT_SVG_H
#define WH_TEXT_SVG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Writes text so that it is content or an attribute's value of well-formed XML; what is no UTF-8 becomes
 * U+FFFD. */
void wh_svg_text(FILE *out, const char *text);

/* So many labels are placed at most; more would cover the picture. */
#define WH_SVG_LABELS 300

typedef struct {
    double x, y, width, height;
} wh_svg_box_t;

/* Labels of one view. Units are those of the picture, y down. */
typedef struct {
    FILE *out;
    double size;        /* of the letters */
    double left, right; /* labels stay between these */
    wh_svg_box_t taken[WH_SVG_LABELS];
    size_t count;
} wh_svg_labels_t;

/* Writes a label whose middle is at x and whose base line is at y, or lower where others are in the way. */
void wh_svg_label(wh_svg_labels_t *labels, double x, double y, const char *text);

#endif
