/* Curves made as short as the screen is wide: of the points within a pixel the lowest and the highest stay. Done when
 * the shown window changes, never while time passes. */
(function (W) {
    'use strict';

    /* The points of one curve within a window, and one beyond it on either side: [times, values]. */
    function curve(from, window, columns) {
        const first = Math.max(W.tracks.index(from.t, window[0]), 0);
        const last = Math.min(W.tracks.index(from.t, window[1]) + 1, from.t.length - 1);
        const count = last - first + 1;
        return count <= 4 * columns ? [from.t.slice(first, last + 1), from.v.slice(first, last + 1)]
            : extremes(from, first, last, window, columns);
    }

    /* A gap counts as a value of its own, so that curves end where they did. */
    function extremes(from, first, last, window, columns) {
        const t = [];
        const v = [];
        const keep = (i) => { t.push(from.t[i]); v.push(from.v[i]); };
        const width = (window[1] - window[0]) / columns;
        let i = first;
        while (i <= last) {
            const end = Math.max(from.t[i], window[0]) + width;
            const begin = i;
            let [low, high] = [i, i];
            for (; i <= last && from.t[i] < end && (from.v[i] === null) === (from.v[begin] === null); ++i) {
                low = from.v[i] < from.v[low] ? i : low;
                high = from.v[i] > from.v[high] ? i : high;
            }
            i = Math.max(i, begin + 1);
            Array.from(new Set([begin, low, high, i - 1])).sort((a, b) => a - b).forEach(keep);
        }
        return [t, v];
    }

    /* A curve of steps goes on to the end of the run. */
    function closed(from, end) {
        const last = from.t[from.t.length - 1];
        return from.step && last < end ? { t: from.t.concat(end), v: from.v.concat(from.v[from.v.length - 1]) } : from;
    }

    /* Rows for dygraphs: the times of all curves, null where a curve has no point, NaN where it has a gap. */
    function rows(curves, window, columns, end) {
        const parts = curves.map((each) => curve(closed(each, end), window, columns));
        const next = parts.map(() => 0);
        const made = [];
        for (;;) {
            const t = parts.reduce((least, [times], i) => (next[i] < times.length ? Math.min(least, times[next[i]])
                : least), Infinity);
            if (t === Infinity) {
                return made;
            }
            made.push([t].concat(parts.map(([times, values], i) => {
                if (next[i] >= times.length || times[next[i]] !== t) {
                    return null;
                }
                const value = values[next[i]++];
                return value === null ? NaN : value;
            })));
        }
    }

    W.reduce = { rows };
}(window.Waferhand));
