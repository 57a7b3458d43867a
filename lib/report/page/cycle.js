/* Chooses the part of the run that the plots show. If the whole run would be a comb, they begin with the first steady cycle.
 * The program finds this cycle (run.steady_cycle), or says why there is none. */
(function (W) {
    'use strict';

    const COMB = 6; /* with so many cycles side by side no single one can be seen */
    const MANY = 40; /* with so many commands a reader wants to see one cycle */
    const cycle = { found: null, reason: '', opened: null };

    const same = (a, b) => a.every((t, i) => Math.abs(t - b[i]) < 1e-6);
    const isShown = (window) => cycle.found !== null && same(window, cycle.found.window);

    /* Shows the cycle in all plots, and a time within it. */
    cycle.show = function () {
        if (!cycle.found) {
            W.say(cycle.reason);
            return;
        }
        const [from, to] = cycle.found.window;
        W.clock.setWindow(from, to);
        if (W.clock.now < from || W.clock.now > to) {
            W.clock.seek(from);
        }
        W.say('the plots show the first steady cycle');
    };

    /* The cycle of a flow: between two wafers' ends in the middle third. */
    function ofFlow(flow) {
        const last = new Map();
        (flow.visits || []).filter((visit) => typeof visit.placed_s === 'number')
            .forEach((visit) => last.set(visit.wafer, visit.placed_s));
        const ends = Array.from(last.values()).sort((a, b) => a - b);
        const begin = Math.floor(ends.length / 3);
        const times = Math.floor((ends.length - 2 * begin) / flow.period);
        return { found: times > 0, begin_s: ends[begin], end_s: ends[begin + flow.period], times };
    }

    const toldOf = (doc) => (doc.run.flow && doc.run.flow.period > 0 ? ofFlow(doc.run.flow) : doc.run.steady_cycle || {});

    function read(doc) {
        const told = toldOf(doc);
        const within = told.found === true && told.begin_s >= doc.begin && told.end_s <= doc.duration + 1e-9
            && told.end_s > told.begin_s;
        cycle.found = within ? { window: [told.begin_s, told.end_s], times: told.times } : null;
        cycle.reason = cycle.found ? '' : `no steady cycle: ${told.found === false && told.reason ? told.reason
            : 'the document holds none'}`;
    }

    /* Says in words what the plots show. */
    cycle.text = function () {
        const [from, to] = W.clock.window;
        const all = same([from, to], [W.clock.begin, W.clock.end]);
        const name = isShown([from, to]) ? `the first steady cycle, ${cycle.found.times} like it in a row: ` : '';
        const lack = all && !cycle.found && W.shown.commands.length > MANY ? `; ${cycle.reason}` : '';
        return `Shown: ${name}${all ? `the whole run, ${W.seconds(to - from)}` : `${W.seconds(from)} to ${
            W.seconds(to)} of ${W.seconds(W.clock.end)}`}${lack}`;
    };

    function buttons() {
        const tools = [['Shorter time', '+', '+', () => W.clock.zoom(0.5)], ['Longer time', '-', '\u2212', () => W.clock.zoom(2)],
            ['The first steady cycle', 'c', 'Cycle', cycle.show], ['The whole run', '0', 'All', () => W.clock.reset()]];
        return tools.filter(([, key]) => key !== 'c' || cycle.found).map(([title, key, text, act]) => W.element('button',
            { type: 'button', title: `${title} (${key})`, 'aria-label': title, 'aria-keyshortcuts': key, click: act }, text));
    }

    /* The toolbar above the plots. */
    cycle.toolbar = function () {
        const made = buttons();
        const text = W.element('span', { class: 'note window' });
        const update = () => {
            text.textContent = cycle.text();
            made.filter((each) => each.textContent === 'Cycle').forEach((each) => each.setAttribute('aria-pressed',
                isShown(W.clock.window)));
        };
        W.clock.on('window', update);
        update();
        return W.element('div', { class: 'zoom', role: 'toolbar', 'aria-label': 'Time window' }, text, ...made);
    };

    cycle.start = function (doc) {
        read(doc);
        if (!doc.run.flow && cycle.found && doc.duration - doc.begin > COMB * (cycle.found.window[1] - cycle.found.window[0])) {
            cycle.show();
        }
        cycle.opened = W.clock.window.slice();
    };

    W.cycle = cycle;
}(window.Waferhand));
