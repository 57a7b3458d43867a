/* A document that grows: what a source tells is added to its tracks and lists, in place, so that every part sees it.
 *
 * A curve has points that stay, and behind them samples of the present, until points for their time come: those have been
 * thinned by the program. `settled` counts the former. */
(function (W) {
    'use strict';

    const WIDTHS = { v: 1, slope: 1, r: 3, q: 4 };
    const columns = (track) => Object.keys(WIDTHS).filter((key) => Array.isArray(track[key]));

    function cut(track, count) {
        track.t.length = count;
        columns(track).forEach((key) => { track[key].length = WIDTHS[key] * count; });
    }

    function append(track, other, from) {
        for (let i = from; i < other.t.length; ++i) {
            track.t.push(other.t[i]);
        }
        columns(track).forEach((key) => {
            for (let i = WIDTHS[key] * from; i < other[key].length; ++i) {
                track[key].push(other[key][i]);
            }
        });
    }

    function take(track, from) {
        const taken = { t: track.t.slice(from) };
        columns(track).forEach((key) => { taken[key] = track[key].slice(WIDTHS[key] * from); });
        return taken;
    }

    /* Points that stay; the first of them may come again, with another slope. Samples before the last one go. */
    function settle(track, more) {
        if (!more || !more.t || more.t.length === 0) {
            return;
        }
        const samples = take(track, track.settled);
        let kept = track.settled;
        while (kept > 0 && track.t[kept - 1] >= more.t[0]) {
            --kept;
        }
        cut(track, kept);
        append(track, more, 0);
        track.settled = track.t.length;
        append(track, samples, samples.t.findIndex((t) => t > more.t[more.t.length - 1]) >>> 0);
    }

    /* The slope at a sample between two straight lines, such that the curve does not overshoot. */
    const between = (before, after) => (before * after > 0 ? 2 * before * after / (before + after) : 0);

    const line = (track, i) => (track.t[i] > track.t[i - 1] ? (track.v[i] - track.v[i - 1]) / (track.t[i] - track.t[i - 1]) : 0);

    /* While a value rests, its last sample moves on. */
    function rests(track, value) {
        const last = track.t.length - 1;
        return last - 1 >= track.settled && track.v[last] === value && track.v[last - 1] === value;
    }

    /* True if a sample tells nothing new: it is no later than the last, or a gap goes on. */
    const isOld = (track, last, t, value) => last >= 0
        && (track.t[last] >= t || (value === null && track.v[last] === null));

    /* The slope of a straight line to a point, 0 beside a gap. */
    const slopeTo = (track, i) => (i > 0 && track.v[i] !== null && track.v[i - 1] !== null ? line(track, i) : 0);

    /* A sample of a curve; null is a gap. */
    function sample(track, t, value) {
        const last = track.t.length - 1;
        if (isOld(track, last, t, value)) {
            return;
        }
        if (rests(track, value)) {
            track.t[last] = t;
            return;
        }
        track.t.push(t);
        track.v.push(value);
        track.slope.push(value === null ? null : slopeTo(track, last + 1));
        if (last > track.settled && track.v[last] !== null) {
            track.slope[last] = between(slopeTo(track, last), slopeTo(track, last + 1));
        }
    }

    function pose(track, t, place) {
        const last = track.t.length - 1;
        if (!place || (last >= 0 && track.t[last] >= t)) {
            return;
        }
        track.t.push(t);
        track.r.push(...place.r);
        track.q.push(...place.q);
    }

    const MEASURES = ['dr_proj_z', 'dr_proj_xy', 'n1_proj_n2'];
    const curvesOf = (all) => [].concat(all.axes, all.vacuum,
        ...all.proximity.map((track) => MEASURES.map((key) => track[key])));

    /* Adds the present: { t, axes, grippers, vacuum, proximity }. */
    function now(doc, what) {
        const { t } = what;
        const own = doc.tracks;
        what.axes.forEach((value, i) => sample(own.axes[i], t, value));
        what.vacuum.forEach((value, i) => sample(own.vacuum[i], t, value));
        what.grippers.forEach((place, i) => pose(own.grippers[i], t, place));
        what.proximity.forEach((values, i) => MEASURES.forEach((key, k) => sample(own.proximity[i][key], t, values[k])));
        doc.duration = Math.max(doc.duration, t);
    }

    function steps(own, more, kind) {
        more[kind].forEach((track, i) => append(own[kind][i], track, 0));
    }

    function extend(doc, more) {
        more.axes.forEach((track, i) => settle(doc.tracks.axes[i], track));
        more.vacuum.forEach((track, i) => settle(doc.tracks.vacuum[i], track));
        more.grippers.forEach((track, i) => settle(doc.tracks.grippers[i], track));
        more.proximity.forEach((track, i) => MEASURES.forEach((key) => settle(doc.tracks.proximity[i][key], track[key])));
        ['valves', 'sensors', 'nearest'].forEach((kind) => steps(doc.tracks, more, kind));
        more.wafers.forEach((stays, i) => doc.tracks.wafers[i].push(...stays));
    }

    /* Entries from one on replace those that are there. */
    function lists(doc, more) {
        Object.entries(more).forEach(([name, { from, list }]) => {
            doc.run[name].splice(from, Infinity, ...list);
            if (name === 'events') {
                doc.events.splice(from, Infinity, ...list.map(W.document.timed));
            }
        });
    }

    /* Adds what has come about since: { tracks, marks, lists, now }. */
    function add(doc, what) {
        extend(doc, what.tracks);
        doc.marks.push(...what.marks);
        lists(doc, what.lists);
        now(doc, what.now);
    }

    /* Makes a document one that grows; `first` is its present. */
    function begin(doc, first) {
        curvesOf(doc.tracks).concat(doc.tracks.grippers).forEach((track) => { track.settled = track.t.length; });
        doc.grows = true;
        if (first) {
            now(doc, first);
        }
    }

    W.growth = { begin, add, now };
}(window.Waferhand));
