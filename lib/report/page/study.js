/* The page of a study: how often all goes well, the places where the wafers end up, and the error that costs most. It also
 * lists the worst trials, each with the command that plays it again. */
(function (W) {
    'use strict';

    const MOST_CAUSES = 20;
    const host = () => document.getElementById('tables');
    const group = (id, title, ...children) => W.element('section', { class: 'group', id }, W.element('h2', {}, title),
        ...children);
    const percent = (rate) => `${W.number(100 * rate, 2)}\u00a0%`;
    const range = (rate) => `${percent(rate.low)} to ${percent(rate.high)}`;
    const num = (text) => ({ numeric: text });

    /* --------------------------------------------------------------------------------------------------- head */

    const tile = (name, value, note, kind) => W.element('div', { class: `tile ${kind || ''}` },
        W.element('b', {}, String(value)), W.element('span', {}, name), W.element('small', {}, note));

    function head(doc) {
        const { result } = doc;
        const { success, trials } = result;
        const failed = trials - success.met;
        const theme = W.element('button', { type: 'button', id: 'theme', title: 'Light or dark', click: W.theme.toggle },
            'Light / dark');
        const told = failed === 0 ? '\u2713 all trials ok' : `\u2717 ${failed} of ${trials} failed`;
        const kind = failed === 0 ? 'good' : 'bad';
        document.getElementById('head').append(
            W.element('div', { class: 'row' }, W.element('h1', {}, doc.title),
                W.element('span', { class: `verdict ${kind}` }, told),
                W.element('span', { class: 'space' }), theme),
            W.element('p', { class: 'note' }, `A study: ${trials} trials of seed ${result.seed} on ${result.layout}, each with `
                + 'other small errors.'),
            result.run_without_errors.ok ? '' : W.element('p', { class: 'failure' },
                'Without any errors the script fails already.'),
            W.element('div', { class: 'tiles' },
                tile('of the trials are ok', percent(success.rate), `95 % sure: ${range(success)}`, kind),
                tile('trials', trials, `${success.met} ok, ${failed} failed`),
                tile('ended by an error', result.ended, 'that the script did not catch', result.ended > 0 ? 'bad' : ''),
                tile('ran the script whole', result.whole, 'the others replay the run without errors')));
    }

    /* ---------------------------------------------------------------------------------------- one trial, chosen */

    function values(of) {
        const drawn = of.drawn || {};
        const list = [];
        const add = (each) => Object.entries(each).forEach(([key, value]) => {
            if (typeof value === 'number') {
                list.push([`${each.name || each.gripper} ${W.words(key)}`, W.figure(value)]);
            }
        });
        (drawn.wafers || []).concat(drawn.stations || [], drawn.valves || []).forEach(add);
        if (drawn.vacuum_s) {
            list.push(['vacuum s', W.figure(drawn.vacuum_s)]);
        }
        if (drawn.debounce_s) {
            list.push(['debounce s', W.figure(drawn.debounce_s)]);
        }
        return list;
    }

    function ends(doc, trial) {
        const i = doc.points.trial.indexOf(trial);
        return i < 0 ? [] : doc.result.wafers.map((each, w) => {
            const [x, y] = [doc.points.ends[i][2 * w], doc.points.ends[i][2 * w + 1]];
            return [`${each.name} ends at dX, dY`, x === null ? 'elsewhere' : `${W.figure(x)}, ${W.figure(y)}\u00a0mm`];
        });
    }

    function terms(list) {
        return W.element('dl', { class: 'drawn' }, ...[].concat(...list.map(([name, value]) => [W.element('dt', {}, name),
            W.element('dd', {}, value)])));
    }

    function choose(doc, trial) {
        const known = doc.result.worst.find((each) => each.trial === trial);
        const ok = known ? known.ok : doc.points.ok[doc.points.trial.indexOf(trial)];
        const why = known ? known.why : doc.points.why[doc.points.trial.indexOf(trial)];
        const made = document.getElementById('chosen');
        const drawn = known ? values(known) : [];
        made.replaceChildren(W.element('h2', {}, `Trial ${trial}: ${ok ? 'ok' : 'failed'}`),
            why ? W.element('p', { class: 'failure' }, why) : '',
            W.reproduce.commandOf(`${doc.command} --trial ${trial}`, 'replay'),
            terms(ends(doc, trial)),
            drawn.length > 0 ? W.element('h3', {}, 'Drawn errors (mm, degrees, slices)') : '',
            known ? terms(drawn) : W.why('Drawn errors are shown for the worst trials, and --csv writes all of them.'));
        document.querySelectorAll('.chosen, .picked').forEach((each) => each.classList.remove('chosen', 'picked'));
        document.querySelectorAll(`[data-trial="${trial}"]`).forEach((each) => each.classList.add(
            each.tagName === 'TR' ? 'picked' : 'chosen'));
        W.say(`trial ${trial}, ${ok ? 'ok' : 'failed'}`);
    }

    /* ------------------------------------------------------------------------------------------------- sections */

    function tables(doc) {
        const { expectations, errors, events } = doc.result;
        const met = expectations.map((each) => () => W.tables.row([num(String(each.line)), each.text, num(String(each.seen)),
            num(String(each.met)), num(percent(each.rate)), range(each)], each.met === each.seen ? 'good' : 'bad'));
        const failed = errors.map((each) => () => W.tables.row([num(String(each.line)), each.text, `${each.error} ${each.name}`,
            num(String(each.trials)), num(percent(each.rate)), range(each)]));
        const happened = events.map((each) => () => W.tables.row([each.kind, num(String(each.trials)), num(percent(each.rate)),
            range(each), num(String(each.total))], each.complaint ? 'bad' : ''));
        host().append(
            W.tables.section('expectations', 'Expectations, and how often they were met',
                ['line', 'expected', 'seen', 'met', 'rate of those', '95 % sure'], met, 'The script states no expectations.'),
            W.tables.section('errors', 'Commands that failed', ['line', 'command', 'error', 'trials', 'rate', '95 % sure'],
                failed, 'No command failed in any trial.'),
            W.tables.section('events', 'Events in the cell: a complaint, in red, makes its trial fail',
                ['event', 'trials', 'rate', '95 % sure', 'all in all'], happened, 'Nothing happened in any trial.'));
    }

    function points(doc, w) {
        return doc.points.trial.map((trial, i) => ({ trial, ok: doc.points.ok[i], x: doc.points.ends[i][2 * w],
            y: doc.points.ends[i][2 * w + 1] })).filter((point) => point.x !== null);
    }

    function wafer(doc, w) {
        const told = doc.result.wafers[w];
        const found = doc.wafers[w];
        const dots = points(doc, w);
        const count = doc.points.trial.length;
        const shown = count < doc.points.of ? ` The first ${count} of ${doc.points.of} trials are shown.` : '';
        const cloud = () => W.charts.cloud(dots, found.limits, told.name, (trial) => choose(doc, trial));
        const names = { dx: 'dX, mm', dy: 'dY, mm', dz: 'dz, mm', tilt_deg: 'tilt, degrees', off: 'off, mm' };
        const bars = Object.entries(names).filter(([key]) => found.histograms[key])
            .map(([key, name]) => W.charts.histogram(found.histograms[key], name));
        const where = told.station ? `in ${told.station} ${told.slot}` : 'held by ' + (told.holder || W.DASH);
        return [W.element('p', { class: 'note' }, `${told.name} ${where}: ${told.count} trials leave it there, ${told.elsewhere} `
            + `elsewhere. Each point is a trial, red ones failed;${found.limits.length > 0 ? ' the dashed box is what the script '
                + 'expects;' : ''} a click tells how to play it again.${shown}`),
        W.element('div', { class: 'cloud' }, dots.length > 0 ? cloud() : W.why('No trial leaves it in a slot.'),
            W.element('div', { class: 'histograms' }, ...bars))];
    }

    function wafers(doc) {
        const place = W.element('div', {});
        const put = (w) => place.replaceChildren(...wafer(doc, w));
        const pick = W.element('select', { 'aria-label': 'Wafer', change: (event) => put(Number(event.target.value)) },
            ...doc.result.wafers.map((each, w) => W.element('option', { value: w }, each.name)));
        const made = group('ends', 'Where the wafers end up');
        if (doc.result.wafers.length === 0) {
            made.append(W.why('The run without errors takes no wafer.'));
        } else {
            made.append(doc.result.wafers.length > 1 ? pick : '', place);
            put(0);
        }
        host().append(made);
    }

    const FIGURES = { makespan_s: 'makespan, s', cycle_s: 'cycle, s', per_hour: 'wafers per hour',
        robots_wait_s: 'robots wait, all together, s', wafers_wait_s: 'done wafers wait, all together, s',
        late_stays: 'stays beyond windows' };

    /* How makespan, rate, waits and breaches of windows spread. */
    function flow(doc) {
        const told = doc.result.flow;
        if (!told) {
            return;
        }
        const known = Object.keys(FIGURES).filter((key) => told[key]);
        const rows = known.map((key) => () => {
            const of = told[key];
            const found = [of.without_errors, of.mean, of.deviation, of.min, of.p5, of.p50, of.p95, of.max];
            return W.tables.row([FIGURES[key], ...found.map((value) => num(value === null ? W.DASH : W.figure(value)))]);
        });
        const bars = known.filter((key) => doc.flow[key]).map((key) => W.charts.histogram(doc.flow[key], FIGURES[key]));
        const without = [[told.unfinished, 'did not bring all wafers to their ends: without a makespan'],
            [told.unsteady, 'have no steady cycle: their means over the middle third of the wafers count'],
            [told.no_cycle, 'have too few wafers for a cycle']].filter(([count]) => count > 0)
            .map(([count, why]) => W.element('p', { class: 'note' }, `${count} of the trials ${why}.`));
        const heads = ['', 'without errors', 'mean', 'deviation', 'min', '5 %', '50 %', '95 %', 'max'];
        host().append(W.tables.section('flow', 'The flow', heads, rows, 'No trial brought wafers to their ends.'),
        group('flow-spread', 'How its figures spread', ...without, W.element('div', { class: 'histograms' }, ...bars)));
    }

    const nameOf = (cause) => `${cause.of ? cause.of + ' ' : ''}${W.words(cause.what)}`;

    function causes(doc) {
        const shown = doc.result.drawn.slice(0, MOST_CAUSES);
        const rows = shown.map((cause) => ({ name: nameOf(cause), found: cause.failing.by_size }));
        const more = doc.result.drawn.length - shown.length;
        host().append(group('causes', 'Which error costs most',
            W.element('p', { class: 'note' }, 'How strongly the size of each drawn error goes with failing: 1 always, 0 not at '
                + 'all. A bar is where the true value lies; all bars together hold with 95 %. Coloured bars do not reach 0.'
                + (more > 0 ? ` ${more} weaker ones are not shown.` : '')),
            [0, doc.result.trials].includes(doc.result.success.met)
                ? W.why(`${doc.result.success.met === 0 ? 'All' : 'None'} of the trials failed, `
                    + 'so nothing tells what failing goes with.')
                : '',
            W.charts.correlations(rows, 'Correlations of drawn errors with failing')));
    }

    function worst(doc) {
        const isFlow = doc.result.flow && doc.result.wafers.length === 0;
        const rows = doc.result.worst.map((each) => () => {
            const button = W.element('button', { type: 'button', class: 'time', title: 'Show this trial',
                click: () => choose(doc, each.trial) }, String(each.trial));
            const far = isFlow ? each.makespan_s : each.off;
            const missing = isFlow ? 'no end' : 'elsewhere';
            const off = far === null ? missing : W.number(far, isFlow ? 3 : 4);
            const made = W.tables.row([button, each.ok ? 'ok' : 'failed', num(off), each.why || ''], each.ok ? '' : 'bad');
            made.dataset.trial = each.trial;
            return made;
        });
        host().append(group('chosen', 'One trial',
            W.why('Click a trial, here below or among the points, to have the command that plays it again.')),
        W.tables.section('worst', isFlow ? 'The worst trials: failed ones first, then those whose flow took longest'
            : 'The worst trials: failed ones first, then those that leave a wafer farthest off',
        ['trial', 'result', isFlow ? 'makespan (s)' : 'off (mm)', 'why'], rows, 'There are none.'));
    }

    function show(doc) {
        head(doc);
        flow(doc);
        if (doc.result.wafers.length > 0 || !doc.result.flow) {
            wafers(doc);
        }
        worst(doc);
        causes(doc);
        tables(doc);
        performance.mark('complete');
    }

    W.document.unpack().then(show).catch((error) => {
        document.getElementById('head').append(W.why(`This page cannot be shown: ${error.message}.`));
        performance.mark('complete');
    });
}(window.Waferhand));
