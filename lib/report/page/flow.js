/* A flow: the rate and what limits it, where the time went, who was where when, and what nearly went wrong. */
(function (W) {
    'use strict';

    const LEGEND = [['process', 's0'], ['done, waits', 's4'], ['blade or door; lies there', 's5'], ['is carried', 's1'],
        ['clean', 's2'], ['pump, vent, swap', 's3'], ['down', 'bad']];
    const flow = { model: null };
    const { isTime } = W.flowData;

    function tile(text, value, note, kind) {
        return W.element('div', { class: `tile ${kind || ''}` }, W.element('b', {}, value), W.element('span', {}, text),
            W.element('small', {}, note || ''));
    }

    /* The steady rate comes first; with start and run-out it is another one. */
    function rate({ flow: told, end }) {
        const all = told.end === 'done' || told.end === 'cut' ? 3600 * told.wafers / Math.max(end, 1e-9) : null;
        const every = told.period > 1 ? `, the same every ${told.period} wafers` : '';
        const behind = all === null ? '' : `${W.number(all, 1)} with start and ${told.end === 'cut' ? 'cut' : 'run-out'}`;
        return isTime(told.cycle_s) ? tile('wafers per hour, steady', W.number(told.per_hour, 1),
            `one in ${W.figure(told.cycle_s)}\u00a0s${every}; ${behind}`)
            : tile('wafers per hour', all === null ? W.DASH : W.number(all, 1),
                `no steady cycle: ${told.no_cycle || 'not told'}`);
    }

    function limit({ flow: told }) {
        const busiest = told.busiest || {};
        return busiest.of ? tile('limits it: the busiest', busiest.of,
            `${W.number(100 * busiest.share, 1)}\u00a0% of the time`) : null;
    }

    function textbook({ flow: told }) {
        const form = told.textbook || {};
        return tile('per hour, by closed form', isTime(form.per_hour) ? W.number(form.per_hour, 1) : W.DASH, isTime(form.cycle_s)
            ? `one in ${W.figure(form.cycle_s)}\u00a0s, for ${(form.limits || []).join(', ')}` : form.why || '');
    }

    const ENDS = { done: 'all at their ends', stuck: 'STUCK: nobody can go on', broken: 'ended early', cut: 'the flow was cut' };

    function wafers({ flow: told }) {
        const lost = told.lost > 0 ? `${told.lost} lost where a station failed` : '';
        const kind = lost ? 'bad' : told.end === 'done' ? 'good' : told.end === 'cut' ? 'warn' : 'bad';
        return tile(told.wafers === 1 ? 'wafer at its end' : 'wafers at their ends',
            told.left > 0 ? `${told.wafers}, ${told.left} not` : told.wafers, lost || ENDS[told.end] || '', kind);
    }

    const makespan = ({ flow: told }) => tile('to the last placing', W.seconds(told.makespan_s));

    function gap({ flow: told }) {
        const stay = told.gaps[0];
        return !stay ? null : tile('left of a window, at least', W.seconds(stay.gap_s), `${stay.wafer} in ${stay.station}: ${
            W.figure(stay.stay_s)} of ${W.figure(stay.window_s)}\u00a0s`, stay.gap_s < 0 ? 'bad'
            : stay.gap_s < W.flowTables.NEAR * stay.window_s ? 'warn' : 'good');
    }

    /* The tiles of the page's head. */
    flow.tiles = (doc) => {
        flow.model = flow.model || W.flowData.read(doc);
        return flow.model ? [rate, limit, textbook, wafers, makespan, gap].map((make) => make(flow.model)) : [];
    };

    function gantt(model) {
        const group = { id: 'gantt', title: 'Stations and robots over time', lanes: model.lanes(), why: 'Nothing moved.',
            choose: (bar) => W.flowWafer.show(bar && bar.wafer ? bar.wafer : null),
            marked: (bar) => W.flowWafer.name !== null && bar.wafer === W.flowWafer.name };
        const made = W.lanes.section(group);
        made.append(W.element('p', { class: 'row legend' }, ...LEGEND.map(([text, colour]) => W.element('span', { class: 'item' },
            W.element('i', { class: 'box piece', style: `--c: var(--${colour})` }), text))));
        W.flowWafer.on(W.lanes.showAll);
        return made;
    }

    /* Where a page has a scene, its time bar leads through the flow as well. */
    flow.start = function (doc, host) {
        flow.model = flow.model || W.flowData.read(doc);
        if (flow.model) {
            const wafer = W.flowWafer.section(flow.model);
            host.append(W.flowShares.section(flow.model), W.cycle.toolbar(), gantt(flow.model), wafer,
                ...W.flowTables.all(flow.model));
        }
    };

    W.flow = flow;
}(window.Waferhand));
