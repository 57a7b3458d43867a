/* The doings at the shown time, besides those of grippers: tasks and what they wait for, stations with their wafers and their
 * state, doors, the last events, and what was said at ports. */
(function (W) {
    'use strict';

    const cards = { made: [] };
    const LAST = 8;

    /* Entries up to a time, the newest first. */
    const upTo = (list, time, t) => list.filter((each) => time(each) <= t).slice(-LAST).reverse();

    const row = (name, text, kind) => W.element('tr', { class: kind || null }, W.element('th', { scope: 'row' }, name),
        W.element('td', {}, text));

    const ended = (end, t) => typeof end === 'number' && end <= t;

    /* ------------------------------------------------------------------------------------------------------- tasks */

    function waitOf(doc, task, t) {
        return (doc.run.waits || []).find((wait) => wait.task === task && wait.from_s <= t && !ended(wait.to_s, t));
    }

    function taskName(task) {
        return task > 0 ? `task ${task}` : 'script';
    }

    /* True if a HOLD stands now; of the past the clock tells none. */
    const isHeld = () => W.clock.following && W.live.state.held && !W.live.state.held_robots;

    function tasks(doc, t) {
        const running = doc.commands.filter((command) => command.begin_s <= t && !ended(command.end_s, t));
        const waiting = (doc.run.waits || []).filter((wait) => wait.from_s <= t && !ended(wait.to_s, t));
        const numbers = Array.from(new Set([...running, ...waiting].map((each) => each.task || 0))).sort((a, b) => a - b);
        return numbers.map((task) => {
            const command = running.find((each) => (each.task || 0) === task);
            const wait = waitOf(doc, task, t);
            const text = [command && command.text, isHeld() && 'held', wait && `waits for ${wait.for}`];
            return row(taskName(task), text.filter(Boolean).join(' \u2013 '), wait || isHeld() ? 'warn' : null);
        });
    }

    /* ---------------------------------------------------------------------------------------------------- stations */

    const NEAR_MM = 20;

    /* The slots' wafers at a time: a wafer that nobody holds lies in the nearest slot, if it is near one. */
    function lying(doc, t) {
        const found = new Map();
        doc.names.wafers.forEach((name, i) => {
            const state = W.tracks.hold(doc.tracks.wafers[i], t);
            if (!state || typeof state.holder === 'number') {
                return;
            }
            const far = (slot) => Math.hypot(...slot.r.map((x, k) => x - state.r[k]));
            const nearest = doc.slots.reduce((best, slot) => (far(slot) < far(best) ? slot : best), doc.slots[0]);
            if (nearest && far(nearest) < NEAR_MM) {
                found.set(nearest.station, (found.get(nearest.station) || []).concat({ slot: nearest.slot, name }));
            }
        });
        return found;
    }

    /* The last that a station began or ended by itself. */
    function stateOf(doc, name, t) {
        const told = (doc.run.station_events || []).filter((event) => event.station === name && event.utime / 1e6 <= t);
        const last = told[told.length - 1];
        if (!last) {
            return '';
        }
        const left = /_begins$/.test(last.kind) && last.seconds > 0 ? last.utime / 1e6 + last.seconds - t : 0;
        return W.words(last.kind) + (left > 0 ? `, ${W.number(left, 1)} s left` : '');
    }

    function stations(doc, t) {
        const found = lying(doc, t);
        const slots = (i) => doc.slots.filter((slot) => slot.station === i).length;
        return doc.names.stations.map((name, i) => {
            const held = (found.get(i) || []).sort((a, b) => a.slot - b.slot);
            const many = held.length > 3 ? `${held.length} of ${slots(i)} slots` : held.map((each) =>
                (slots(i) > 1 ? `${each.slot}: ${each.name}` : each.name)).join(', ');
            return row(name, [many || 'empty', stateOf(doc, name, t)].filter(Boolean).join('; '));
        });
    }

    /* ------------------------------------------------------------------------------------------------------- doors */

    function doors(doc, t) {
        return doc.tracks.machine.doors.map(({ axis }, i) => {
            const at = W.tracks.curve(doc.tracks.axes[axis], t, false);
            return row(doc.names.doors[i], at === null ? W.DASH : `${W.number(at, 1)} mm from shut`);
        });
    }

    /* ------------------------------------------------------------------------------------------- events and frames */

    const goTo = (t) => W.element('button', { type: 'button', class: 'time', title: 'Show this time',
        click: () => W.clock.seek(t) }, W.number(t, 3));

    const events = (doc, t) => upTo(doc.events, (event) => event.t, t)
        .map((event) => row(goTo(event.t), W.events.tell(event), W.events.colour(event.kind)));

    const errors = (doc, t) => upTo(doc.commands.filter((command) => command.error && typeof command.end_s === 'number'),
        (command) => command.end_s, t).map((command) => row(goTo(command.end_s), `${command.text}: ${command.message || 'error'}`,
        'bad'));

    const SIGNS = { '>': '\u2192', '~': '\u2192', '<': '\u2190', '+': 'came', '-': 'went', '*': 'halted', '!': 'stopped' };

    const frames = (doc, t) => upTo((doc.run.frames || []).filter((frame) => SIGNS[frame.kind]), (frame) => frame.at_s, t)
        .map((frame) => row(goTo(frame.at_s), `${frame.port} ${SIGNS[frame.kind]} ${frame.text}`));

    const KINDS = [['tasks', 'Commands and waits', tasks], ['stations', 'Stations', stations], ['doors', 'Doors', doors],
        ['last', 'Last events', events], ['errors', 'Commands that failed', errors], ['ports', 'At the ports', frames]];

    /* A card without rows is hidden, so that there is room for the others. */
    function show() {
        cards.made.forEach(({ card, body, rows }) => {
            const made = rows(cards.doc, W.clock.now);
            body.replaceChildren(...made);
            card.hidden = made.length === 0;
        });
    }

    let due = false;

    /* At most some times a second: a reader cannot read faster. */
    function soon() {
        if (!due) {
            due = true;
            setTimeout(() => {
                due = false;
                show();
            }, 120);
        }
    }

    cards.start = function (doc, host) {
        cards.doc = doc;
        cards.made = KINDS.map(([id, title, rows]) => {
            const body = W.element('tbody');
            const card = W.element('section', { class: 'card', id: `card-${id}`, hidden: true }, W.element('h2', {}, title),
                W.element('table', { class: 'cardrows' }, body));
            return { card, body, rows };
        });
        host.append(...cards.made.map(({ card }) => card));
        W.clock.on('time', soon);
        W.clock.on('growth', soon);
        show();
    };

    W.cards = cards;
}(window.Waferhand));
