/* Bars over time, a lane in each row, on the plots' time axis. They are drawn on a canvas, and only those in the window. */
(function (W) {
    'use strict';

    const ROW = 26;
    const AXIS = 20;
    const RIGHT = 10;
    const MISS = 3; /* pixels */
    const charts = [];
    const lanes = {};

    const left = () => W.axis.gutter() - 9;
    const width = (chart) => Math.max(chart.canvas.clientWidth - left() - RIGHT, 10);
    const spot = (chart, t) => left() + width(chart) * (t - W.clock.window[0]) / (W.clock.window[1] - W.clock.window[0]);

    /* Times for the axis, 1, 2 or 5 times a power of ten apart. */
    function steps(from, to, count) {
        const raw = (to - from) / count;
        const power = Math.pow(10, Math.floor(Math.log10(raw)));
        const step = [1, 2, 5, 10].find((factor) => factor * power >= raw) * power;
        const lowest = Math.ceil(from / step);
        return Array.from({ length: Math.max(Math.floor(to / step) - lowest + 1, 0) },
            (_, i) => (lowest + i) * step);
    }

    function drawAxis(chart, pen, height) {
        pen.strokeStyle = W.theme.colour('rule');
        pen.fillStyle = W.theme.colour('dim');
        pen.textAlign = 'center';
        steps(...W.clock.window, Math.max(width(chart) / 90, 2)).forEach((t) => {
            const x = Math.round(spot(chart, t)) + 0.5;
            pen.beginPath();
            pen.moveTo(x, 0);
            pen.lineTo(x, height - AXIS);
            pen.stroke();
            pen.fillText(`${W.tick(t, W.clock.window[1] - W.clock.window[0])}\u00a0s`, x, height - 5);
        });
        pen.textAlign = 'left';
    }

    /* Draws as much of a text as there is room for. */
    function drawText(pen, text, x, y, room) {
        if (room < 14) {
            return;
        }
        let shown = text;
        while (shown.length > 1 && pen.measureText(shown).width > room) {
            shown = shown.slice(0, -2) + '\u2026';
        }
        if (shown !== '\u2026') {
            pen.fillText(shown, x, y);
        }
    }

    function drawBar(chart, pen, bar, y, i) {
        const begin = Math.max(spot(chart, bar.from), left());
        const end = Math.min(spot(chart, bar.to), left() + width(chart));
        const wide = Math.max(end - begin, 1);
        pen.globalAlpha = bar.level !== undefined ? 0.35 : bar.alternate && i % 2 ? 0.82 : 1;
        pen.fillStyle = W.theme.colour(bar.colour);
        const high = (ROW - 8) * (bar.level === undefined ? 1 : bar.level);
        pen.fillRect(begin, y + ROW - 4 - high, wide, high);
        pen.globalAlpha = 1;
        if (bar.level !== undefined) {
            pen.fillStyle = W.theme.colour('ink');
            drawText(pen, wide > 20 ? bar.text : '', begin + 5, y + ROW / 2 + 4, wide - 9);
        } else if (wide > 20) {
            pen.fillStyle = W.theme.colour('panel');
            pen.fillRect(begin, y + 4, 1, ROW - 8);
            pen.fillStyle = W.theme.colour('on-series');
            drawText(pen, bar.text || '', begin + 5, y + ROW / 2 + 4, wide - 9);
        }
    }

    /* Draws an outline around the bars of the chosen wafer, and a thicker one around the bar in hand. */
    function mark(chart, pen, bar, y) {
        const isInHand = chart.bar === bar;
        if (isInHand || (chart.group.marked && chart.group.marked(bar))) {
            const begin = Math.max(spot(chart, bar.from), left());
            const end = Math.min(spot(chart, bar.to), left() + width(chart));
            pen.strokeStyle = W.theme.colour('ink');
            pen.lineWidth = isInHand ? 3 : 2;
            pen.strokeRect(begin, y + 3, Math.max(end - begin, 1), ROW - 6);
            pen.lineWidth = 1;
        }
    }

    /* The number of bars before the first that is not `before`; bars are in order and do not overlap. */
    function countBefore(bars, before) {
        let low = 0;
        let high = bars.length;
        while (low < high) {
            const middle = (low + high) >> 1;
            if (before(bars[middle])) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        return low;
    }

    /* The first bar that ends at t or later, and the first that begins after it. */
    const first = (bars, t) => countBefore(bars, (bar) => bar.to < t);
    const after = (bars, t) => countBefore(bars, (bar) => bar.from <= t);

    /* Draws bars that are too dense as shares of each column's time: the height is the share, and the colours are stacked. */
    function drawShares(chart, pen, bars, y) {
        W.bands.shares(bars, W.clock.window, width(chart)).forEach((column, i) => {
            let bottom = y + ROW - 4;
            column.forEach((share, colour) => {
                const high = colour === 'bad' ? Math.max(share * (ROW - 8), 2) : share * (ROW - 8);
                pen.fillStyle = W.theme.colour(colour);
                pen.fillRect(left() + i * W.bands.WIDE, bottom - high, W.bands.WIDE, high);
                bottom -= high;
            });
        });
    }

    function drawBars(chart, pen, lane, y) {
        const begin = first(lane.bars, W.clock.window[0]);
        const end = after(lane.bars, W.clock.window[1]);
        lane.dense = W.bands.areDense(begin, end, width(chart));
        if (lane.dense) {
            drawShares(chart, pen, lane.bars.slice(begin, end), y);
            return;
        }
        for (let i = begin; i < end; ++i) {
            drawBar(chart, pen, lane.bars[i], y, i);
        }
        lane.bars.slice(begin, end).forEach((bar) => mark(chart, pen, bar, y));
    }

    /* Draws a level from 0 to 1, filled. */
    function drawCurve(chart, pen, lane, y) {
        const bottom = y + ROW - 4;
        const rows = W.reduce.rows([lane.curve], W.clock.window, width(chart));
        pen.save();
        pen.beginPath();
        pen.rect(left(), y, width(chart), ROW);
        pen.clip();
        pen.beginPath();
        pen.moveTo(left(), bottom);
        rows.forEach(([t, v]) => pen.lineTo(spot(chart, t), bottom - (ROW - 8) * v));
        pen.lineTo(rows.length > 0 ? Math.max(spot(chart, rows[rows.length - 1][0]), left() + width(chart)) : left(),
            bottom - (ROW - 8) * (rows.length > 0 ? rows[rows.length - 1][1] : 0));
        pen.lineTo(left() + width(chart), bottom);
        pen.fillStyle = W.theme.colour(lane.colour);
        pen.globalAlpha = 0.35;
        pen.fill();
        pen.globalAlpha = 1;
        pen.strokeStyle = W.theme.colour(lane.colour);
        pen.stroke();
        pen.restore();
    }

    function drawLane(chart, pen, lane, i) {
        const y = i * ROW;
        pen.fillStyle = W.theme.colour('ink');
        drawText(pen, lane.name, 2, y + ROW / 2 + 4, left() - 8);
        pen.strokeStyle = W.theme.colour('rule');
        pen.strokeRect(left() + 0.5, y + 3.5, width(chart), ROW - 7);
        if (lane.curve) {
            drawCurve(chart, pen, lane, y);
        }
        drawBars(chart, pen, lane, y);
    }

    function draw(chart) {
        const scale = window.devicePixelRatio || 1;
        const height = chart.group.lanes.length * ROW + AXIS;
        chart.canvas.style.height = height + 'px';
        chart.canvas.width = chart.canvas.clientWidth * scale;
        chart.canvas.height = height * scale;
        const pen = chart.canvas.getContext('2d');
        pen.scale(scale, scale);
        pen.font = '12px system-ui, "DejaVu Sans", sans-serif';
        drawAxis(chart, pen, height);
        chart.group.lanes.forEach((lane, i) => drawLane(chart, pen, lane, i));
        chart.banded.hidden = !chart.group.lanes.some((lane) => lane.dense);
        follow(chart);
    }

    const follow = (chart) => W.axis.place(chart.cursor, left(), width(chart));

    const timeAt = (chart, event) => {
        const x = event.clientX - chart.canvas.getBoundingClientRect().left - left();
        return W.clock.window[0] + (W.clock.window[1] - W.clock.window[0]) * W.clamp(x / width(chart), 0, 1);
    };

    /* The bar under a pointer, which may miss a narrow one by a little, or null. */
    function barAt(chart, event) {
        const row = Math.floor((event.clientY - chart.canvas.getBoundingClientRect().top) / ROW);
        const lane = chart.group.lanes[row];
        const t = timeAt(chart, event);
        const slack = MISS * (W.clock.window[1] - W.clock.window[0]) / width(chart);
        const found = lane ? lane.bars.slice(first(lane.bars, t - slack), after(lane.bars, t + slack)) : [];
        return found.find((bar) => bar.from <= t && bar.to > t) || found[0] || null;
    }

    /* A click takes the time there, a drag zooms, a double click shows the whole run again. */
    function listen(chart) {
        let from = null;
        chart.canvas.addEventListener('pointerdown', (event) => { from = event; });
        W.listen(window, 'pointerup', (event) => {
            if (from && Math.abs(event.clientX - from.clientX) > 5) {
                const times = [timeAt(chart, from), timeAt(chart, event)].sort((a, b) => a - b);
                W.clock.setWindow(...times);
            } else if (from) {
                W.clock.seek(timeAt(chart, from));
                (chart.group.choose || (() => {}))(barAt(chart, from));
            }
            from = null;
        });
        chart.canvas.addEventListener('dblclick', W.clock.reset);
    }

    function make(group) {
        const names = group.lanes.map((lane) => lane.name).join(', ');
        const chart = { group, canvas: W.element('canvas', { class: 'lanes', role: 'img',
            'aria-label': `${group.title} over time: ${names}; in figures in the tables below` }),
        cursor: W.element('div', { class: 'cursor' }),
        banded: W.element('p', { class: 'note banded', hidden: true }, 'A bar is as high as its share of the time, where bars '
            + 'lie too close to be seen one by one.') };
        charts.push(chart);
        listen(chart);
        W.observe(chart.canvas, () => draw(chart));
        const readout = group.choose ? [W.hand.listen(chart, barAt, draw)] : [];
        return [W.element('div', { class: 'frame' }, chart.canvas, chart.cursor), ...readout, chart.banded];
    }

    /* A chart of a document that grows is hidden until it has something to show. */
    lanes.section = function (group) {
        const body = group.lanes.length > 0 || W.clock.grows ? make(group) : [W.why(group.why)];
        if (group.note && group.lanes.length > 0 && !W.clock.grows) {
            body.push(W.why(group.note));
        }
        const made = W.element('section', { class: 'group', id: group.id }, W.element('h2', {}, group.title), ...body);
        const chart = charts.find((each) => each.group === group);
        if (chart) {
            chart.section = made;
            made.hidden = group.lanes.length === 0;
        }
        return made;
    };

    /* The lanes of a document that has grown. */
    lanes.renew = function (groups) {
        charts.forEach((chart) => {
            chart.group = groups.find((group) => group.id === chart.group.id) || chart.group;
            chart.section.hidden = chart.group.lanes.length === 0;
            draw(chart);
        });
    };

    lanes.start = function () {
        W.clock.on('time', () => charts.forEach(follow));
        W.clock.on('window', () => charts.forEach(draw));
        W.theme.on(() => charts.forEach(draw));
    };

    lanes.showAll = () => charts.forEach(draw);

    W.lanes = lanes;
}(window.Waferhand));
