/* Shows what the beams at a station's door tell of a wafer on its blade, one centring at a time. It draws the crossings and the
 * circles through them, the middle enlarged and the residuals, and gives the estimate in words. */
(function (W) {
    'use strict';

    const FRAME = 'places on the blade, in the gripper\u2019s frame';
    const { shape } = W;
    const centrings = { shown: 0 };

    const picture = (width, height, label) => shape('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img',
        'aria-label': label });

    const scale = (low, high, from, to) => (value) => from + (value - low) / (high - low) * (to - from);

    /* Steps of 1, 2 or 5 times a power of ten, about `count` of them on each side of 0. */
    function ticks(reach, count) {
        const rough = reach / count;
        const power = Math.pow(10, Math.floor(Math.log10(rough)));
        const apart = [1, 2, 5, 10].map((times) => times * power).find((each) => each >= rough);
        const most = Math.floor(reach / apart + 1e-9);
        return Array.from({ length: 2 * most + 1 }, (_, i) => (i - most) * apart);
    }

    const SIZE = 300;
    const LEFT = 46;
    const BELOW = 34;

    /* Draws a square of the blade's frame with its axes, `reach` mm to each side of the middle. */
    function square(reach, label) {
        const made = picture(SIZE + LEFT + 8, SIZE + BELOW + 8, label);
        const x = scale(-reach, reach, LEFT, LEFT + SIZE);
        const y = scale(-reach, reach, SIZE + 8, 8);
        made.append(shape('path', { class: 'axis', d: `M${LEFT} 8V${SIZE + 8}H${LEFT + SIZE}` }),
            shape('text', { x: LEFT + SIZE, y: SIZE + BELOW + 4, 'text-anchor': 'end' }, 'x, mm'),
            shape('text', { x: LEFT + 7, y: 18 }, 'y, mm'));
        ticks(reach, 2).forEach((value) => made.append(
            shape('text', { x: x(value), y: SIZE + 24, 'text-anchor': 'middle' }, W.tick(value, reach)),
            shape('text', { x: LEFT - 6, y: y(value) + 4, 'text-anchor': 'end' }, W.tick(value, reach)),
            shape('path', { class: 'rule', d: `M${x(value)} ${SIZE + 8}v-5M${LEFT} ${y(value)}h5` })));
        return { made, x, y };
    }

    const triangle = (x, y, up) => `M${x - 6} ${y + 4 * up}h12l-6 ${-10 * up}z`;

    /* The mark tells how a crossing is used: one that counts is filled, one that is left out is not. */
    function crossingMark({ edge, use, beam }, x, y) {
        const mark = use === 'rim' ? shape('path', { class: 'rim', d: triangle(x, y, edge === 'in' ? 1 : -1) })
            : use === 'notch' ? shape('rect', { class: 'notch', x: x - 5, y: y - 5, width: 10, height: 10 })
                : use === 'other' ? shape('path', { class: 'other', d: `M${x - 5} ${y - 5}l10 10m0 -10l-10 10` })
                    : shape('circle', { class: 'none', cx: x, cy: y, r: 5 });
        mark.append(shape('title', {}, `beam ${beam} ${edge}: ${use === 'none' ? 'not judged' : use}`));
        return mark;
    }

    /* Draws an arrow to the notch, if motion control knew its direction. */
    function notchArrow(known, x, y) {
        if (typeof known.notch_deg !== 'number') {
            return [];
        }
        const at = (part) => [x(part * known.radius * Math.cos(known.notch_deg * Math.PI / 180)),
            y(part * known.radius * Math.sin(known.notch_deg * Math.PI / 180))];
        const [from, to, text] = [at(0.8), at(0.99), at(0.68)];
        return [shape('path', { class: 'axis', d: `M${from.join(' ')}L${to.join(' ')}` }),
            shape('text', { x: text[0], y: text[1] + 4, 'text-anchor': 'middle' }, 'notch')];
    }

    function blade(centring) {
        const radius = W.shown.wafer.diameter / 2;
        const { made, x, y } = square(1.12 * radius, 'Crossings on the blade; the estimate in words is beside');
        const circle = (look, cx, cy, r) => shape('circle', { class: look, cx: x(cx), cy: y(cy), r: x(r) - x(0) });
        made.append(circle('nominal', 0, 0, radius),
            ...centring.candidates.map((each, i) => circle(`circle place${i}`, each.x, each.y, each.radius)),
            ...notchArrow(centring.known, x, y),
            ...centring.crossings.map((each) => crossingMark(each, x(each.x), y(each.y))));
        return made;
    }

    const dot = (i, x, y) => shape('circle', { class: `dot${i}`, cx: x, cy: y, r: 4.5 });

    function middle(centring) {
        const reach = Math.max(0.25, ...centring.candidates.map((each) => 1.3 * Math.max(Math.abs(each.x), Math.abs(each.y))));
        const { made, x, y } = square(reach, 'The wafer\u2019s centre beside the blade\u2019s middle');
        made.append(shape('path', { class: 'cross', d: `M${x(0) - 7} ${y(0)}h14M${x(0)} ${y(0) - 7}v14` }),
            ...centring.candidates.map((each, i) => dot(i, x(each.x), y(each.y))));
        return made;
    }

    /* The residuals of the crossings that count fill the scale; a residual at the notch would flatten them. */
    function residualScale(centring) {
        const counting = centring.candidates.flatMap((each) => each.residuals_um.filter((_, k) => each.uses[k] === 'rim'));
        return Math.max(1, ...counting.map((um) => 1.6 * Math.abs(um)));
    }

    function residuals(centring) {
        const count = centring.crossings.length;
        const most = residualScale(centring);
        const [width, height] = [Math.max(420, LEFT + 90 * count), 240];
        const made = picture(width, height, 'Residuals of the crossings, micrometres');
        const x = scale(0.5, Math.max(count, 1) + 0.5, LEFT, width - 8);
        const y = scale(-most, most, height - 34, 10);
        made.append(shape('path', { class: 'axis', d: `M${LEFT} 8V${height - 34}` }),
            shape('path', { class: 'rule', d: `M${LEFT} ${y(0)}H${width - 8}` }));
        ticks(most, 2).forEach((value) => made.append(
            shape('text', { x: LEFT - 6, y: y(value) + 4, 'text-anchor': 'end' }, W.tick(value, most))));
        centring.crossings.forEach((each, k) => made.append(
            shape('text', { x: x(k + 1), y: height - 10, 'text-anchor': 'middle' }, `beam ${each.beam} ${each.edge}`)));
        centring.candidates.forEach((each, i) => each.residuals_um.forEach((um, k) => made.append(Math.abs(um) <= most
            ? dot(i, x(k + 1), y(um))
            : shape('text', { class: `dot${i}`, x: x(k + 1), y: um > 0 ? 22 : height - 42, 'text-anchor': 'middle' },
                W.number(um, 1)))));
        return made;
    }

    const PANELS = [{ name: 'on the blade', draw: blade }, { name: 'middle, enlarged', draw: middle },
        { name: 'residuals, \u00b5m', draw: residuals, wide: true, note: 'in numbers where they leave the scale' }];

    /* The names of the two places; a place that is not sure is not called fitted. */
    function placeNames(centring) {
        if (centring.candidates.length === 2 && !centring.sure) {
            return ['likelier place', 'other place'];
        }
        const first = centring.error === 75 ? 'not likely' : 'fitted';
        return centring.candidates.map((_, i) => (i > 0 ? 'as near as the same' : first));
    }

    function sign(draw, text) {
        const made = shape('svg', { viewBox: '0 0 22 16', width: 22, height: 16, 'aria-hidden': 'true' });
        made.append(draw);
        return W.element('span', { class: 'item' }, made, ` ${text}`);
    }

    function key(centring) {
        const uses = new Set(centring.crossings.map((each) => each.use));
        const marks = [['rim', 'in', 'rim, coming in'], ['rim', 'out', 'rim, leaving'], ['notch', 'in', 'left out for the notch'],
            ['other', 'in', 'none of the rim'], ['none', 'in', 'not judged']].filter(([use]) => uses.has(use));
        const line = (look) => shape('path', { class: look, d: 'M1 8H21' });
        return W.element('p', { class: 'row blade' }, sign(line('nominal'), 'nominal, in the middle'),
            ...placeNames(centring).map((name, i) => sign(line(`circle place${i}`), name)),
            ...marks.map(([use, edge, text]) => sign(crossingMark({ use, edge, beam: 0 }, 11, 8),
                text + (centring.candidates.length === 2 && !centring.sure && use === 'notch' ? ' by the likelier place' : ''))));
    }

    function figure(panel, centring) {
        const note = panel.note ? [W.element('span', { class: 'note' }, panel.note)] : [];
        return W.element('figure', { class: panel.wide ? 'panel wide' : 'panel' }, W.element('figcaption', {},
            W.element('span', { class: 'name' }, panel.name), ...note), panel.draw(centring));
    }

    function words(centring) {
        const [verdict, ...rest] = centring.words;
        const kind = centring.sure ? 'good' : 'warn';
        return [W.element('p', {}, W.element('span', { class: 'verdict ' + kind }, (centring.sure ? '\u2713 ' : '? ') + verdict)),
            W.element('ul', {}, ...rest.map((line) => W.element('li', {}, line)))];
    }

    const title = (centring, i) => `${i + 1}: ${centring.wafer || 'a wafer'} on ${centring.gripper} into ${centring.station}`;

    /* Shows one of the centrings, by its place in the document. */
    function show(i) {
        const centring = centrings.all[i];
        centrings.shown = i;
        centrings.choice.value = String(i);
        centrings.words.replaceChildren(...words(centring));
        centrings.seek.textContent = W.seconds(centring.at_s);
        centrings.plots.replaceChildren(key(centring), W.element('div', { class: 'blade' },
            ...PANELS.map((panel) => figure(panel, centring))));
    }

    function choose(i) {
        show(i);
        W.say(`${title(centrings.all[i], i)}: ${centrings.all[i].words[0]}`);
    }

    function step(by) {
        choose(W.clamp(centrings.shown + by, 0, centrings.all.length - 1));
    }

    const button = (text, name, click) => W.element('button', { type: 'button', 'aria-label': name, title: name, click }, text);

    function controls(leftOut) {
        centrings.choice = W.element('select', { 'aria-label': 'Centring', change: () => choose(Number(centrings.choice.value)) },
            ...centrings.all.map((each, i) => W.element('option', { value: i }, `${title(each, i)}: ${each.words[0]}`)));
        centrings.seek = W.element('button', { type: 'button', class: 'time', title: 'Show this time',
            click: () => W.clock.seek(centrings.all[centrings.shown].at_s) });
        const row = W.element('div', { class: 'row' }, button('\u2039', 'The centring before', () => step(-1)), centrings.choice,
            button('\u203a', 'The next centring', () => step(1)), centrings.seek);
        return leftOut > 0 ? [row, W.why(`${leftOut} later ones are not shown: a report holds 500 of them.`)] : [row];
    }

    centrings.start = function (doc, host) {
        centrings.all = doc.centrings;
        if (centrings.all.length === 0) {
            return;
        }
        centrings.words = W.element('div', { class: 'words' });
        centrings.plots = W.element('div');
        host.append(W.element('section', { class: 'group', id: 'centrings' },
            W.element('h2', {}, 'Centring on the way ', W.element('small', {}, FRAME)),
            ...controls(doc.run.centrings_left_out || 0),
            W.element('div', { class: 'scans' }, centrings.words, centrings.plots)));
        show(0);
    };

    W.centrings = centrings;
}(window.Waferhand));
