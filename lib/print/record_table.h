/* A run's record as tables for people.
 *
 * In this order, with what has nothing to say left out: what ran and with which tolerance; the commands, each
 * with the wafers that it took and the values (2)-(5) of each pick beside their limits; what the commands
 * that failed said; each hand-over as the chuck saw it; misses and complaints in plain words; where the
 * wafers are, and which of them a gripper carries tilted; the expectations; wafers per hour; and the verdict.
 *
 * Lengths in mm, angles in degrees, times in simulated seconds. Numbers have as many decimals as it takes not
 * to be rounded onto a limit or across it; offsets show 1e-9 mm. The same record gives the same bytes, but
 * for the wall time in the last lines. Nothing is cut off at any width.
 */
#ifndef WH_PRINT_RECORD_TABLE_H
#define WH_PRINT_RECORD_TABLE_H

#include "../record/record.h"
#include "../text/style.h"

/* Sections that are printed when asked for, before the expectations. */
enum {
    /* Who was busy when, time along the line, as wide as the terminal; what each command's time went into. */
    WH_TABLE_GANTT = 1,
    /* How near the axes come to the ends of their travel at each station. */
    WH_TABLE_MARGINS = 2
};

/* 0, or -1 if writing failed (then what is printed may be incomplete). `style` is usually wh_style_of(out). Cost: linear in
 * the record. */
int wh_record_print_table(const wh_record_t *record, FILE *out, const wh_style_t *style);

/* The same with sections of the above, added up. */
int wh_record_print_table_with(const wh_record_t *record, FILE *out, const wh_style_t *style,
                               unsigned sections);

#endif
