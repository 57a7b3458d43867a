/* The poses of grippers and of the arm's links: the document's own poses if it has them, otherwise poses computed from the
 * axes. */
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

    /* base_from_gripper, or null if nothing gives it. */
    function gripper(tracks, i, at) {
        const fixed = mount(tracks, i);
        return W.tracks.pose(tracks.grippers[i], at) || (fixed && ofAxes(tracks, fixed, at));
    }

    /* base_from_effector, from the first gripper on the arm. */
    function effector(tracks, arm, at) {
        const i = tracks.machine.grippers.findIndex((fixed) => fixed.axis === null && (fixed.arm || 0) === arm.number
            && (fixed.robot || 0) === arm.robot);
        const found = i < 0 ? null : gripper(tracks, i, at);
        return found && W.pose.compose(found, W.pose.inverse(mount(tracks, i)));
    }

    /* A level body with its x along (x, y), or along that of `other` if (x, y) has no length. */
    function level(r, x, y, other) {
        return { r, q: Math.hypot(x, y) > 1e-9 ? about(Math.atan2(y, x)) : other.q };
    }

    const tilted = (angle, i) => [0, 1, 2].map((k) => (k === i ? Math.sin(angle / 2) : 0)).concat(Math.cos(angle / 2));
    const STILL = { r: [0, 0, 0], q: [0, 0, 0, 1] };

    /* A value of the arm's robot; null if it has no such axis. */
    function value(tracks, { chain, first }, name, at) {
        const i = chain ? chain.axes.indexOf(name) : -1;
        return i < 0 ? null : axis(tracks, first + i, at);
    }

    /* The column's foot and lift, and the plane of the arm (motion/chain.h). A usual robot's plane is base's. */
    function column(tracks, arm, at) {
        const of = (name) => value(tracks, arm, name, at) || 0;
        if (!arm.chain) {
            return { foot: STILL, plane: STILL };
        }
        const foot = W.pose.compose(arm.chain, { r: [of('rail'), 0, 0], q: STILL.q });
        const lift = W.pose.compose(foot, { r: [0, 0, of('z')], q: STILL.q });
        const tilt = W.pose.multiply(tilted(of('tilt_x'), 0), tilted(of('tilt_y'), 1));
        return { foot, lift, plane: W.pose.compose(lift, { r: [0, 0, 0], q: tilt }) };
    }

    /* From the blade as it is turned over to the blade with its face up; the hand is in line with the latter. */
    function unflipped(tracks, arm, at) {
        const angle = value(tracks, arm, 'flip', at);
        if (angle === null) {
            return STILL;
        }
        const up = { r: [0, 0, arm.chain.flip_height], q: tilted(-angle, 0) };
        return W.pose.compose(up, { r: [0, 0, -arm.chain.flip_height], q: STILL.q });
    }

    /* The lengths of upper arm and forearm, and whether the elbow is on the right. */
    function build(tracks, arm, at) {
        const { lengths, chain } = arm;
        const [upper, forearm] = chain && chain.links.length === 2 ? chain.links : [lengths.link, lengths.link];
        const elbow = value(tracks, arm, 'forearm', at);
        return { upper, forearm, right: elbow === null ? lengths.right_handed : elbow > 0 };
    }

    /* The bodies of collision/arm.h: the column, its lift, the upper arm, the forearm, the hand. */
    function bodies(tracks, arm, at) {
        const there = effector(tracks, arm, at);
        if (!there) {
            return null;
        }
        const { foot, lift, plane } = column(tracks, arm, at);
        const end = W.pose.compose(W.pose.compose(W.pose.inverse(plane), there), unflipped(tracks, arm, at));
        const { upper, forearm, right } = build(tracks, arm, at);
        const wrist = W.pose.subtract(end.r, W.pose.axis(end.q, 0).map((x) => arm.lengths.reach * x));
        const shoulder = [0, 0, arm.chain ? 0 : end.r[2]];
        const out = level(shoulder, wrist[0], wrist[1], end);
        const far = Math.hypot(wrist[0], wrist[1]);
        const along = upper === forearm ? far / 2 : (far * far + upper * upper - forearm * forearm) / (2 * far);
        const aside = Math.sqrt(Math.max(upper * upper - along * along, 0));
        const elbow = W.pose.add(shoulder, W.pose.rotate(out.q, [Math.min(along, upper), right ? -aside : aside, 0]));
        const links = [level(shoulder, elbow[0], elbow[1], out),
            level(elbow, wrist[0] - elbow[0], wrist[1] - elbow[1], out), { r: wrist, q: end.q }];
        return [foot, lift || { r: shoulder, q: about(0) }, ...links.map((body) => W.pose.compose(plane, body))];
    }

    /* base_from_door, or null if nothing gives it. */
    function door(tracks, i, at) {
        const { way, axis: moving } = tracks.machine.doors[i];
        const open = axis(tracks, moving, at);
        return open === null ? null : { r: way.map((x) => open * x), q: about(0) };
    }

    const BODIES = 5;

    /* The body of link i; with one arm the column comes last. */
    function link(tracks, i, at) {
        const { arms, bodies: numbers } = tracks.machine;
        const number = numbers.length > 0 ? numbers[i] : (i + 1) % BODIES;
        const arm = arms[Math.floor(number / BODIES)];
        return ((arm && bodies(tracks, arm, at)) || [])[number % BODIES] || null;
    }

    W.robot = { gripper, door, link };
}(window.Waferhand));
