/* Draws what is too dense for single lines. A curve shows the lowest, the highest and the mean value in each column of pixels.
 * Bars show how much of a column's time each colour takes. */
(function (W) {
    'use strict';

    const WIDE = 8; /* pixels of a column: a few cycles, otherwise one would see their beat with the columns */
    const TURNS = 6; /* with fewer pixels from turn to turn a curve is a comb */
    const BARS = 4; /* with fewer pixels from bar to bar bars are too dense */

    /* How often values turn from rising to falling, or back. */
    function turns(values) {
        let count = 0;
        let way = 0;
        for (let i = 1; i < values.length; ++i) {
            const step = values[i] === null || values[i - 1] === null ? 0 : Math.sign(values[i] - values[i - 1]);
            count += step !== 0 && step === -way ? 1 : 0;
            way = step || way;
        }
        return count;
    }

    /* The points of straight lines within a number of pixels; true if they are a comb. */
    const isComb = (values, pixels) => turns(values) * TURNS > pixels;

    /* Adds the part of a straight line within one column to that column. */
    function take(column, from, to, seconds) {
        column.low = Math.min(column.low, from, to);
        column.high = Math.max(column.high, from, to);
        column.sum += (from + to) / 2 * seconds;
        column.seconds += seconds;
    }

    /* Spreads one straight line, column by column. */
    function spread(columns, window, width, line) {
        const { t, v } = line;
        const value = (at) => (t[1] > t[0] ? v[0] + (v[1] - v[0]) * (at - t[0]) / (t[1] - t[0]) : v[1]);
        const last = Math.min(Math.floor((t[1] - window[0]) / width), columns.length - 1);
        for (let i = Math.max(Math.floor((t[0] - window[0]) / width), 0); i <= last; ++i) {
            const from = Math.max(t[0], window[0] + i * width);
            const to = Math.max(Math.min(t[1], window[0] + (i + 1) * width), from);
            take(columns[i], value(from), value(to), to - from);
        }
    }

    /* Returns { t, low, high, mean } of the columns; a column is null where the curve is a gap all over it. */
    function curve([times, values], window, pixels) {
        const count = Math.max(Math.floor(pixels / WIDE), 1);
        const width = (window[1] - window[0]) / count;
        const columns = Array.from({ length: count }, () => ({ low: Infinity, high: -Infinity, sum: 0, seconds: 0 }));
        for (let i = 0; i + 1 < times.length; ++i) {
            if (values[i] !== null && values[i + 1] !== null) {
                spread(columns, window, width, { t: [times[i], times[i + 1]], v: [values[i], values[i + 1]] });
            } else if (values[i] !== null) {
                spread(columns, window, width, { t: [times[i], times[i]], v: [values[i], values[i]] });
            }
        }
        const told = (column, value) => (column.low > column.high ? null : value);
        return { t: columns.map((_, i) => window[0] + (i + 0.5) * width), width,
            low: columns.map((column) => told(column, column.low)), high: columns.map((column) => told(column, column.high)),
            mean: columns.map((column) => told(column, column.seconds > 0 ? column.sum / column.seconds : column.low)) };
    }

    /* True if the bars `first` to `last`, in a window of that many pixels, are too narrow to be seen. */
    const areDense = (first, last, pixels) => (last - first) * BARS > pixels;

    /* For each column a map from colour to its share of the column's time. */
    function shares(bars, window, pixels) {
        const count = Math.max(Math.floor(pixels / WIDE), 1);
        const width = (window[1] - window[0]) / count;
        const columns = Array.from({ length: count }, () => new Map());
        bars.forEach((bar) => {
            const last = Math.min(Math.floor((bar.to - window[0]) / width), count - 1);
            for (let i = Math.max(Math.floor((bar.from - window[0]) / width), 0); i <= last; ++i) {
                const within = Math.min(bar.to, window[0] + (i + 1) * width) - Math.max(bar.from, window[0] + i * width);
                columns[i].set(bar.colour, (columns[i].get(bar.colour) || 0) + Math.max(within, 0) / width
                    * (bar.level === undefined ? 1 : bar.level));
            }
        });
        return columns;
    }

    W.bands = { WIDE, isComb, curve, areDense, shares };
}(window.Waferhand));
