/* What kinds of events there are for the eye, and an event in words. */
(function (W) {
    'use strict';

    const BAD = ['hit', 'slipped', 'vacuum_lost', 'released_unsupported', 'slot_occupied', 'bad_input'];
    const WARN = ['near_miss', 'too_close', 'contested', 'undecided', 'placed_off_centre', 'placed_askew', 'fault_armed'];

    /* Those for which a run fails, whatever it expected. */
    const COMPLAINTS = ['bad_input', 'released_unsupported', 'slot_occupied', 'placed_off_centre', 'placed_askew', 'hit',
        'undecided', 'too_close', 'slipped'];
    const isComplaint = (kind) => COMPLAINTS.includes(kind);

    /* The style sheet's name of the colour. */
    function colour(kind) {
        return BAD.includes(kind) ? 'bad' : WARN.includes(kind) ? 'warn' : 'accent';
    }

    function tell(event) {
        if (event.parts) {
            return `${W.words(event.kind)}: ${event.parts[0]} and ${event.parts[1]}`;
        }
        return [W.words(event.kind), event.wafer, event.gripper && 'by ' + event.gripper].filter(Boolean).join(' ');
    }

    W.events = { colour, tell, isComplaint };
}(window.Waferhand));
