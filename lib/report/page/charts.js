/* Drawings of a study: histograms, clouds of points, correlations with their intervals. They are SVG, made from plain
 * numbers. */
(function (W) {
    'use strict';

    const { shape } = W;

    const picture = (width, height, label) => shape('svg', { class: 'chart', viewBox: `0 0 ${width} ${height}`, role: 'img',
        'aria-label': label });

    /* Steps of 1, 2 or 5 times a power of ten, about `count` of them. */
    function ticks(low, high, count) {
        const rough = (high - low) / count;
        const power = Math.pow(10, Math.floor(Math.log10(rough)));
        const step = [1, 2, 5, 10].map((times) => times * power).find((each) => each >= rough) || 10 * power;
        const made = [];
        for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) {
            made.push(i * step);
        }
        return made;
    }

    const scale = (low, high, from, to) => (value) => from + (value - low) / (high - low) * (to - from);

    /* Draws counts as bars, with the smallest and largest value below them. */
    function histogram(of, name) {
        const [width, height, left, bottom] = [300, 150, 8, 128];
        const made = picture(width, height, `Histogram of ${name}`);
        const most = Math.max(...of.counts, 1);
        const step = (width - 2 * left) / of.counts.length;
        const flat = of.high - of.low < 1e-9;
        of.counts.forEach((count, i) => {
            const tall = 100 * count / most;
            const bar = shape('rect', { class: 'bar', x: left + i * step, y: bottom - tall, width: Math.max(step - 1, 1),
                height: tall });
            const at = (k) => W.figure(of.low + k * (of.high - of.low) / of.counts.length);
            bar.append(shape('title', {}, `${at(i)} to ${at(i + 1)}: about ${Math.round(count)} trials`));
            made.append(bar);
        });
        made.append(shape('path', { class: 'axis', d: `M${left} ${bottom}H${width - left}` }),
            shape('text', { class: 'name', x: left, y: 16 }, name));
        const values = flat ? [of.low] : ticks(of.low, of.high, 4);
        const x = flat ? () => width / 2 : scale(of.low, of.high, left, width - left);
        values.forEach((value) => made.append(shape('text', { x: W.clamp(x(value), left + 14, width - left - 14), y: height - 6,
            'text-anchor': 'middle' }, flat ? W.figure(value) : W.tick(value, of.high - of.low))));
        return made;
    }

    /* The square that holds all points and limits, with a little room. */
    function reach(points, limits) {
        const sides = (at, tolerance) => [at - tolerance, at + tolerance];
        const xs = points.map((point) => point.x).concat(...limits.map((box) => sides(box.dx, box.tolerance)));
        const ys = points.map((point) => point.y).concat(...limits.map((box) => sides(box.dy, box.tolerance)));
        const ends = (values) => [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))];
        const [x, y] = [ends(xs), ends(ys)];
        const half = 0.54 * Math.max(x[1] - x[0], y[1] - y[0], 1e-6);
        return { x: (x[0] + x[1]) / 2, y: (y[0] + y[1]) / 2, half };
    }

    function grid(made, around, x, y, size, left) {
        ticks(around.x - around.half, around.x + around.half, 5).forEach((value) => made.append(
            shape('path', { class: 'rule', d: `M${x(value)} 8V${size}` }),
            shape('text', { x: x(value), y: size + 16, 'text-anchor': 'middle' }, W.tick(value, 2 * around.half))));
        ticks(around.y - around.half, around.y + around.half, 5).forEach((value) => made.append(
            shape('path', { class: 'rule', d: `M${left} ${y(value)}H${left + size - 8}` }),
            shape('text', { x: left - 5, y: y(value) + 4, 'text-anchor': 'end' }, W.tick(value, 2 * around.half))));
    }

    /* Draws points { x, y, ok, trial } and the boxes that they should be in; `choose` is called with the clicked trial. */
    function cloud(points, limits, name, choose) {
        const [size, left] = [420, 58];
        const made = picture(left + size, size + 40, `Where ${name} ends in each trial`);
        const around = reach(points, limits);
        const x = scale(around.x - around.half, around.x + around.half, left, left + size - 8);
        const y = scale(around.y - around.half, around.y + around.half, size, 8);
        grid(made, around, x, y, size, left);
        limits.forEach((box) => made.append(shape('rect', { class: 'limit', x: x(box.dx - box.tolerance),
            y: y(box.dy + box.tolerance), width: x(box.tolerance) - x(-box.tolerance),
            height: y(-box.tolerance) - y(box.tolerance) })));
        points.slice().sort((a, b) => b.ok - a.ok).forEach((point) => {
            const dot = shape('circle', { class: point.ok ? 'point' : 'point bad', cx: x(point.x), cy: y(point.y),
                r: point.ok ? 2.2 : 3.4, 'data-trial': point.trial, click: () => choose(point.trial) });
            dot.append(shape('title', {}, `trial ${point.trial}: dX ${W.figure(point.x)}, dY ${W.figure(point.y)} mm, `
                + (point.ok ? 'ok' : 'failed')));
            made.append(dot);
        });
        made.append(shape('rect', { class: 'axis', x: left, y: 8, width: size - 8, height: size - 8 }),
            shape('text', { x: left + size / 2, y: size + 34, 'text-anchor': 'middle' }, 'dX, mm'),
            shape('text', { x: 2, y: 18 }, 'dY, mm'));
        return made;
    }

    /* Draws correlations { name, r, low, high }, each a dot on its interval; null means not determined. */
    function correlations(rows, label) {
        const [width, left, row] = [760, 210, 22];
        const bottom = 8 + row * rows.length;
        const made = picture(width, bottom + 26, label);
        const x = scale(-1, 1, left, width - 20);
        [-1, -0.5, 0, 0.5, 1].forEach((value) => made.append(shape('path', { class: value === 0 ? 'axis' : 'rule',
            d: `M${x(value)} 4V${bottom}` }), shape('text', { x: x(value), y: bottom + 18, 'text-anchor': 'middle' },
            W.number(value, 1))));
        rows.forEach((each, i) => {
            const y = 8 + row * (i + 0.5);
            made.append(shape('text', { class: 'name', x: left - 12, y: y + 4, 'text-anchor': 'end' }, each.name));
            if (!each.found) {
                made.append(shape('text', { x: x(0) + 8, y: y + 4 }, 'not determined'));
                return;
            }
            const { r, low, high } = each.found;
            const range = shape('path', { class: low > 0 || high < 0 ? 'range sure' : 'range', d: `M${x(low)} ${y}H${x(high)}` });
            range.append(shape('title', {}, `${W.number(r, 3)}, from ${W.number(low, 3)} to ${W.number(high, 3)}`));
            made.append(range, shape('circle', { class: 'mean', cx: x(r), cy: y, r: 3.5 }));
        });
        return made;
    }

    W.charts = { histogram, cloud, correlations };
}(window.Waferhand));
