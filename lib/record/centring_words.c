#include "centring_words.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../math/trig.h"

/* Standard deviations in um and degrees have this precision, and a least value, because none is 0. */
#define LEAST_UM 0.01
#define LEAST_DEG 1e-4

enum { VERDICT, CENTRE, RADIUS, CROSSINGS, NOTCH, COMMAND };

/* The end of the centring's command. */
typedef enum { NOT_TOLD, WENT_ON, FAILED_SO, FAILED_ELSE } end_t;

static double um_of(double mm) {
    return fmax(1000 * mm, LEAST_UM);
}

/* ----------------------------------------------------------------------------------------------- verdict */

static const wh_command_record_t *command_of(const wh_record_t *record,
                                             const wh_centring_record_t *centring) {
    return wh_is_index(centring->command, record->command_count) ? &record->commands[centring->command]
                                                                 : NULL;
}

static end_t end_of(const wh_command_record_t *command) {
    if (!command || !(command->end_s > command->begin_s)) {
        return NOT_TOLD;
    }
    if (command->error == WH_OK) {
        return WENT_ON;
    }
    return command->error == WH_STATUS_CENTRE_NOT_SURE || command->error == WH_STATUS_TOO_FEW_SAMPLES
               ? FAILED_SO
               : FAILED_ELSE;
}

/* True if the log's states contradict what motion control did. */
static bool is_other(const wh_centring_record_t *centring, const wh_command_record_t *command) {
    const end_t end = end_of(command);
    const wh_status_t status = centring->status;
    return centring->repeated &&
           ((status != WH_OK && end == WENT_ON) || (end == FAILED_SO && command->error != status));
}

static void put_reason(char *line, wh_status_t why) {
    const char *how = why == WH_STATUS_CENTRE_NOT_SURE        ? "not sure"
                      : why == WH_STATUS_CORRECTION_TOO_LARGE ? "not to be used"
                                                              : "no estimate";
    (void)snprintf(line, WH_CENTRING_LINE_BYTES, "%s: %s (%d %s)", how, wh_record_error_text(why), (int)why,
                   wh_status_name(why));
}

/* Writes that a log's states contradict the command's end. */
static void put_other(char *line, wh_status_t status, const wh_command_record_t *command) {
    const int length =
        snprintf(line, WH_CENTRING_LINE_BYTES, "not told: this log's states alone give %d %s, but ",
                 (int)status, wh_status_name(status));
    if (command->error == WH_OK) {
        (void)snprintf(line + length, (size_t)(WH_CENTRING_LINE_BYTES - length),
                       "the command was done: motion control knew more");
    } else {
        (void)snprintf(line + length, (size_t)(WH_CENTRING_LINE_BYTES - length),
                       "the command ended with %d %s", (int)command->error, wh_status_name(command->error));
    }
}

static void put_verdict(const wh_centring_record_t *centring, const wh_command_record_t *command,
                        wh_centring_words_t *words) {
    const bool is_too_large = command && command->error == WH_STATUS_CORRECTION_TOO_LARGE;
    const wh_status_t why =
        centring->status == WH_OK && is_too_large ? WH_STATUS_CORRECTION_TOO_LARGE : centring->status;
    const bool other = is_other(centring, command);
    words->verdict = why;
    words->is_sure = why == WH_OK && !centring->repeated;
    if (other) {
        put_other(words->lines[VERDICT], centring->status, command);
    } else if (why != WH_OK) {
        put_reason(words->lines[VERDICT], why);
    } else {
        (void)snprintf(words->lines[VERDICT], WH_CENTRING_LINE_BYTES, "%s",
                       centring->repeated ? "not told: this log's states alone, without a notch's direction, "
                                            "would be sure of this"
                                          : "sure");
    }
}

/* ------------------------------------------------------------------------------------------------- result */

static void put_centre(char *line, const wh_centring_record_t *centring) {
    const wh_centres_t *centres = &centring->centres;
    const wh_centring_offset_t one = wh_centring_offset(centring, 0);
    const wh_centring_offset_t other = wh_centring_offset(centring, 1);
    if (centres->count == 0) {
        (void)snprintf(line, WH_CENTRING_LINE_BYTES, "centre: not told");
    } else if (isnan(one.dx)) {
        (void)snprintf(line, WH_CENTRING_LINE_BYTES,
                       "centre: x %.4f, y %.4f mm on the blade; in the slot's frame it is not told",
                       centres->candidates[0].x, centres->candidates[0].y);
    } else if (centring->status != WH_OK && centres->count > 1) {
        (void)snprintf(line, WH_CENTRING_LINE_BYTES,
                       "centre, not sure: dX %.4f, dY %.4f mm or dX %.4f, dY %.4f mm", one.dx, one.dy,
                       other.dx, other.dy);
    } else {
        (void)snprintf(line, WH_CENTRING_LINE_BYTES,
                       "centre%s: dX %.4f, dY %.4f mm in the slot's frame, standard deviations %.2f and %.2f "
                       "\u00b5m, in the worst direction %.2f \u00b5m",
                       centring->status == WH_OK ? "" : ", not sure", one.dx, one.dy, um_of(one.sd_dx),
                       um_of(one.sd_dy), um_of(centres->candidates[0].sd_centre));
    }
}

