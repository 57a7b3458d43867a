/* Where the time of a flow's robots and stations went: a bar for each, whose parts add up to all of it. */
(function (W) {
    'use strict';

    /* By class its colour, and whether it is hatched; no colour: nothing was done. */
    const ROBOTS = { pick: ['s0'], place: ['s0', true], swap: ['s3'], loaded_way: ['s1'], empty_way: ['s1', true], door: ['s5'],
        waits_wafer: ['s4'], waits_place: ['s4', true], waits_clean: ['s2', true], waits_pump: ['s3', true],
        waits_down: ['bad', true], waits_robot: ['s5', true], idle: [null] };
    const STATIONS = { process: ['s0'], handled: ['s5'], clean: ['s2'], pump: ['s3'], blocked: ['s4'], stored: ['s5', true],
        down: ['bad'], empty: [null] };
    const TEXTS = { blocked: 'done, and waits', handled: 'a blade or the door', stored: 'holds wafers',
        loaded_way: 'moves loaded', empty_way: 'moves empty', pick: 'picks', place: 'places', swap: 'swaps',
        waits_wafer: 'waits for a wafer',
        waits_place: 'waits for a place', waits_clean: 'waits for a clean', waits_pump: 'waits for a pump',
        waits_down: 'waits, station down', waits_robot: 'waits for a robot' };

    const text = (name) => TEXTS[name] || W.words(name);
    const percent = (share) => `${W.number(100 * share, 1)}\u00a0%`;
    const paint = ([colour, hatched]) => (colour === null ? { class: 'piece none' }
        : { class: hatched ? 'piece hatched' : 'piece', colour });

    function piece(name, look, share) {
        const { class: kind, colour } = paint(look);
        return W.element('i', { class: kind, title: `${text(name)} ${percent(share)}`,
            style: `width: ${(100 * share).toFixed(4)}%; --c: var(--${colour || 'panel'})` });
    }

    /* The classes that any of them has, in their order. */
    const used = (all, looks) => Object.keys(looks).filter((name) => all.some((each) => each.shares[name] > 0));

    function legend(names, looks) {
        return W.element('p', { class: 'row legend' }, ...names.map((name) => {
            const { class: kind, colour } = paint(looks[name]);
            return W.element('span', { class: 'item' }, W.element('i', { class: `box ${kind}`,
                style: `--c: var(--${colour || 'panel'})` }), text(name));
        }));
    }

    function bars(all, looks, names) {
        return all.map((each) => W.element('div', { class: 'share-row' }, W.element('span', { class: 'name', title: each.name },
            each.name), W.element('span', { class: 'pieces', role: 'img', 'aria-label': `${each.name}: ${names
            .filter((name) => each.shares[name] > 0).map((name) => `${text(name)} ${percent(each.shares[name])}`).join(', ')}` },
        ...names.filter((name) => each.shares[name] > 0).map((name) => piece(name, looks[name], each.shares[name])))));
    }

    /* The figures of the bars, to be unfolded. */
    function table(all, names, heading, more) {
        const heads = [heading, ...names.map((name) => `${text(name)} %`), ...more.map(([name]) => name)];
        const rows = all.map((each) => W.tables.row([each.name, ...names.map((name) => W.tables.num(W.number(100
            * (each.shares[name] || 0), 1))), ...more.map(([, tell]) => tell(each))]));
        const head = W.element('tr', {}, ...heads.map((name, i) => W.element('th', { scope: 'col',
            class: i > 0 && i <= names.length ? 'number' : null }, name)));
        const body = W.element('table', {}, W.element('thead', {}, head), W.element('tbody', {}, ...rows));
        return W.element('details', {}, W.element('summary', {}, 'In figures'), W.element('div', { class: 'scroll', tabindex: 0,
            role: 'region', 'aria-label': `${heading}s in figures` }, body));
    }

    function block(all, looks, heading, more) {
        const names = used(all, looks);
        return [W.element('h3', {}, `${heading}s`), ...bars(all, looks, names), legend(names, looks),
            table(all, names, heading, more)];
    }

    /* For whom its done wafers waited most. */
    function blocker(station) {
        const all = Object.entries(station.blocked_by || {}).sort((a, b) => b[1] - a[1]);
        return all.length > 0 ? all[0][0] : W.DASH;
    }

    function section(model) {
        const { flow } = model;
        const told = (list) => list.map((each) => Object.assign({ shares: {} }, each));
        const stations = block(told(flow.stations), STATIONS, 'Station', [['done wafers waited most for', blocker]]);
        const robots = block(told(flow.robots), ROBOTS, 'Robot', []);
        return W.element('section', { class: 'group', id: 'shares' }, W.element('h2', {}, 'Where the time went ',
            W.element('small', {}, `shares of ${W.seconds(model.end)}`)),
        W.element('div', { class: 'halves' }, W.element('div', {}, ...stations), W.element('div', {}, ...robots)));
    }

    W.flowShares = { section };
}(window.Waferhand));
