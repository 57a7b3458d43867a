/* The paths of the robot's grippers over the last seconds: a line, and a dot for each tenth of a second. Dots far apart mean a
 * high speed. */
(function (W) {
    'use strict';

    const SECONDS = 3;
    const STEP = 0.02;
    const EACH = 5; /* steps from dot to dot */

    const riders = (doc) => doc.names.grippers.map((_, i) => i).filter((i) => {
        const mount = doc.tracks.machine.grippers[i];
        return mount && mount.axis === null;
    });

    /* The places where a gripper was, the latest first, mm of base: [{ r, age: 0 to 1, dot }]. The steps lie on a grid of time,
     * so that dots stay in place while time passes. */
    function points(doc, i, t) {
        const made = [];
        const add = (at, dot) => {
            const pose = W.robot.gripper(doc.tracks, i, at);
            if (pose) {
                made.push({ r: pose.r, age: (t - at) / SECONDS, dot });
            }
        };
        const from = Math.max(t - SECONDS, W.clock.begin);
        add(t, false);
        for (let k = Math.floor(t / STEP); k * STEP >= from; --k) {
            add(k * STEP, k % EACH === 0);
        }
        return made;
    }

    W.trail = { SECONDS, riders, points, most: Math.ceil(SECONDS / STEP) + 2 };
}(window.Waferhand));
