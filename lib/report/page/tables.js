/* The tables: where wafers lie, expectations, commands, what stations did, events, how the time was spent, and how to reproduce
   the run. */
(function (W) {
    'use strict';

    const SHOWN = 400;

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

    /* A section with a table; rows after the first few hundred wait for a button. */
    function section(id, title, heads, all, reason) {
        const rows = W.shown && W.shown.grows ? all.slice().reverse() : all;
        const made = W.element('section', { class: 'group', id }, W.element('h2', {}, title));
        if (rows.length === 0) {
            made.append(W.why(reason));
            return made;
        }
        const body = W.element('tbody', {}, ...rows.slice(0, SHOWN).map((each) => each()));
        const kinds = Array.from(body.rows[0].cells, (cell) => cell.className);
        const head = W.element('tr', {}, ...heads.map((text, i) => W.element('th', { scope: 'col', class: kinds[i] }, text)));
        made.append(W.element('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': title },
            W.element('table', {}, W.element('thead', {}, head), body)));
        if (rows.length > SHOWN) {
            const more = W.element('button', { type: 'button', click() {
                body.append(...rows.slice(SHOWN).map((each) => each()));
                more.remove();
            } }, `Show all ${rows.length}`);
            made.append(more);
        }
        return made;
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

    function expectations(doc) {
        const rows = doc.expectations.map((each) => () => row([num(String(each.line)), each.text,
            each.ok ? '\u2713 came out so' : '\u2717 did not'], each.ok ? 'good' : 'bad'));
        return section('expectations', 'Expectations, and their outcome', ['line', 'expected', 'came out'], rows,
            'The script states no expectations.');
    }

    function result(command) {
        const going = typeof command.end_s === 'number' ? 'done' : 'runs';
        return command.error ? `${command.error}: ${command.message || 'error'}` : going;
    }

    function commands(doc) {
        const rows = doc.commands.map((each) => () => row([num(String(each.line)), each.text, goTo(each.begin_s),
            num(W.number(each.end_s, 3)),
            num(typeof each.end_s === 'number' ? W.number(each.end_s - each.begin_s, 3) : W.DASH),
            result(each)], each.error ? 'bad' : null));
        return section('commands', 'Commands', ['line', 'command', 'begins (s)', 'ends (s)', 'takes (s)', 'result'], rows,
            'The document holds no commands: a log of moves alone has none.');
    }

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

    function events(doc) {
        const rows = doc.events.map((each) => () => row([goTo(each.t), W.words(each.kind),
            each.parts ? each.parts.join(' \u2013 ') : each.wafer || W.DASH, each.gripper || W.DASH,
            num(W.number(Math.abs(each.dr_proj_z), 4)), num(W.number(each.dr_proj_xy_norm, 4)),
            num(W.number(each.n1_proj_n2, 6)), particulars(each)], W.events.colour(each.kind)));
        return section('events', 'Events', ['time (s)', 'event', 'wafer or parts', 'gripper', '|dr_proj_z| (mm)',
            '|dr_proj_xy| (mm)', 'n1_proj_n2', 'more'], rows, 'Nothing happened in this run.');
    }

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

    /* The tables of a document that grows are made anew when their lists have grown; others are known only at its end. */
    const GROWING = [expectations, commands, events];
    const counts = (doc) => [doc.expectations, doc.commands, doc.events].map((list) => list.length)
        .concat(doc.commands.filter((command) => typeof command.end_s === 'number').length).join();

    function renew(doc, host, kept) {
        if (kept.counts !== counts(doc) && !host.contains(document.activeElement)) {
            kept.counts = counts(doc);
            host.replaceChildren(...GROWING.map((table) => table(doc)));
        }
    }

    W.tables = { section, row, num, expectations,
        start(doc, host) {
            if (doc.grows) {
                const kept = {};
                const own = W.element('div');
                host.append(own, ...W.summary.notes(doc));
                renew(doc, own, kept);
                W.clock.on('growth', () => renew(doc, own, kept));
                return;
            }
            host.append(...[wafers(doc), expectations(doc), commands(doc), stations(doc), events(doc), clearances(doc),
                throughput(doc)].filter((part) => part !== null));
        } };
}(window.Waferhand));
