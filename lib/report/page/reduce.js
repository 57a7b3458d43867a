/* Reduces curves to the screen's width: of the points within a pixel the lowest and the highest stay, and cubics get a point
 * every few pixels. This happens when the shown window changes, never while time passes. */
(function (W) {
    'use strict';

    const PIXELS = 3; /* pixels from point to point of a cubic */
    const PARTS = 64; /* parts of one cubic, at most */
    const LEAST = 50; /* points of a comb, at least */

    /* The points of one curve within a window, and one beyond it on either side: [times, values]. A comb gives its means, and
     * its band as well. */
    function curve(from, window, columns) {
        const first = Math.max(W.tracks.index(from.t, window[0]), 0);
        const last = Math.min(W.tracks.index(from.t, window[1]) + 1, from.t.length - 1);
        const points = last - first > LEAST ? all(from, first, last, Infinity) : null;
        if (points && W.bands.isComb(points[1], columns)) {
            const band = W.bands.curve(points, window, columns);
            return [band.t, band.mean, band];
        }
        return last - first >= 4 * columns ? extremes(all(from, first, last, Infinity), window, columns)
            : all(from, first, last, (window[1] - window[0]) * PIXELS / columns);
    }

    /* The number of parts a cubic is drawn in. There are at least two, because slopes are often greatest half-way; there is one
     * where it rests. */
    function parts(from, i, last, apart) {
        if (!from.smooth || i === last || from.read(i, 0) === null || from.read(i + 1, 0) === null) {
            return 1;
        }
        const rests = from.read(i, 0) === from.read(i + 1, 0) && from.read(i, 0.5) === from.read(i, 0);
        return rests ? 1 : W.clamp(Math.ceil((from.t[i + 1] - from.t[i]) / apart), 2, PARTS);
    }

    /* All points; those of cubics are at most `apart` from each other. */
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
    function extremes([times, values], window, columns) {
        const t = [];
        const v = [];
        const keep = (i) => { t.push(times[i]); v.push(values[i]); };
        const width = (window[1] - window[0]) / columns;
        let i = 0;
        while (i < times.length) {
            const end = Math.max(times[i], window[0]) + width;
            const begin = i;
            let [low, high] = [i, i];
            for (; i < times.length && times[i] < end && (values[i] === null) === (values[begin] === null); ++i) {
                low = values[i] < values[low] ? i : low;
                high = values[i] > values[high] ? i : high;
            }
            i = Math.max(i, begin + 1);
            Array.from(new Set([begin, low, high, i - 1])).sort((a, b) => a - b).forEach(keep);
        }
        return [t, v];
    }

    /* Nearly all values that a curve takes; they give its range. */
    const range = (from) => all(from, 0, from.t.length - 1, Infinity)[1];

    /* Rows for dygraphs: the times of all curves, null where a curve has no point, NaN where it has a gap. `bands` receives the
     * band of each curve that is a comb. */
    function rows(curves, window, columns, bands) {
        const shown = curves.map((each) => curve(each, window, columns));
        shown.forEach(([, , band], i) => { (bands || [])[i] = band || null; });
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

    W.reduce = { rows, range };
}(window.Waferhand));
