/* Shows edge scans, one at a time: rho over theta with the fitted circle, the residuals on a scale of their own, and the
 * estimate in words. */
(function (W) {
    'use strict';

    const RAD = 180 / Math.PI;
    const FRAME = 'directions in the chuck\u2019s frame, which is the station\u2019s while the chuck is at 0\u00b0';
    const scans = { graphs: [], shown: 0, busy: false };

    /* The circle's rim in a direction, seen from the axis. */
    function circleAt(circle, theta) {
        const along = circle.x * Math.cos(theta) + circle.y * Math.sin(theta);
        const aside = circle.x * Math.sin(theta) - circle.y * Math.cos(theta);
        return along + Math.sqrt(circle.radius * circle.radius - aside * aside);
    }

    /* The samples in the order of their directions. A null where the rim is not seen breaks the line and leaves a gap. */
    function samples(scan) {
        return scan.theta
            .map((theta, i) => ({ theta, rho: scan.rho[i], residual: scan.residual[i], counts: scan.counts[i] === 1 }))
            .filter((each) => each.theta !== null).sort((a, b) => a.theta - b.theta);
    }

    const um = (mm) => (mm === null ? null : 1000 * mm);

    const rimRows = (scan) => samples(scan).map(({ theta, rho }) => [theta * RAD, rho,
        scan.circle ? circleAt(scan.circle, theta) : null]);

    const residualRows = (scan) => samples(scan).map(({ theta, residual, counts }) => [theta * RAD, counts ? um(residual) : null,
        counts ? null : um(residual)]);

    /* The residuals that count fill the scale; those at a notch would flatten them. */
    function residualRange(rows) {
        const most = rows.reduce((high, row) => Math.max(high, Math.abs(row[1] || 0)), 0);
        return most > 0 ? [-1.25 * most, 1.25 * most] : [-1, 1];
    }

    /* The notch or flat, where the axis sees it. */
    function drawMark(scan) {
        return (pen, { x, y, w, h }, graph) => {
            const at = scan.mark ? graph.toDomXCoord(scan.mark.at * RAD) : -1;
            if (at < x || at > x + w) {
                return;
            }
            pen.save();
            pen.strokeStyle = W.theme.colour('warn');
            pen.fillStyle = W.theme.colour('warn');
            pen.setLineDash([6, 4]);
            pen.beginPath();
            pen.moveTo(at, y);
            pen.lineTo(at, y + h);
            pen.stroke();
            pen.font = '12px system-ui, "DejaVu Sans", sans-serif';
            pen.textAlign = at > x + w / 2 ? 'right' : 'left';
            pen.fillText(scan.mark.kind + (scan.sure ? '' : ', not sure'), at + (at > x + w / 2 ? -5 : 5), y + h - 6);
            pen.restore();
        };
    }

    /* Zooming one zooms the other. */
    function follow(graph) {
        const window = graph.xAxisRange();
        if (!scans.busy) {
            scans.busy = true;
            scans.graphs.filter((each) => each !== graph).forEach((each) => each.updateOptions({ dateWindow: window }));
            scans.busy = false;
        }
    }

    const extent = ([from, to]) => to - from;
    const degrees = (value, granularity, how, graph) => W.tick(value, extent(graph.xAxisRange())) + '\u00b0';
    const values = (value, granularity, how, graph) => W.tick(value, extent(graph.yAxisRange()));

    function looks(kind) {
        const colours = kind.curves.map((curve) => W.theme.series(curve.colour));
        return { colors: colours, axisLineColor: W.theme.colour('line'), gridLineColor: W.theme.colour('rule') };
    }

    function options(kind, scan, rows) {
        const series = {};
        kind.curves.forEach((curve) => { series[curve.name] = curve.look; });
        return Object.assign({
            labels: ['theta'].concat(kind.curves.map((curve) => curve.name)), series, legend: 'never', animatedZooms: false,
            strokeWidth: 1.4, highlightCircleSize: 0, rightGap: 10, dateWindow: [0, 360], valueRange: kind.range(rows),
            underlayCallback: drawMark(scan),
            axes: { x: { axisLabelFormatter: degrees, pixelsPerLabel: 62 },
                y: { axisLabelFormatter: values, axisLabelWidth: W.axis.gutter() - 14, pixelsPerLabel: 24 } },
            drawCallback: (graph, initial) => { if (!initial) { follow(graph); } },
        }, looks(kind));
    }

    const dots = (pointSize) => ({ drawPoints: true, pointSize, strokeWidth: 0 });

    const KINDS = [
        { name: '\u03c1 over \u03b8', unit: 'mm', rows: rimRows, range: () => null, curves: [
            { name: 'samples', colour: 0, dash: 0, look: { strokeWidth: 1.8 } },
            { name: 'fitted circle', colour: 1, dash: 1, look: { strokePattern: [8, 3] } }] },
        { name: 'residuals', unit: '\u00b5m', rows: residualRows, range: residualRange,
            note: 'those of notch, flats and chips may leave the scale', curves: [
                { name: 'of samples that count', colour: 0, look: dots(1.3) },
                { name: 'of masked samples', colour: 1, look: dots(2.6) }] },
    ];

    function legend(curve) {
        const sign = curve.dash === undefined ? { class: 'dot', style: `background: var(--s${curve.colour})` }
            : { class: `swatch dash${curve.dash}`, style: `--c: var(--s${curve.colour})` };
        return W.element('span', { class: 'item' }, W.element('i', sign), curve.name);
    }

    function figure(kind) {
        kind.host = W.element('div', { class: 'graph scan', role: 'img',
            'aria-label': `${kind.name} of the shown scan, ${kind.unit}; the estimate in words is beside` });
        const note = kind.note ? [W.element('span', { class: 'note' }, kind.note)] : [];
        return W.element('figure', { class: 'panel' }, W.element('figcaption', {},
            W.element('span', { class: 'name' }, kind.name), W.element('span', { class: 'unit' }, kind.unit),
            ...kind.curves.map(legend), ...note), W.element('div', { class: 'frame' }, kind.host));
    }

    const place = (scan) => W.shown.names.stations[scan.station] || W.shown.names.grippers[scan.gripper];

    const title = (scan) => `scan ${scan.number} at ${place(scan)}`;

    function words(scan) {
        const [verdict, ...rest] = scan.words;
        const kind = scan.sure ? 'good' : 'warn';
        return [W.element('p', {}, W.element('span', { class: 'verdict ' + kind }, (scan.sure ? '\u2713 ' : '? ') + verdict)),
            W.element('ul', {}, ...rest.map((line) => W.element('li', {}, line)))];
    }

    function draw(kind, scan) {
        const rows = kind.rows(scan);
        if (rows.length === 0) {
            kind.host.replaceChildren(W.why('No sample of this scan was taken.'));
            return [];
        }
        kind.host.replaceChildren();
        return [new window.Dygraph(kind.host, rows, options(kind, scan, rows))];
    }

    /* Shows one of the scans, by its place in the document. */
    function show(i) {
        const scan = scans.all[i];
        scans.shown = i;
        scans.choice.value = String(i);
        scans.words.replaceChildren(...words(scan));
        scans.seek.textContent = `${W.number(scan.begin_s, 3)} to ${W.number(scan.end_s, 3)} s`;
        scans.graphs.forEach((graph) => graph.destroy());
        scans.graphs = [];
        scans.graphs = KINDS.flatMap((kind) => draw(kind, scan));
    }

    function choose(i) {
        show(i);
        W.say(`${title(scans.all[i])}: ${scans.all[i].words[0]}`);
    }

    function step(by) {
        choose(W.clamp(scans.shown + by, 0, scans.all.length - 1));
    }

    const button = (text, name, click) => W.element('button', { type: 'button', 'aria-label': name, title: name, click }, text);

    function controls(leftOut) {
        scans.choice = W.element('select', { 'aria-label': 'Scan', change: () => choose(Number(scans.choice.value)) },
            ...scans.all.map((scan, i) => W.element('option', { value: i }, `${title(scan)}: ${scan.words[0]}`)));
        scans.seek = W.element('button', { type: 'button', class: 'time', title: 'Show this time',
            click: () => W.clock.seek(scans.all[scans.shown].end_s) });
        const row = W.element('div', { class: 'row' }, button('\u2039', 'The scan before', () => step(-1)), scans.choice,
            button('\u203a', 'The next scan', () => step(1)), scans.seek);
        return leftOut > 0 ? [row, W.why(`${leftOut} more scans are not shown: a report holds 500,000 samples.`)] : [row];
    }

    scans.start = function (doc, host) {
        scans.all = doc.scans;
        if (scans.all.length === 0) {
            return;
        }
        scans.words = W.element('div', { class: 'words' });
        host.append(W.element('section', { class: 'group', id: 'scans' },
            W.element('h2', {}, 'Edge scans ', W.element('small', {}, FRAME)),
            ...controls(doc.scansLeftOut), W.element('div', { class: 'scans' }, scans.words,
                W.element('div', {}, ...KINDS.map(figure)))));
        show(0);
        W.theme.on(() => scans.graphs.forEach((graph, i) => graph.updateOptions(looks(KINDS[i]))));
    };

    /* Makes the plots as wide as the page, for paper. */
    scans.resize = () => scans.graphs.forEach((graph) => graph.resize());

    W.scans = scans;
}(window.Waferhand));
