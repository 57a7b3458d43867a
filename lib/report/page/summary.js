/* The head of the page: what ran, whether it ended as expected, and its main figures. */
(function (W) {
    'use strict';

    const counted = (count, one, many) => `${count} ${count === 1 ? one : many}`;

    /* A session has no script that would catch an error: those that hosts and operators were told are counted. */
    function ofSession(doc) {
        const count = doc.commands.length, failed = doc.commands.filter((command) => command.error).length;
        const text = failed === 0 ? '\u2713 no command failed'
            : failed === count ? '\u2717 no command succeeded' : `${failed} of ${counted(count, 'command', 'commands')} failed`;
        return W.element('span', { class: `verdict ${failed === 0 ? 'good' : failed === count ? 'bad' : 'warn'}` }, text);
    }

    function verdict(doc) {
        if (doc.grows) {
            return ''; /* the line below has it */
        }
        if (doc.source === 'session' && doc.run.ok && doc.commands.length > 0) {
            return ofSession(doc);
        }
        if (typeof doc.run.ok !== 'boolean') {
            return W.element('span', { class: 'verdict' }, doc.run.nothing_moved ? 'nothing moved' : 'no verdict');
        }
        return W.element('span', { class: `verdict ${doc.run.ok ? 'good' : 'bad'}` },
            doc.run.ok ? '\u2713 passed' : '\u2717 failed');
    }

    /* The first three of a list in words, and the number of the others. */
    function firsts(list, tell, one, many) {
        const others = list.length > 3 ? [counted(list.length - 3, one, many)] : [];
        return list.slice(0, 3).map(tell).concat(others).join('; ');
    }

    const fault = (text) => W.element('p', { class: 'failure' }, text);

    /* The expectations that were not met. */
    function unmet(doc) {
        const missing = doc.expectations.filter((each) => !each.ok);
        return missing.length === 0 ? [] : [fault(`The script expected what did not come about: ${firsts(missing,
            (each) => `${each.text} (line ${each.line})`, 'other', 'others')}.`)];
    }

    /* The cell's complaints; they count whether expected or not. */
    function complaints(doc) {
        const bad = doc.events.filter((event) => W.events.isComplaint(event.kind));
        const all = doc.expectations.length > 0 && doc.expectations.every((each) => each.ok) && !doc.run.failure;
        const though = all ? ', though what the script expected came about' : '';
        return bad.length === 0 ? [] : [fault(`It failed for ${firsts(bad, (event) => `${W.events.tell(event)} at ${
            W.seconds(event.t)}`, 'other complaint', 'other complaints')}${though}.`)];
    }

    /* The displacements of the cell, if it was displaced on purpose. */
    function displacements(doc) {
        const given = doc.run.errors || [], of = doc.run.trial;
        if (of) {
            return [W.why(`The cell was off by what trial ${of.trial} of seed ${of.seed} draws.`)];
        }
        return given.length === 0 ? [] : [W.why(`The cell was off, as --error asked for: ${given.join(', ')}.`)];
    }

    /* The reasons why a run failed: what ended it, what it did not do, and what went wrong in the cell. */
    function reasons(doc) {
        if (doc.run.ok !== false) {
            return doc.run.failure ? [fault(doc.run.failure)] : [];
        }
        const ended = doc.run.failure ? [fault(`The script ended early: ${doc.run.failure}`)] : [];
        return ended.concat(unmet(doc), complaints(doc));
    }

    function tile(text, value, note, kind) {
        return W.element('div', { class: `tile ${kind || ''}` }, W.element('b', {}, value), W.element('span', {}, text),
            W.element('small', {}, note || ''));
    }

    function expectations(doc) {
        const met = doc.expectations.filter((each) => each.ok).length;
        const all = doc.expectations.length;
        return all === 0 ? null : tile('expectations met', `${met} of ${all}`, '', met === all ? 'good' : 'bad');
    }

    function commands(doc) {
        const errors = doc.commands.filter((command) => command.error).length;
        return doc.commands.length === 0 ? null : tile(doc.commands.length === 1 ? 'command' : 'commands',
            doc.commands.length, errors > 0 ? counted(errors, 'error', 'errors') : 'no error', errors > 0 ? 'bad' : '');
    }

    function events(doc) {
        const bad = doc.events.filter((event) => W.events.colour(event.kind) === 'bad').length;
        const warn = doc.events.filter((event) => W.events.colour(event.kind) === 'warn').length;
        const note = [bad > 0 && counted(bad, 'fault', 'faults'), warn > 0 && counted(warn, 'warning', 'warnings')]
            .filter(Boolean).join(', ') || 'none to worry about';
        return tile(doc.events.length === 1 ? 'event' : 'events', doc.events.length, note, bad > 0 ? 'bad' : warn > 0
            ? 'warn' : '');
    }

    /* A steady cycle counts first; what the run is with its start and its end stands below it. */
    function throughput(doc) {
        const found = doc.run.throughput, steady = doc.run.steady_cycle;
        if (steady && steady.found && steady.wafers_per_hour) {
            const all = found && !found.reason ? `; ${W.number(found.wafers_per_hour, 1)} in all` : '';
            const wafers = counted(steady.wafers, 'wafer', 'wafers'), time = W.seconds(steady.end_s - steady.begin_s);
            return tile('wafers per hour', W.number(steady.wafers_per_hour, 1),
                `${wafers} in ${time}, the first steady cycle${all}`);
        }
        if (!found || !(found.reason || found.wafers > 0)) {
            return null;
        }
        return found.reason ? tile('wafers per hour', W.DASH, found.reason)
            : tile('wafers per hour', W.number(found.wafers_per_hour, 1),
                `${counted(found.wafers, 'wafer', 'wafers')} in ${W.seconds(found.seconds)}`);
    }

    /* The result of a replay, if the run is a log. */
    function recording(doc) {
        const found = doc.run.log;
        return !found || typeof found.verdict !== 'string' ? null : tile('the log, replayed', found.verdict,
            found.reason || 'whole, and every slice as recorded', found.verdict === 'same' ? 'good' : 'bad');
    }

    function duration(doc) {
        const slices = typeof doc.slices === 'number' && !doc.grows
            ? `${doc.slices.toLocaleString('en')} slices of ` : 'slices of ';
        return tile('simulated', W.seconds(doc.duration), `${slices}${W.figure(1000 * doc.slice)}\u00a0ms`);
    }

    const notes = (doc) => doc.notes.map((note) => W.why(note));

    function tiles(doc) {
        const flow = W.flow.tiles(doc);
        const isFlowAlone = flow.length > 0 && !doc.scene;
        return flow.concat(expectations(doc), isFlowAlone ? [] : [commands(doc), events(doc),
            flow.length > 0 ? null : throughput(doc), duration(doc), recording(doc)]).filter(Boolean);
    }

    W.summary = { notes,
        start(doc) {
            const host = W.element('div', { class: 'tiles' }, ...tiles(doc));
            const theme = W.element('button', { type: 'button', id: 'theme', title: 'Light or dark (t)',
                'aria-keyshortcuts': 't', click: W.theme.toggle }, 'Light / dark');
            const help = W.element('button', { type: 'button', id: 'helping', title: 'Keys (?)',
                'aria-keyshortcuts': '?', click: () => W.keys.help() }, 'Keys');
            document.getElementById('head').append(
                W.element('div', { class: 'row' }, W.element('h1', {}, doc.title), verdict(doc),
                    W.element('span', { class: 'space' }), help, theme),
                ...displacements(doc),
                ...reasons(doc),
                ...(doc.grows ? [] : notes(doc)),
                host);
            W.clock.on('growth', () => host.replaceChildren(...tiles(doc)));
        },
    };
}(window.Waferhand));
