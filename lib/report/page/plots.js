/* Curves over time by dygraphs, on one time axis: zooming one zooms all, and a click takes the time there. Panels are made one
 * after the other when the page has time, and they are updated when they are seen. */
(function (W) {
    'use strict';

    const plots = { panels: [], seen: null, doc: null };

    const area = (panel) => panel.graph.getArea();

    const extent = ([from, to]) => to - from;
    const timeTick = (t, granularity, how, graph) => W.tick(t, extent(graph.xAxisRange())) + '\u00a0s';
    const valueTick = (value, granularity, how, graph) => W.tick(value, extent(graph.yAxisRange()));

    /* Fills from the lowest to the highest value in each column. */
    function drawBand(pen, graph, band, colour) {
        pen.fillStyle = colour;
        pen.globalAlpha = 0.28;
        band.t.forEach((t, i) => {
            if (band.low[i] !== null) {
                const [left, right] = [t - band.width / 2, t + band.width / 2].map((at) => graph.toDomXCoord(at));
                const [low, high] = [band.low[i], band.high[i]].map((value) => graph.toDomYCoord(value));
                pen.fillRect(left, high, right - left, Math.max(low - high, 1));
            }
        });
        pen.globalAlpha = 1;
    }

    function underlay(panel) {
        return (pen, area_, graph) => {
            drawLimits(panel, pen, area_, graph);
            pen.save();
            pen.beginPath();
            pen.rect(area_.x, area_.y, area_.w, area_.h);
            pen.clip();
            panel.bands.forEach((band, i) => {
                if (band) {
                    drawBand(pen, graph, band, W.theme.series(panel.curves[i].colour));
                }
            });
            pen.restore();
        };
    }

    /* Tints the allowed side of each limit, and draws the limit. */
    function drawLimits(panel, pen, { x, y, w, h }, graph) {
        panel.limits.forEach((limit) => {
            const at = W.clamp(graph.toDomYCoord(limit.value), y, y + h);
            pen.save();
            pen.fillStyle = W.theme.colour('allowed');
            pen.fillRect(x, limit.below ? at : y, w, limit.below ? y + h - at : at - y);
            pen.strokeStyle = W.theme.colour('bad');
            pen.setLineDash([6, 4]);
            pen.beginPath();
            pen.moveTo(x, at);
            pen.lineTo(x + w, at);
            pen.stroke();
            pen.restore();
        });
    }

    /* Differences smaller than this share of a value are not shown: ticks keep ten digits at most. */
    const LEAST_SHARE = 1e-8;

    /* Gives air around the middle of values that differ too little to be told apart. */
    function airOf(low, high) {
        return Math.max((high - low || 1) * 0.06, LEAST_SHARE * Math.max(Math.abs(low), Math.abs(high)));
    }

    /* The range of values, with the limit in sight and some air. */
    function valueRange(panel) {
        let [low, high] = panel.zero ? [0, 0] : [Infinity, -Infinity];
        const take = (v) => {
            if (v !== null) {
                low = v < low ? v : low;
                high = v > high ? v : high;
            }
        };
        panel.curves.forEach((curve) => W.reduce.range(curve).forEach(take));
        panel.limits.forEach((limit) => take(limit.value));
        [low, high] = low > high ? [0, 1] : [low, high];
        [low, high] = panel.most ? [Math.max(low, panel.most[0]), Math.min(high, panel.most[1])] : [low, high];
        const air = panel.most ? (high - low || 1) * 0.06 : airOf(low, high);
        return [panel.zero && low === 0 ? 0 : low - air, high + air];
    }

    function colours(panel) {
        return panel.curves.map((curve) => W.theme.series(curve.colour));
    }

    /* Dashes tell curves apart where colours do not. */
    const DASHES = [null, [8, 3], [2, 3], [10, 3, 2, 3], [4, 4], [14, 4]];

    function looks(panel) {
        const series = {};
        panel.curves.forEach((curve, i) => {
            series[curve.name] = { strokePattern: DASHES[i % DASHES.length] };
        });
        return { colors: colours(panel), series, axisLineColor: W.theme.colour('line'),
            gridLineColor: W.theme.colour('rule') };
    }

    function interaction() {
        const model = Object.assign({}, window.Dygraph.defaultInteractionModel);
        model.dblclick = (event, graph) => {
            graph.updateOptions({ valueRange: graph.panel.range }, true);
            W.clock.reset();
        };
        return model;
    }

    function options(panel) {
        return Object.assign({
            labels: ['t'].concat(panel.curves.map((curve) => curve.name)), legend: 'never', animatedZooms: false,
            connectSeparatedPoints: true, strokeWidth: 1.6, pointSize: 2.5, highlightCircleSize: 0,
            dateWindow: W.clock.window.slice(), valueRange: panel.range,
            rightGap: 10, underlayCallback: underlay(panel), interactionModel: interaction(),
            axes: {
                x: { axisLabelFormatter: timeTick, pixelsPerLabel: 62 },
                y: { axisLabelFormatter: valueTick, axisLabelWidth: W.axis.gutter() - 14, pixelsPerLabel: 20 },
            },
            clickCallback: (event) => W.clock.seek(panel.graph.toDataXCoord(panel.graph.eventToDomCoords(event)[0])),
            drawCallback: (graph, initial) => { if (!initial) { zoomed(panel); } },
        }, looks(panel));
    }

    /* The reader zoomed or moved this plot, and all the others follow. */
    function zoomed(panel) {
        const [from, to] = panel.graph.xAxisRange();
        const [low, high] = W.clock.window;
        const width = high - low;
        if (!panel.busy && (Math.abs(from - low) > 1e-6 * width || Math.abs(to - high) > 1e-6 * width)) {
            W.clock.setWindow(from, to);
        }
    }

    function data(panel) {
        panel.bands = [];
        const pixels = Math.max(panel.host.clientWidth - W.axis.gutter(), 100);
        const rows = W.reduce.rows(panel.curves, W.clock.window, pixels, panel.bands);
        panel.banded.hidden = !panel.bands.some(Boolean);
        return rows.length > 0 ? rows : [[W.clock.window[0]].concat(panel.curves.map(() => null))];
    }

    function legendItem(panel, curve, i) {
        const value = W.element('b', { class: 'value' });
        const note = W.element('span', { class: 'note' });
        const swatch = W.element('i', { class: `swatch dash${i % DASHES.length}`, style: `--c: var(--s${curve.colour % 6})` });
        panel.values.push({ curve, value, note });
        return W.element('span', { class: 'item' }, swatch, panel.curves.length > 1 ? curve.name + ' ' : '', value, ' ',
            W.element('span', { class: 'unit' }, curve.unit), note);
    }

    function frame(panel) {
        panel.values = [];
        panel.host = W.element('div', { class: 'graph', role: 'img',
            'aria-label': `${panel.title} over time; values at the shown time are above` });
        panel.cursor = W.element('div', { class: 'cursor', hidden: true });
        const items = panel.curves.map((curve, i) => legendItem(panel, curve, i));
        const limits = panel.limits.map((limit) => W.element('span', { class: 'limit' }, limit.text));
        panel.banded = W.element('span', { class: 'note banded', hidden: true }, 'line: mean, band: lowest to highest');
        panel.box = W.element('figure', { class: 'panel' },
            W.element('figcaption', {}, W.element('span', { class: 'name' }, panel.title), ...items, panel.banded, ...limits),
            W.element('div', { class: 'frame' }, panel.host, panel.cursor));
        return panel.box;
    }

    function draw(panel) {
        panel.range = valueRange(panel);
        panel.busy = true;
        panel.graph = new window.Dygraph(panel.host, data(panel), options(panel));
        panel.graph.panel = panel;
        panel.busy = false;
        panel.stale = false;
        panel.seen = true;
        plots.seen.observe(panel.box);
        follow(panel);
    }

    /* The range of values of a document that grows, unless a reader has chosen another one. */
    function widened(panel) {
        const [low, high] = panel.graph.yAxisRange();
        if (!W.clock.grows || low !== panel.range[0] || high !== panel.range[1]) {
            return {};
        }
        panel.range = valueRange(panel);
        return { valueRange: panel.range };
    }

    function refresh(panel) {
        if (!panel.graph || !panel.seen) {
            panel.stale = true;
            return;
        }
        panel.stale = false;
        panel.busy = true;
        panel.graph.updateOptions(Object.assign({ file: data(panel), dateWindow: W.clock.window.slice() }, widened(panel)));
        panel.busy = false;
        follow(panel);
    }

    function follow(panel) {
        if (!panel.graph || !panel.seen) {
            return;
        }
        const { x, w } = area(panel);
        W.axis.place(panel.cursor, x, w);
        panel.values.forEach(({ curve, value, note }) => {
            const now = curve.at(W.clock.now);
            value.textContent = W.number(now, curve.decimals);
            note.textContent = now !== null && curve.note ? ` ${curve.note(W.clock.now)}` : curve.bounds
                ? ` (${curve.bounds})` : '';
        });
    }

    function observe(entries) {
        entries.forEach((entry) => {
            const panel = plots.panels.find((each) => each.box === entry.target);
            panel.seen = entry.isIntersecting;
            if (panel.seen) {
                (panel.stale ? refresh : follow)(panel);
            }
        });
    }

    /* A group's section: its panels' frames, or the reason why there are none. */
    plots.section = function (group) {
        const body = group.panels.length > 0 ? group.panels.map(frame) : [W.why(group.why)];
        plots.panels.push(...group.panels);
        return W.element('section', { class: 'group', id: group.id }, W.element('h2', {}, group.title), ...body);
    };

    /* Makes all panels in the page's spare time, one at a time; `all` makes them at once. */
    plots.fill = function (all) {
        const due = plots.panels.filter((panel) => !panel.graph);
        due.slice(0, all ? due.length : 1).forEach(draw);
        if (due.length > 1 && !all) {
            plots.later = setTimeout(plots.fill, 0, false);
        }
    };

    /* Shows every panel, for paper. */
    plots.showAll = function () {
        plots.fill(true);
        plots.panels.forEach((panel) => {
            panel.seen = true;
            panel.graph.resize();
            refresh(panel);
        });
    };

    function repaint() {
        plots.panels.filter((panel) => panel.graph).forEach((panel) => panel.graph.updateOptions(looks(panel)));
    }

    function end() {
        clearTimeout(plots.later);
        plots.seen.disconnect();
        plots.panels.filter((panel) => panel.graph).forEach((panel) => panel.graph.destroy());
    }

    plots.start = function (doc) {
        plots.doc = doc;
        plots.seen = new IntersectionObserver(observe, { rootMargin: '200px' });
        W.atEnd(end);
        W.clock.on('time', () => plots.panels.forEach(follow));
        W.clock.on('window', () => plots.panels.forEach(refresh));
        W.clock.on('growth', () => plots.panels.forEach(refresh));
        W.theme.on(repaint);
        W.listen(window, 'resize', () => requestAnimationFrame(() => plots.panels.forEach(follow)));
    };

    W.plots = plots;
}(window.Waferhand));
