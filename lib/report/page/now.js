/* The state at the shown time: each gripper's valve, vacuum and sensor, the wafer that it holds, and its pose against its
 * nearest wafer, with the limits. */
(function (W) {
    'use strict';

    const now = { cells: [] };

    const place = (i) => (doc, gripper, t) => {
        const pose = W.robot.gripper(doc.tracks, gripper, t);
        return { text: pose ? W.number(pose.r[i], 3) : W.DASH };
    };

    const measured = (key, name, decimals) => (doc, gripper, t) => {
        const track = doc.tracks.proximity[gripper];
        const found = track ? W.tracks.curve(track[key], t, false) : null;
        return typeof found === 'number' ? judged(key, found, doc.limits[name], decimals) : { text: W.DASH };
    };

    /* Shows a tick or a cross if there is a limit. */
    function judged(key, found, limit, decimals) {
        const planar = key === 'n1_proj_n2';
        const size = planar ? found : Math.abs(found);
        const within = planar ? size > limit : size < limit;
        const known = typeof limit === 'number';
        return { text: W.number(size, decimals) + (known ? (within ? ' \u2713' : ' \u2717') : ''),
            kind: known && within ? 'within' : '' };
    }

    /* Says so if a front face points down. */
    function faced(doc, name, t) {
        const pose = W.tracks.wafer(doc.tracks, doc.names.wafers.indexOf(name), t);
        return pose && pose.q[0] ** 2 + pose.q[1] ** 2 > 0.5 ? `${name}, face down` : name;
    }

    function holds(doc, gripper, t) {
        const found = doc.names.wafers.filter((_, i) => {
            const state = W.tracks.hold(doc.tracks.wafers[i], t);
            return state && state.holder === gripper;
        }).map((name) => faced(doc, name, t));
        return { text: found.join(', ') || 'nothing' };
    }

    function nearest(doc, gripper, t) {
        const track = doc.tracks.nearest[gripper];
        const wafer = track ? W.tracks.step(track.t, track.v, t) : null;
        return { text: wafer === null ? 'none near' : doc.names.wafers[wafer] || '' };
    }

    const stepped = (kind, words) => (doc, gripper, t) => {
        const track = doc.tracks[kind][gripper];
        const value = track ? W.tracks.step(track.t, track.v, t) : null;
        return { text: value === 0 || value === 1 ? words[value] : W.DASH };
    };

    function vacuum(doc, gripper, t) {
        const track = doc.tracks.vacuum[gripper];
        const level = W.tracks.curve(track, t, false);
        return { text: typeof level === 'number' ? `${W.number(100 * level, 0)}\u00a0%` : W.DASH };
    }

    const some = (tracks) => tracks.some((track) => track && track.t && track.t.length > 0);
    const near = (tracks) => tracks.some((track) => track && some(Object.values(track)));

    /* The table's rows: names and values; rows without data in the document are left out. */
    function rows(doc) {
        const { tracks } = doc;
        return [['holds', 'holds', holds, true],
            ['valve', 'valve', stepped('valves', ['open', 'closed']), some(tracks.valves)],
            ['vacuum', 'vacuum', vacuum, some(tracks.vacuum)],
            ['sensor', 'sensor', stepped('sensors', ['off', 'on']), some(tracks.sensors)],
            ['x', 'x mm', place(0), true], ['y', 'y mm', place(1), true], ['z', 'z mm', place(2), true],
            ['nearest', 'nearest', nearest, some(tracks.nearest)],
            ['dr_proj_z', '|dr_proj_z| mm', measured('dr_proj_z', 'projz', 4), near(tracks.proximity)],
            ['dr_proj_xy', '|dr_proj_xy| mm', measured('dr_proj_xy', 'projxy', 4), near(tracks.proximity)],
            ['n1_proj_n2', 'n1_proj_n2', measured('n1_proj_n2', 'planar', 6), near(tracks.proximity)],
        ].filter(([, , , there]) => there || doc.grows);
    }

    function cell(name, gripper, look) {
        const element = W.element('td', { 'data-name': name, 'data-gripper': now.doc.names.grippers[gripper] });
        now.cells.push({ element, gripper, look });
        return element;
    }

    const head = (name, i) => W.element('th', { scope: 'col' },
        W.element('i', { class: 'dot', style: `background: var(--s${i % 6})` }), name);

    /* A table shows two grippers, because there is little room. */
    function table(doc, from) {
        const grippers = doc.names.grippers.slice(from, from + 2).map((name, i) => [name, from + i]);
        return W.element('div', { class: 'card' }, W.element('table', { class: 'states' },
            W.element('thead', {}, W.element('tr', {}, W.element('td', {}), ...grippers.map((each) => head(...each)))),
            W.element('tbody', {}, ...rows(doc).map(([name, text, look]) => W.element('tr', {},
                W.element('th', { scope: 'row' }, text), ...grippers.map(([, i]) => cell(name, i, look)))))));
    }

    function show(clock) {
        now.cells.forEach(({ element, gripper, look }) => {
            const { text, kind } = look(now.doc, gripper, clock.now);
            element.textContent = text;
            element.className = kind || '';
        });
    }

    now.start = function (doc) {
        const host = document.getElementById('now');
        now.doc = doc;
        host.append(W.element('h2', {}, 'Now'));
        for (let i = 0; i < doc.names.grippers.length; i += 2) {
            host.append(table(doc, i));
        }
        if (doc.names.grippers.length === 0) {
            host.append(W.why('The document names no grippers.'));
        }
        W.clock.on('time', show);
        show(W.clock);
    };

    W.now = now;
}(window.Waferhand));
