/* The measuring tool: two frames, picked from lists or in the picture, and the pose of the second as seen from the first. */
(function (W) {
    'use strict';

    const measure = { armed: false, next: 0, selects: [] };

    /* All frames by name: { group, at(t) }. A station's frame is that of its first slot. */
    function frames(doc) {
        const found = new Map([['base', { group: 'Cell', at: () => W.pose.IDENTITY }]]);
        doc.names.wafers.forEach((name, i) => found.set(name, { group: 'Wafers',
            at: (t) => W.tracks.wafer(doc.tracks, i, t) }));
        doc.names.grippers.forEach((name, i) => found.set(name, { group: 'Grippers',
            at: (t) => W.robot.gripper(doc.tracks, i, t) }));
        doc.slots.filter((slot) => slot.slot === 1).forEach((slot) => found.set(stationName(doc, slot),
            { group: 'Stations', at: () => slot }));
        doc.slots.forEach((slot) => found.set(`${stationName(doc, slot)}/${slot.slot}`,
            { group: `Slots of ${stationName(doc, slot)}`, at: () => slot }));
        return found;
    }

    const stationName = (doc, slot) => doc.names.stations[slot.station] || `station ${slot.station + 1}`;

    function choices(chosen) {
        const groups = new Map();
        measure.frames.forEach((frame, name) => {
            if (!groups.has(frame.group)) {
                groups.set(frame.group, W.element('optgroup', { label: frame.group }));
            }
            groups.get(frame.group).append(W.element('option', { value: name, selected: name === chosen }, name));
        });
        return Array.from(groups.values());
    }

    function select(i, label, chosen) {
        const made = W.element('select', { id: `measure-${i}`, change: show },
            W.element('option', { value: '' }, 'choose \u2026'), ...choices(chosen));
        measure.selects.push(made);
        return W.element('label', {}, W.element('span', {}, label), made);
    }

    const ROWS = [['distance', 'distance', 'mm', 4], ['dx', 'dX', 'mm', 4], ['dy', 'dY', 'mm', 4], ['dz', 'dz', 'mm', 4],
        ['angle', 'angle', '\u00b0', 4], ['turn', 'whole turn', '\u00b0', 4]];
    const HINTS = { angle: 'between the two z axes', turn: 'of the second frame against the first, about whichever axis' };

    /* The measurement at a time; null unless both frames exist then. */
    measure.at = function (t) {
        const [first, second] = measure.selects.map((each) => measure.frames.get(each.value));
        const poses = [first, second].map((frame) => frame && frame.at(t));
        return poses[0] && poses[1] ? Object.assign(W.pose.measure(...poses), { ends: poses.map((pose) => pose.r) }) : null;
    };

    function show() {
        const found = measure.at(W.clock.now);
        ROWS.forEach(([key, , unit, decimals]) => {
            measure.cells[key].textContent = found ? `${W.number(found[key], decimals)}\u00a0${unit}` : W.DASH;
        });
        if (W.stage.view) {
            const text = found ? `${W.number(found.distance, 3)} mm` : '';
            W.stage.view.rule(measure.armed && found ? found.ends : null, text);
        }
    }

    /* Turns picking in the picture on or off; the line is drawn while it is on. */
    measure.arm = function (on) {
        measure.armed = on;
        measure.next = 0;
        measure.button.setAttribute('aria-pressed', on);
        document.getElementById('canvas').classList.toggle('picking', on);
        W.say(on ? 'Measuring: choose two frames, in the lists or by a click' : 'Measuring ended');
        show();
    };

    measure.toggle = function () {
        measure.arm(!measure.armed);
        if (measure.armed) {
            measure.selects[0].focus({ preventScroll: true });
        }
    };

    /* A station stands for its slot nearest to the point that was hit. */
    function frameOf(hit) {
        const { names } = measure.doc;
        if (hit.kind === 'wafer' || hit.kind === 'gripper') {
            return (hit.kind === 'wafer' ? names.wafers : names.grippers)[hit.i];
        }
        const station = hit.kind === 'station' ? hit.i : -1;
        const slots = measure.doc.slots.filter((slot) => slot.station === station);
        const far = (slot) => W.pose.norm(W.pose.subtract(slot.r, hit.at));
        const nearest = slots.reduce((best, slot) => (!best || far(slot) < far(best) ? slot : best), null);
        return nearest && `${stationName(measure.doc, nearest)}/${nearest.slot}`;
    }

    /* Takes the nearest frame that is not chosen already: of a wafer on a gripper either can be picked. */
    function clicked(event) {
        if (!measure.armed || measure.dragged) {
            return;
        }
        const other = measure.selects[1 - measure.next].value;
        const name = W.stage.view.pick(event).map(frameOf).find((each) => each && (measure.next === 0 || each !== other));
        if (name) {
            measure.selects[measure.next].value = name;
            measure.next = 1 - measure.next;
            W.say(`${measure.next === 1 ? 'from' : 'to'} ${name}`);
            show();
        }
    }

    function listen() {
        const canvas = W.stage.view.canvas;
        let from = null;
        W.listen(canvas, 'pointerdown', (event) => { from = [event.clientX, event.clientY]; });
        W.listen(canvas, 'click', (event) => {
            measure.dragged = from && Math.hypot(event.clientX - from[0], event.clientY - from[1]) > 4;
            clicked(event);
        });
    }

    function table() {
        measure.cells = {};
        const list = W.element('dl', {});
        ROWS.forEach(([key, text]) => {
            measure.cells[key] = W.element('dd', { 'data-name': key });
            list.append(W.element('dt', { title: HINTS[key] || null }, text), measure.cells[key]);
        });
        return list;
    }

    measure.start = function (doc) {
        const host = document.getElementById('measure');
        measure.doc = doc;
        measure.frames = frames(doc);
        measure.button = W.element('button', { type: 'button', id: 'measuring', 'aria-pressed': 'false',
            'aria-keyshortcuts': 'm', title: 'Pick in the picture (m)', click: measure.toggle }, 'Pick in the picture');
        const swap = W.element('button', { type: 'button', 'aria-label': 'Swap the two frames', title: 'Swap', click() {
            const [a, b] = measure.selects;
            [a.value, b.value] = [b.value, a.value];
            show();
        } }, '\u21c5');
        host.append(W.element('h2', { title: 'dX, dY and dz are in the axes of the first frame' },
            'Measure ', W.element('small', {}, 'in the axes of the first frame')), W.element('div', { class: 'card' },
            select(0, 'from', doc.names.grippers[0]), select(1, 'to', doc.names.wafers[0]),
            W.element('div', { class: 'row' }, measure.button, swap), table()));
        if (W.stage.view) {
            listen();
        }
        W.clock.on('time', show);
        show();
    };

    W.measure = measure;
}(window.Waferhand));
