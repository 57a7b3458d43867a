/* Teaching: the true pose of a station, from a robot's touches and from beams that it broke while it moved
 * there.
 *
 * The station was drawn, or taught by eye, so its x, y, z and yaw are known to about a quarter of a
 * millimetre; its tilt is known. The robot measures with its own axes. Each measurement is the gripper's
 * pose, as the controller assumes it, at the moment of a touch or of a latch (after subtracting its delay,
 * wh_beam_crossing). All measurements of a teaching go into one fit by weighted least squares. Its unknowns
 * are the station's x, y, z and yaw and the beam's own x and y, because the place of a beam is known only
 * to half a millimetre.
 *
 *   TOUCH    a ball of the gripper, such as the tip of a pin, meets a flat face of the station
 *   PIN      an upright beam meets the edge of a round pin, hole or disc of the gripper; this gives the
 *            beam's own place
 *   CARRIED  that beam meets the edge of a round part of the object that the gripper took from the
 *            station and carries: the rim of a known wafer, whose centre is the station's, or a hole in it
 *
 * By touch: two touches of a face across x, some 200 mm apart, one or two of a face across y, one from
 * above or below. By beam: a pin passes through the beam in both directions, at two distances of its axis
 * from the beam. The wafer is taken at the guess and carried through the beam at two distances; a round
 * hole near its edge gives yaw. The touch of the pick gives z, because upright beams give none. Values that
 * the measurements do not determine keep the guess, with the guess's standard deviation.
 *
 * For latches, a jitter of 10 us at v mm/s is v times 1e-5 mm. A remaining delay cancels if each edge is
 * passed in both directions at equal speeds. Lengths are in mm, angles in rad, poses in base. It uses no
 * heap and no state, and has equal bits on every machine.
 */
#ifndef WH_ALIGN_TEACHING_H
#define WH_ALIGN_TEACHING_H

#include "beam.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(teaching);

/* The most measurements of a teaching. */
#define WH_TEACH_MEASUREMENTS 256

typedef enum WH_FOUR_BYTES { WH_TEACH_TOUCH, WH_TEACH_PIN, WH_TEACH_CARRIED } wh_teach_kind_t;

typedef struct {
    wh_teach_kind_t kind;
    double sd;                   /* in mm, 1e-5 to 1: of a touch, or of a latch's time, times the speed */
    wh_pose_t base_from_gripper; /* at that moment */
    wh_pose_t base_from_pick;    /* CARRIED: the gripper's pose when it took the wafer */
    double x, y, z;   /* TOUCH: the ball's centre, gripper's frame; PIN: the circle's, z is ignored;
                       * CARRIED: the circle's in the station's frame as the wafer lay there, z is
                       * ignored */
    double radius;    /* of ball or circle, 0 to 300; at least 0.5 for a circle */
    double normal[3]; /* TOUCH: of the face, outwards, a unit vector of the station's frame */
    double distance;  /* TOUCH: from the station's origin to the face along its normal, -1e3 to 1e3 */
} wh_teach_measurement_t;

/* The values assumed before. Standard deviations are above 0. */
typedef struct {
    wh_pose_t base_from_station;
    double sd_place; /* of its x, y and z each, up to 10 */
    double sd_yaw;   /* up to 0.2 */
    wh_beam_t beam;  /* in base */
    double sd_beam;  /* of its x and y in base, up to 10 */
} wh_teach_guess_t;

typedef struct {
    wh_pose_t base_from_station;
    double shift[3], yaw; /* from the guess, along and about base's axes through the station's origin */
    double sd_shift[3], sd_yaw;
    double beam_x, beam_y; /* the beam's shift from the guess */
    double sd_beam[2];
    double mismatch; /* sum of squares of the residuals, in deviations; `count` on average */
    double largest;  /* residual of the worst measurement, in deviations */
    int32_t largest_index;
} wh_taught_t;

/* A typical guess: 0.25 mm, 0.5 degrees, and 0.5 mm for the beam, which stands at (x, y) of the station.
 * Nothing is checked. */
wh_teach_guess_t wh_teach_guess_at(const wh_pose_t *base_from_station, double x, double y)
    WH_SYMBOL(wh_teach_guess_at);

/* Returns WH_OK, or an error, which leaves `taught` unchanged. WH_STATUS_NULL_ARGUMENT.
 * WH_STATUS_NOT_FINITE, WH_STATUS_OUT_OF_RANGE and WH_STATUS_NOT_A_ROTATION for an error in the guess or in
 * a measurement; *bad, which may be null, is its index, or WH_NONE. WH_STATUS_TOO_FEW_SAMPLES if there are
 * none. WH_STATUS_CENTRE_NOT_SURE: they contradict each other or the guess by more than their deviations
 * allow once in a million, or a beam lies in the gripper's plane; *bad is then the measurement that fits
 * least, or WH_NONE. Cost: about 0.6 us for each measurement. */
wh_status_t wh_teach_solve(const wh_teach_guess_t *guess, const wh_teach_measurement_t *measurements,
                           size_t count, wh_taught_t *taught, int32_t *bad) WH_SYMBOL(wh_teach_solve);

WH_HEADER_END

#endif
