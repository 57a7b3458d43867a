/* The kinds of events and their looks, and an event in words. */
(function (W) {
    'use strict';

    const BAD = ['hit', 'slipped', 'vacuum_lost', 'released_unsupported', 'slot_occupied', 'bad_input',
        'pushed_through'];
    const WARN = ['near_miss', 'too_close', 'contested', 'undecided', 'placed_off_centre', 'placed_askew', 'fault_armed'];

    /* The kinds that make a run fail, whatever it expected. */
    const COMPLAINTS = ['bad_input', 'released_unsupported', 'slot_occupied', 'placed_off_centre', 'placed_askew', 'hit',
        'undecided', 'too_close', 'slipped', 'pushed_through'];
    const isComplaint = (kind) => COMPLAINTS.includes(kind);

    /* The name of the colour in the style sheet. */
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
