/* Tracks: changes as points over time. Every look-up is a binary search; no work is done for each point. */
(function (W) {
    'use strict';

    /* The last point at or before `at`; -1 before the first. */
    function index(times, at) {
        let low = 0;
        let high = times.length;
        while (low < high) {
            const middle = (low + high) >> 1;
            if (times[middle] <= at) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        return low - 1;
    }

    /* The last such point of a list of objects with a `t`. */
    function indexOf(list, at) {
        let low = 0;
        let high = list.length;
        while (low < high) {
            const middle = (low + high) >> 1;
            if (list[middle].t <= at) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        return low - 1;
    }

    /* The two points that `at` lies between, and the share of the way: 0 at a point and outside of the track. */
    function span(times, at) {
        const found = index(times, at);
        const from = Math.max(found, 0);
        const last = from + 1 >= times.length || found < 0;
        const to = last ? from : from + 1;
        return { from, to, share: last ? 0 : (at - times[from]) / (times[to] - times[from]) };
    }

    /* Reads straight lines between values; null values are gaps. */
    function linear(times, values, at) {
        if (!times || times.length === 0) {
            return null;
        }
        const { from, to, share } = span(times, at);
        const a = values[from];
        const b = values[to];
        if (share === 0 || a === null || b === null) {
            return share === 0 ? a : null;
        }
        return a + share * (b - a);
    }

    /* A curve between its points i and i + 1, `share` of the way, or its slope. It is null in a gap, and after the last point
     * it stays as it was. */
    function cubic({ t, v, slope: slopes }, i, share, slope) {
        const a = v[i];
        const b = v[i + 1];
        if (share === 0) {
            return slope ? slopes[i] : a;
        }
        if (a === null || b === null) {
            return null;
        }
        if (b === undefined) {
            return slope ? 0 : a;
        }
        const width = t[i + 1] - t[i];
        const first = width * slopes[i];
        const last = width * slopes[i + 1];
        const second = 3 * (b - a) - 2 * first - last;
        const third = first + last - 2 * (b - a);
        return slope ? (first + share * (2 * second + 3 * share * third)) / width
            : a + share * (first + share * (second + share * third));
    }

    /* The value of a curve at a time; null before its first point. */
    function curve(from, at, slope) {
        if (!from || !from.t || from.t.length === 0 || at < from.t[0]) {
            return null;
        }
        const i = index(from.t, at);
        const share = i + 1 < from.t.length ? (at - from.t[i]) / (from.t[i + 1] - from.t[i]) : at - from.t[i];
        return cubic(from, i, share, slope);
    }

    function step(times, values, at) {
        return times && times.length > 0 ? values[Math.max(index(times, at), 0)] : null;
    }

    const slice = (values, i, size) => values.slice(size * i, size * i + size);

    /* Normalizes a quaternion; rounding makes it a little longer or shorter than 1. */
    function point(track, i) {
        return { r: slice(track.r, i, 3), q: W.pose.unit(slice(track.q, i, 4)) };
    }

    /* The pose on a track of poses; null for a track without points and before its first point. */
    function pose(track, at) {
        if (!track || !track.t || track.t.length === 0 || at < track.t[0]) {
            return null;
        }
        const { from, to, share } = span(track.t, at);
        return share === 0 ? point(track, from) : W.pose.between(point(track, from), point(track, to), share);
    }

    /* The holder of a wafer, from when on: { t, holder, r, q }; null for none. */
    function hold(states, at) {
        return states && states.length > 0 ? states[Math.max(indexOf(states, at), 0)] : null;
    }

    function wafer(tracks, i, at) {
        const state = hold(tracks.wafers[i], at);
        if (!state || state.holder === null || state.holder === undefined) {
            return state ? { r: state.r, q: W.pose.unit(state.q) } : null;
        }
        const gripper = W.robot.gripper(tracks, state.holder, at);
        return gripper && W.pose.compose(gripper, { r: state.r, q: W.pose.unit(state.q) });
    }

    W.tracks = { index, indexOf, linear, step, cubic, curve, pose, hold, wafer };
}(window.Waferhand));