static void put_radius(char *line, const wh_centring_record_t *centring) {
    const wh_centring_t *known = &centring->known;
    const wh_centre_t *centre = centring->centres.count > 0 ? &centring->centres.candidates[0] : NULL;
    if (!(known->sd_radius > 0)) {
        (void)snprintf(line, WH_CENTRING_LINE_BYTES, "radius: %.4f mm, taken as exact", known->radius);
    } else if (centre) {
        (void)snprintf(line, WH_CENTRING_LINE_BYTES,
                       "radius: %.4f mm found, %.4f mm expected with a standard deviation of %.1f \u00b5m",
                       centre->radius, known->radius, um_of(known->sd_radius));
    } else {
        (void)snprintf(line, WH_CENTRING_LINE_BYTES,
                       "radius: not told, %.4f mm expected with a standard deviation of %.1f \u00b5m",
                       known->radius, um_of(known->sd_radius));
    }
}

/* -------------------------------------------------------------------------------------------- what it had */

static size_t count_use(const wh_centring_record_t *centring, wh_crossing_use_t use) {
    size_t count = 0;
    for (size_t k = 0; centring->centres.count > 0 && k < centring->count; ++k) {
        count += centring->centres.candidates[0].use[k] == use ? 1 : 0;
    }
    return count;
}

static double rms_of(const wh_centring_record_t *centring) {
    double sum = 0;
    size_t count = 0;
    for (size_t k = 0; centring->centres.count > 0 && k < centring->count; ++k) {
        if (centring->centres.candidates[0].use[k] == WH_CROSSING_USED) {
            const double residual = wh_centring_residual(centring, 0, k);
            sum += residual * residual;
            ++count;
        }
    }
    return count > 0 ? sqrt(sum / (double)count) : 0;
}

static void put_crossings(char *line, const wh_centring_record_t *centring) {
    int length = snprintf(line, WH_CENTRING_LINE_BYTES, "crossings: %zu, latches missed: %lld",
                          centring->count, (long long)centring->missed);
    if (centring->centres.count > 0) {
        length += snprintf(line + length, (size_t)(WH_CENTRING_LINE_BYTES - length),
                           "; %s%zu of the rim, residuals %.2f \u00b5m rms; left out: %zu for the notch, "
                           "%zu as none of the rim",
                           centring->centres.count > 1 ? "used for the first place: " : "used: ",
                           count_use(centring, WH_CROSSING_USED), 1000 * rms_of(centring),
                           count_use(centring, WH_CROSSING_NOTCH), count_use(centring, WH_CROSSING_OTHER));
    }
    if (centring->skipped) {
        length += snprintf(line + length, (size_t)(WH_CENTRING_LINE_BYTES - length),
                           "; the simulator has missed slices of the pass");
    }
    if (centring->lacking > 0) {
        (void)snprintf(line + length, (size_t)(WH_CENTRING_LINE_BYTES - length),
                       "; this log lacks %lld slices of the pass", (long long)centring->lacking);
    }
}

static void put_notch(char *line, const wh_centring_record_t *centring) {
    const wh_centring_t *known = &centring->known;
    if (!(known->notch_width > 0)) {
        (void)snprintf(line, WH_CENTRING_LINE_BYTES, "notch: by the layout wafers have none");
    } else if (known->notch_known) {
        (void)snprintf(line, WH_CENTRING_LINE_BYTES,
                       "notch: towards %.4f\u00b0 on the blade, by ALIGN, standard deviation %.4f\u00b0",
                       wh_deg_from_rad(known->notch_direction),
                       fmax(wh_deg_from_rad(known->sd_notch), LEAST_DEG));
    } else if (centring->repeated) {
        (void)snprintf(
            line, WH_CENTRING_LINE_BYTES,
            "notch: a log does not tell if motion control knew its direction; here it counts as not "
            "known");
    } else {
        (void)snprintf(line, WH_CENTRING_LINE_BYTES,
                       "notch: its direction is not known, the crossings alone tell if one met it");
    }
}

static void put_command(char *line, const wh_centring_record_t *centring,
                        const wh_command_record_t *command) {
    const end_t end = end_of(command);
    int length = 0;
    if (!command) {
        length = snprintf(line, WH_CENTRING_LINE_BYTES, "command: not told");
    } else if (end == NOT_TOLD || end == WENT_ON) {
        length = snprintf(line, WH_CENTRING_LINE_BYTES, "command: %.100s, %s", command->text,
                          end == WENT_ON ? "done" : "its end is not told");
    } else {
        length = snprintf(line, WH_CENTRING_LINE_BYTES, "command: %.100s, failed with %d %s", command->text,
                          (int)command->error, wh_status_name(command->error));
    }
    if (centring->repeated) {
        (void)snprintf(line + length, (size_t)(WH_CENTRING_LINE_BYTES - length),
                       "; estimated again from the log's states");
    }
}

void wh_centring_words(const wh_record_t *record, const wh_centring_record_t *centring,
                       wh_centring_words_t *words) {
    const wh_command_record_t *command = command_of(record, centring);
    put_verdict(centring, command, words);
    put_centre(words->lines[CENTRE], centring);
    put_radius(words->lines[RADIUS], centring);
    put_crossings(words->lines[CROSSINGS], centring);
    put_notch(words->lines[NOTCH], centring);
    put_command(words->lines[COMMAND], centring, command);
}
