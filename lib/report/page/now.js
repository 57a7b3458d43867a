/* The state at the shown time: each gripper's valve, vacuum and sensor, what it holds, and how it stands to its nearest
 * wafer against the limits. */
(function (W) {
    'use strict';

    const now = { rows: [] };

    const MEASURES = [['dr_proj_z', '|dr_proj_z|', 'mm', 'projz', 4], ['dr_proj_xy', '|dr_proj_xy|', 'mm', 'projxy', 4],
        ['n1_proj_n2', 'n1_proj_n2', '', 'planar', 6]];

    const value = (name) => W.element('dd', { 'data-name': name });

    function card(doc, name, i) {
        const values = {};
        const line = (key, text) => {
            values[key] = value(key);
            return [W.element('dt', {}, text), values[key]];
        };
        const measured = doc.tracks.proximity[i] ? [].concat(line('nearest', 'nearest wafer'),
            ...MEASURES.map(([key, text]) => line(key, text))) : [];
        now.rows.push({ i, values });
        return W.element('div', { class: 'card', 'data-gripper': name },
            W.element('h3', {}, W.element('i', { class: 'dot', style: `background: var(--s${i % 6})` }), name),
            W.element('dl', {}, ...line('holds', 'holds'), ...line('signals', 'valve'), ...line('at', 'at (mm)'), ...measured));
    }

    function signals(doc, i, t) {
        const { valves, vacuum, sensors } = doc.tracks;
        const valve = valves[i] ? W.tracks.step(valves[i].t, valves[i].v, t) : null;
        const words = [valve === null ? W.DASH : valve === 0 ? 'open' : 'closed'];
        const level = vacuum[i] ? W.tracks.linear(vacuum[i].t, vacuum[i].v, t) : null;
        const sensor = sensors[i] ? W.tracks.step(sensors[i].t, sensors[i].v, t) : null;
        words.push(...(level === null ? [] : [`vacuum ${W.number(100 * level, 0)}\u00a0%`]));
        words.push(...(sensor === null ? [] : [sensor ? 'sensor on' : 'sensor off']));
        return words.join(', ');
    }

    function held(doc, gripper, t) {
        const found = doc.names.wafers.filter((_, i) => {
            const state = W.tracks.hold(doc.tracks.wafers[i], t);
            return state && state.holder === gripper;
        });
        return found.join(', ') || 'nothing';
    }

    function limited(cell, doc, measure, found) {
        const [key, , unit, name, decimals] = measure;
        const limit = doc.limits[name];
        const size = found === null || key === 'n1_proj_n2' ? found : Math.abs(found);
        const within = key === 'n1_proj_n2' ? size > limit : size < limit;
        const known = typeof size === 'number' && typeof limit === 'number';
        cell.textContent = typeof size !== 'number' ? W.DASH
            : W.number(size, decimals) + (unit && '\u00a0' + unit) + (known ? (within ? ' \u2713' : ' \u2717') : '');
        cell.className = known ? (within ? 'within' : 'beyond') : '';
    }

    function showProximity(doc, { i, values }, t) {
        const track = doc.tracks.proximity[i];
        if (!track) {
            return;
        }
        const wafer = Array.isArray(track.wafer) ? W.tracks.step(track.t, track.wafer, t) : track.wafer;
        const name = typeof wafer === 'number' ? doc.names.wafers[wafer] : wafer;
        const near = MEASURES.map(([key]) => W.tracks.linear(track.t, track[key] || [], t));
        values.nearest.textContent = (near[0] !== null && near[0] !== undefined && name) || 'none near';
        MEASURES.forEach((measure, k) => limited(values[measure[0]], doc, measure, near[k]));
    }

    function show(clock) {
        const doc = now.doc;
        now.rows.forEach((row) => {
            const pose = W.tracks.pose(doc.tracks.grippers[row.i], clock.now);
            row.values.holds.textContent = held(doc, row.i, clock.now);
            row.values.signals.textContent = signals(doc, row.i, clock.now);
            row.values.at.textContent = pose ? pose.r.map((x) => W.number(x, 3)).join('  ') : W.DASH;
            showProximity(doc, row, clock.now);
        });
    }

    now.start = function (doc) {
        const host = document.getElementById('now');
        now.doc = doc;
        host.append(W.element('h2', {}, 'Now'), ...doc.names.grippers.map((name, i) => card(doc, name, i)));
        if (doc.names.grippers.length === 0) {
            host.append(W.why('The document names no grippers.'));
        }
        W.clock.on('time', show);
        show(W.clock);
    };

    W.now = now;
}(window.Waferhand));
