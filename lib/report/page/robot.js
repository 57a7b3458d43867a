/* Where grippers and the arm's links are: their own poses where the document has them, else what follows from the axes. */
(function (W) {
    'use strict';

    const [THETA, R, Z, YAW] = [0, 1, 2, 3];

    const axis = (tracks, i, at) => W.tracks.curve(tracks.axes[i], at, false);
    const about = (angle) => [0, 0, Math.sin(angle / 2), Math.cos(angle / 2)];
    const mount = (tracks, i) => tracks.machine.grippers[i] || null;

    function effectorOfAxes(tracks, at) {
        const [theta, r, z, yaw] = [THETA, R, Z, YAW].map((i) => axis(tracks, i, at));
        return [theta, r, z, yaw].includes(null) ? null
            : { r: [r * Math.cos(theta), r * Math.sin(theta), z], q: about(theta + yaw) };
    }

    function ofAxes(tracks, fixed, at) {
        if (fixed.axis === null) {
            const end = effectorOfAxes(tracks, at);
            return end && W.pose.compose(end, fixed);
        }
        const angle = axis(tracks, fixed.axis, at);
        return angle === null ? null : { r: fixed.r, q: W.pose.multiply(fixed.q, about(angle)) };
    }

    /* base_from_gripper, or null where nothing tells. */
    function gripper(tracks, i, at) {
        const fixed = mount(tracks, i);
        return W.tracks.pose(tracks.grippers[i], at) || (fixed && ofAxes(tracks, fixed, at));
    }

    /* base_from_effector, by the first gripper on the robot. */
    function effector(tracks, at) {
        const i = tracks.machine.grippers.findIndex((fixed) => fixed.axis === null);
        const found = i < 0 ? null : gripper(tracks, i, at);
        return found && W.pose.compose(found, W.pose.inverse(mount(tracks, i)));
    }

    /* A level body, its x along (x, y); along that of `other` where it has no length. */
    function level(r, x, y, other) {
        return { r, q: Math.hypot(x, y) > 1e-9 ? about(Math.atan2(y, x)) : other.q };
    }

    /* As collision/arm.h says: the column's lift, the upper arm, the forearm, the hand. */
    function links(tracks, at) {
        const end = effector(tracks, at);
        if (!end) {
            return null;
        }
        const { reach, link, right_handed: right } = tracks.machine.arm;
        const wrist = W.pose.subtract(end.r, W.pose.axis(end.q, 0).map((x) => reach * x));
        const shoulder = [0, 0, end.r[2]];
        const out = level(shoulder, wrist[0], wrist[1], end);
        const half = Math.hypot(wrist[0], wrist[1]) / 2;
        const aside = Math.sqrt(Math.max(link * link - half * half, 0));
        const elbow = W.pose.add(shoulder, W.pose.rotate(out.q, [Math.min(half, link), right ? -aside : aside, 0]));
        return [{ r: shoulder, q: about(0) }, level(shoulder, elbow[0], elbow[1], out),
            level(elbow, wrist[0] - elbow[0], wrist[1] - elbow[1], out), { r: wrist, q: end.q }];
    }

    const link = (tracks, i, at) => (links(tracks, at) || [])[i] || null;

    W.robot = { gripper, link };
}(window.Waferhand));
