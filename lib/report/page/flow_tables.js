/* Tables of a flow: windows and their gaps, waits, the critical path and gains, the cycle beside the textbook's, wafers. */
(function (W) {
    'use strict';

    const NEAR = 0.1; /* of a window: less than that left is near */
    const { isTime } = W.flowData;
    const num = (value, decimals) => W.tables.num(W.number(value, decimals === undefined ? 3 : decimals));

    function goTo(t) {
        return W.element('button', { type: 'button', class: 'time', title: 'Show this time', click() {
            W.clock.seek(t);
            W.say(`time ${t.toFixed(3)} seconds`);
        } }, W.number(t, 3));
    }

    /* A share as a bar in a cell. */
    function share(part, colour) {
        const width = W.clamp(100 * part, 0, 100).toFixed(2);
        return W.element('i', { class: 'share', style: `width: ${width}%; background: var(--${colour})` });
    }

    const gapKind = (stay) => (stay.gap_s < 0 ? 'bad' : stay.gap_s < NEAR * stay.window_s ? 'warn' : null);

    function gapRow(stay) {
        const kind = gapKind(stay);
        return W.tables.row([W.flowWafer.button(stay.wafer), stay.station, { numeric: goTo(stay.done_s) }, num(stay.stay_s),
            num(stay.window_s), num(stay.gap_s), share(stay.stay_s / Math.max(stay.window_s, 1e-9), kind || 's0')], kind);
    }

    function windowsText({ windows: all, gaps }) {
        const sum = (key) => all.reduce((before, each) => before + each[key], 0);
        const late = sum('late');
        const names = all.map((each) => each.station).join(', ');
        const more = sum('stays') > gaps.length ? ` The ${gaps.length} nearest are listed.` : '';
        const text = `${late === 0 ? 'None' : late} of ${sum('stays')} stays in ${names}`;
        return W.element('p', { class: late > 0 ? 'failure' : 'note' },
            `${text} ${late > 1 ? 'are' : 'is'} beyond the window.${more}`);
    }

    function windows({ flow }) {
        const made = W.tables.section('gaps', 'Windows: the smallest gaps', ['wafer', 'station', 'done at (s)', 'stay (s)',
            'window (s)', 'left (s)', 'stay in the window'], flow.gaps.map((stay) => () => gapRow(stay)),
        flow.windows.length > 0 ? 'No wafer stayed in a station that has a window.' : 'No station has a window.');
        if (flow.windows.length > 0) {
            made.insertBefore(windowsText(flow), made.children[1]);
        }
        return made;
    }

    /* Robots' causes have words; wafers wait for robots and stations by name. */
    function waits({ flow }) {
        const most = flow.waits.reduce((before, wait) => Math.max(before, wait.seconds), 1e-9);
        const rows = flow.waits.map((wait) => () => W.tables.row([wait.who === 'robots' ? 'robots' : 'wafers that are done',
            wait.who === 'robots' ? `for a ${wait.cause}${wait.cause === 'wafer' ? ' to be done' : ''}` : `for ${wait.cause}`,
            num(wait.seconds), share(wait.seconds / most, wait.who === 'robots' ? 's1' : 's4')]));
        return W.tables.section('waits', 'Waits, summed by cause', ['who waits', 'for what', 'in all (s)', ''], rows,
            'Nobody waited.');
    }

    function path({ flow }) {
        const colours = { process: 's0', clean: 's2', pump: 's3', down: 'bad', wait: 's4', lot: 's4', takt: 's4' };
        const longest = flow.path.reduce((before, part) => Math.max(before, part.share), 1e-9);
        const rows = flow.path.map((part) => () => W.tables.row([part.of === null ? W.DASH : part.of, part.what,
            num(part.seconds), num(100 * part.share, 1), share(part.share / longest, colours[part.what] || 's1')]));
        const made = W.tables.section('path', 'Critical path', ['of', 'doing', 'in all (s)', '%', ''], rows,
            'Nothing was placed.');
        if (rows.length > 0) {
            const text = `The ${W.seconds(flow.makespan_s)} up to the last placing: each part kept the next one waiting.`;
            made.insertBefore(W.element('p', { class: 'note' }, text), made.children[1]);
        }
        return made;
    }

    function gainRow(flow, gain) {
        const cycle = isTime(gain.cycle_s) && isTime(flow.cycle_s) ? flow.cycle_s - gain.cycle_s : null;
        const shorter = flow.makespan_s - gain.makespan_s;
        return W.tables.row([gain.of, num(gain.makespan_s), num(shorter), num(gain.cycle_s), num(cycle)],
            gain.makespan_s < flow.makespan_s ? 'good' : null);
    }

    function gains({ flow }) {
        return W.tables.section('gains', 'What 10 % less time brings', ['of', 'makespan (s)', 'shorter by (s)', 'a wafer in (s)',
            'shorter by (s)'], flow.gains.filter((gain) => gain.end === flow.end).map((gain) => () => gainRow(flow, gain)),
        'This flow did not ask for it: gains = true.');
    }

    const rate = (cycle) => (isTime(cycle) ? W.number(3600 / cycle, 1) : W.DASH);

    function cycles({ flow }) {
        const form = flow.textbook || {}, steady = isTime(flow.cycle_s);
        const every = flow.period > 1 ? `the same every ${flow.period} wafers` : 'the same each time';
        const limits = isTime(form.cycle_s) ? `limited by ${(form.limits || []).join(', ')}`
            : `none: ${form.why || 'the document does not tell'}`;
        const row = (name, cycle, text) => () => W.tables.row([name, num(cycle), W.tables.num(rate(cycle)), text]);
        return W.tables.section('cycles', 'The steady cycle, and the textbook\u2019s', ['cycle', 'a wafer in (s)',
            'wafers per hour', ''], [row('as it was played', flow.cycle_s, steady ? every : flow.no_cycle || ''),
            row('by the textbook\u2019s closed form', form.cycle_s, limits)], '');
    }

    /* Done, and not taken yet, in all places behind the first one. */
    const waited = (of) => of.stays.filter((stay) => stay.step > 0 && isTime(stay.taken))
        .reduce((sum, stay) => sum + stay.taken - (isTime(stay.done) ? stay.done : stay.lies), 0);

    function waferRow(of) {
        const first = of.visits[0], last = of.visits[of.visits.length - 1], stay = of.stays[of.stays.length - 1];
        const end = stay && stay.isLast && last ? last.placed_s : null;
        const moment = (t) => (isTime(t) ? { numeric: goTo(t) } : num(null));
        return W.tables.row([W.flowWafer.button(of.name), of.lot || W.DASH, of.route || W.DASH, moment(first && first.pick_s),
            moment(end), num(isTime(end) ? end - first.pick_s : null), num(waited(of)),
            stay ? `${stay.station} ${stay.slot}` : W.DASH]);
    }

    function wafers({ wafers: all }) {
        const rows = Array.from(all.values(), (of) => () => waferRow(of));
        return W.tables.section('flow-wafers', 'Wafers', ['wafer', 'lot', 'route', 'begins (s)', 'at its end (s)', 'takes (s)',
            'waits, done (s)', 'lies last in'], rows, 'There are no wafers.');
    }

    function stays(model) {
        const all = Array.from(model.stays.values()).flat().filter((stay) => stay.step > 0)
            .sort((a, b) => a.comes - b.comes || (a.station < b.station ? -1 : 1));
        const rows = all.map((stay) => () => W.tables.row([stay.station, num(stay.slot, 0), W.flowWafer.button(stay.wafer),
            { numeric: goTo(stay.comes) }, num(stay.process), num(stay.done), num(stay.taken)]));
        return W.tables.section('flow-stays', 'Stays, as the lanes above show them', ['station', 'slot', 'wafer', 'comes (s)',
            'process (s)', 'done (s)', 'is taken (s)'], rows, 'No wafer was placed.');
    }

    W.flowTables = { all: (model) => [windows, waits, path, gains, cycles, wafers, stays].map((make) => make(model)), NEAR };
}(window.Waferhand));
