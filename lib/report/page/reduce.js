/* Curves made as short as the screen is wide: of the points within a pixel the lowest and the highest stay, and cubics get
 * a point every few pixels. Done when the shown window changes, never while time passes. */
(function (W) {
    'use strict';

    const PIXELS = 3; /* from point to point of a cubic */
    const PARTS = 64; /* of one cubic, at most */

    /* The points of one curve within a window, and one beyond it on either side: [times, values]. */
    function curve(from, window, columns) {
        const first = Math.max(W.tracks.index(from.t, window[0]), 0);
        const last = Math.min(W.tracks.index(from.t, window[1]) + 1, from.t.length - 1);
        return last - first >= 4 * columns ? extremes(from, first, last, window, columns)
            : all(from, first, last, (window[1] - window[0]) * PIXELS / columns);
    }

    /* How many parts a cubic is drawn in; between equal values with no slope it is one. */
    function parts(from, i, last, apart) {
        if (!from.smooth || i === last || from.read(i, 0) === null || from.read(i + 1, 0) === null) {
            return 1;
        }
        const flat = from.read(i, 0) === from.read(i + 1, 0) && from.read(i, 0.5) === from.read(i, 0);
        return flat ? 1 : W.clamp(Math.ceil((from.t[i + 1] - from.t[i]) / apart), 1, PARTS);
    }

    /* All points, those of cubics at most so far apart. */
    function all(from, first, last, apart) {
        const t = [];
        const v = [];
        for (let i = first; i <= last; ++i) {
            const count = parts(from, i, last, apart);
            for (let k = 0; k < count; ++k) {
                t.push(k === 0 ? from.t[i] : from.t[i] + k / count * (from.t[i + 1] - from.t[i]));
                v.push(from.read(i, k / count));
            }
        }
        return [t, v];
    }

    /* A gap counts as a value of its own, so that curves end where they did. */
    function extremes(from, first, last, window, columns) {
        const t = [];
        const v = [];
        const values = Array.from({ length: last - first + 1 }, (_, i) => from.read(first + i, 0));
        const keep = (i) => { t.push(from.t[i]); v.push(values[i - first]); };
        const width = (window[1] - window[0]) / columns;
        let i = first;
        while (i <= last) {
            const end = Math.max(from.t[i], window[0]) + width;
            const begin = i;
            let [low, high] = [i, i];
            const gap = values[begin - first] === null;
            for (; i <= last && from.t[i] < end && (values[i - first] === null) === gap; ++i) {
                low = values[i - first] < values[low - first] ? i : low;
                high = values[i - first] > values[high - first] ? i : high;
            }
            i = Math.max(i, begin + 1);
            Array.from(new Set([begin, low, high, i - 1])).sort((a, b) => a - b).forEach(keep);
        }
        return [t, v];
    }

    /* Rows for dygraphs: the times of all curves, null where a curve has no point, NaN where it has a gap. */
    function rows(curves, window, columns) {
        const shown = curves.map((each) => curve(each, window, columns));
        const next = shown.map(() => 0);
        const made = [];
        for (;;) {
            const t = shown.reduce((least, [times], i) => (next[i] < times.length ? Math.min(least, times[next[i]])
                : least), Infinity);
            if (t === Infinity) {
                return made;
            }
            made.push([t].concat(shown.map(([times, values], i) => {
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
