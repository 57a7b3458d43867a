/* The tables: where wafers lie, expectations, commands, what stations did, events, how the time was spent, and how to reproduce
   the run. */
(function (W) {
    'use strict';

    const SHOWN = 400;
    const NEWEST = 100; /* of a document that grows, which is a picture's time to lay out */

    /* A button in a table that moves the time. */
    function goTo(t) {
        return W.element('button', { type: 'button', class: 'time', title: 'Show this time', click() {
            W.clock.seek(t);
            W.say(`time ${t.toFixed(3)} seconds`);
        } }, W.number(t, 3));
    }

    function row(cells, kind) {
        return W.element('tr', { class: kind || null }, ...cells.map((cell) => W.element('td', {
            class: typeof cell === 'number' || (cell && cell.numeric) ? 'number' : null },
        cell && cell.numeric ? cell.numeric : cell instanceof Node ? cell : String(cell))));
    }

    /* Right-aligned text. */
    const num = (text) => ({ numeric: text });

    /* A section with a table that has no rows yet; its heads are aligned like the cells of a row. */
    function framed(id, title, heads, like) {
        const body = W.element('tbody');
        const kinds = Array.from(like.cells, (cell) => cell.className);
        const head = W.element('tr', {}, ...heads.map((text, i) => W.element('th', { scope: 'col', class: kinds[i] }, text)));
        const made = W.element('section', { class: 'group', id }, W.element('h2', {}, title),
            W.element('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': title },
                W.element('table', {}, W.element('thead', {}, head), body)));
        return { made, body };
    }

    const without = (id, title, reason) => W.element('section', { class: 'group', id }, W.element('h2', {}, title),
        W.why(reason));

    /* A section with a table; rows after the first few hundred wait for a button. */
    function section(id, title, heads, all, reason) {
        if (all.length === 0) {
            return without(id, title, reason);
        }
        const rows = all.slice(0, SHOWN).map((each) => each());
        const { made, body } = framed(id, title, heads, rows[0]);
        body.append(...rows);
        if (all.length > SHOWN) {
            const more = W.element('button', { type: 'button', click() {
                body.append(...all.slice(SHOWN).map((each) => each()));
                more.remove();
            } }, `Show all ${all.length}`);
            made.append(more);
        }
        return made;
    }

    /* The table of a list: [id, title, heads, list, the row of an entry, the reason for an empty one]. */
    const still = ([id, title, heads, list, make, reason]) => section(id, title, heads, list.map((each) => () => make(each)),
        reason);

    /* Rows of the newest entries come first; a row whose entry is still the same is not made again. */
    function renew(body, rows, newest, make) {
        const known = new Map(rows);
        rows.clear();
        newest.forEach((entry) => rows.set(entry, known.get(entry) || make(entry)));
        known.forEach((old, entry) => rows.has(entry) || old.remove());
        newest.forEach((entry, i) => {
            if (body.rows[i] !== rows.get(entry)) {
                body.insertBefore(rows.get(entry), body.rows[i] || null);
            }
        });
    }

    /* The table of a list that grows. */
    function growing([id, title, heads, list, make, reason], host) {
        const rows = new Map();
        let limit = NEWEST;
        let made = without(id, title, reason);
        let body = null;
        const more = W.element('button', { type: 'button', click() {
            limit = Infinity;
            show();
        } });
        function show() {
            if (!body && list.length > 0) {
                const before = made;
                ({ made, body } = framed(id, title, heads, make(list[0])));
                made.append(more);
                before.replaceWith(made);
            }
            if (body) {
                renew(body, rows, list.slice(-limit).reverse(), make);
                more.textContent = `Show all ${list.length}`;
                more.hidden = list.length <= limit;
            }
        }
        host.append(made);
        show();
        W.clock.on('growth', show);
    }

    function wafers(doc) {
        const all = doc.run.wafers || [];
        const faces = all.some((wafer) => wafer.face === 'down');
        const rows = all.map((wafer) => () => row([wafer.name, wafer.holder || W.DASH,
            wafer.station || W.DASH, num(wafer.slot === null || wafer.slot === undefined ? W.DASH : String(wafer.slot)),
            num(W.number(wafer.dx, 4)), num(W.number(wafer.dy, 4)), num(W.number(wafer.dz, 4)),
            num(W.number(wafer.tilt_deg, 4))].concat(faces ? [wafer.face] : [])));
        return section('wafers', 'Where the wafers lie at the end', ['wafer', 'held by', 'station', 'slot', 'dX (mm)',
            'dY (mm)', 'dz (mm)', 'tilt (\u00b0)'].concat(faces ? ['face'] : []), rows,
            'The document does not hold where the wafers lie.');
    }

    const expectations = (doc) => ['expectations', 'Expectations, and their outcome', ['line', 'expected', 'came out'],
        doc.expectations, (each) => row([num(String(each.line)), each.text, each.ok ? '\u2713 came out so' : '\u2717 did not'],
            each.ok ? 'good' : 'bad'), 'The script states no expectations.'];

    function result(command) {
        const going = typeof command.end_s === 'number' ? 'done' : 'runs';
        return command.error ? `${command.error}: ${command.message || 'error'}` : going;
    }

    const commands = (doc) => ['commands', 'Commands', ['line', 'command', 'begins (s)', 'ends (s)', 'takes (s)', 'result'],
        doc.commands, (each) => row([num(String(each.line)), each.text, goTo(each.begin_s), num(W.number(each.end_s, 3)),
            num(typeof each.end_s === 'number' ? W.number(each.end_s - each.begin_s, 3) : W.DASH), result(each)],
        each.error ? 'bad' : null), 'The document holds no commands: a log of moves alone has none.'];

    /* Further values of an event: how close, and against what. */
    function particulars(event) {
        const found = [];
        if (typeof event.value === 'number') {
            found.push(`${W.figure(event.value)}${typeof event.limit === 'number' ? `, limit ${W.figure(event.limit)}` : ''}`);
        }
        ['from', 'other', 'message', 'fault_kind'].filter((key) => event[key])
            .forEach((key) => found.push(`${key === 'fault_kind' ? '' : key + ' '}${W.words(event[key])}`));
        if (event.failed && event.failed.length > 0) {
            found.push('failed: ' + event.failed.join(', '));
        }
        return found.join('; ');
    }

    const events = (doc) => ['events', 'Events', ['time (s)', 'event', 'wafer or parts', 'gripper', '|dr_proj_z| (mm)',
        '|dr_proj_xy| (mm)', 'n1_proj_n2', 'more'], doc.events, (each) => row([goTo(each.t), W.words(each.kind),
        each.parts ? each.parts.join(' \u2013 ') : each.wafer || W.DASH, each.gripper || W.DASH,
        num(W.number(Math.abs(each.dr_proj_z), 4)), num(W.number(each.dr_proj_xy_norm, 4)),
        num(W.number(each.n1_proj_n2, 6)), particulars(each)], W.events.colour(each.kind)), 'Nothing happened in this run.'];

    function whatBegins(told) {
        return told.kind === 'port_begins' ? `${told.step}${told.carrier ? ' of ' + told.carrier : ''}`
            : told.kind === 'pump_begins' ? 'to ' + told.side : told.kind.replace('_begins', '');
    }

    /* The own doings of stations: each begin with its end. Null in a cell whose stations do nothing. */
    function stations(doc) {
        const all = doc.run.station_events || [];
        const endOf = (i) => all.slice(i + 1).find((other) => other.station === all[i].station && other.slot === all[i].slot
            && /_(ends|cut|timeout)$/.test(other.kind));
        const rows = all.map((each, i) => [each, endOf(i)]).filter(([each]) => each.kind.endsWith('_begins'))
            .map(([each, end]) => () => row([goTo(each.utime / 1e6), each.station, num(each.slot === null ? W.DASH
                : String(each.slot)), whatBegins(each), each.wafer || W.DASH, end ? goTo(end.utime / 1e6) : 'goes on'],
            end && !end.kind.endsWith('_ends') ? 'bad' : null));
        return rows.length === 0 ? null : section('stations', 'Stations', ['begins (s)', 'station', 'slot', 'what', 'wafer',
            'ends (s)'], rows, '');
    }

    const SHARES = [['loaded_s', 'moving, loaded', 's0'], ['empty_s', 'moving, empty', 's5'],
        ['vacuum_s', 'waiting for vacuum', 's3'], ['handover_s', 'handing over', 's2'], ['waiting_s', 'waiting', 's4']];

    function share(split, whole) {
        const [key, text, colour] = split;
        return () => row([text, num(W.number(whole.split[key], 3)), num(W.number(100 * whole.split[key] / whole.sum, 1)),
            W.element('i', { class: 'share',
                style: `width: ${100 * whole.split[key] / whole.sum}%; background: var(--${colour})` })]);
    }

    /* The figure in bold, and the words behind it: that of the steady cycle first, if there is one. */
    function figureOf(found, steady) {
        const counting = (found.counting || []).join(', ');
        const whole = found.reason ? ['No wafers per hour', `: ${found.reason}.`]
            : [`${W.number(found.wafers_per_hour, 1)} wafers per hour`,
                `: ${found.wafers} in ${W.seconds(found.seconds)}; a wafer counts when put into ${counting}.`];
        if (!steady || !steady.found || !steady.wafers_per_hour) {
            return whole;
        }
        return [`${W.number(steady.wafers_per_hour, 1)} wafers per hour`, `: ${steady.wafers} in ${
            W.seconds(steady.end_s - steady.begin_s)}, the first steady cycle. In all: ${whole.join('')}`];
    }

    function throughput(doc) {
        const split = doc.run.split;
        const sum = split ? SHARES.reduce((all, [key]) => all + (split[key] || 0), 0) : 0;
        const rows = sum > 0 ? SHARES.map((each) => share(each, { split, sum })) : [];
        const made = section('split', 'Wafers per hour, and what the time went into', ['part', 'time (s)', '%', ''], rows,
            'The document does not hold what the time went into.');
        const found = doc.run.throughput;
        if (found && (found.reason || found.wafers > 0)) {
            const figure = figureOf(found, doc.run.steady_cycle);
            made.insertBefore(W.element('p', {}, W.element('b', {}, figure[0]), figure[1]), made.children[1] || null);
        }
        return made;
    }

    function clearances(doc) {
        const rows = (doc.run.clearances || []).map((each) => () => row([W.words(each.kind), num(W.number(each.gap, 4)),
            num(W.number(each.limit, 4)), typeof each.utime === 'number' ? goTo(each.utime / 1e6) : W.DASH,
            (each.parts || []).join(' \u2013 ') || 'nothing came near'],
        each.gap !== null && each.gap < each.limit ? 'bad' : null));
        return section('smallest', 'Smallest clearances', ['between', 'gap (mm)', 'limit (mm)', 'time (s)', 'parts'], rows,
            'Clearances are not shown: collisions were not checked in this run.');
    }

    W.tables = { section, row, num, expectations: (doc) => still(expectations(doc)),
        start(doc, host) {
            if (doc.grows) {
                const own = W.element('div');
                host.append(own, ...W.summary.notes(doc));
                [expectations, commands, events].forEach((table) => growing(table(doc), own));
                return;
            }
            host.append(...[wafers(doc), still(expectations(doc)), still(commands(doc)), stations(doc), still(events(doc)),
                clearances(doc), throughput(doc)].filter((part) => part !== null));
        } };
}(window.Waferhand));
