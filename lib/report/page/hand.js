/* A hand on a chart of lanes: the pointer or the keys go from bar to bar, the bar is told, and one may be chosen. A group with a
 * function `choose` has it; its bars have texts to `say`. */
(function (W) {
    'use strict';

    const HINT = 'Point at a bar, or go from bar to bar with the arrow keys; a click or Enter shows the wafer. Drag to zoom.';

    function tell(chart, bar, paint) {
        if (chart.bar !== bar) {
            chart.bar = bar;
            chart.readout.textContent = bar ? bar.say : HINT;
            paint(chart);
        }
    }

    /* The bar that is shown at a time, or the nearest one. */
    function near(lane, t) {
        const off = (bar) => Math.max(bar.from - t, t - bar.to, 0);
        return lane.bars.reduce((best, bar) => (!best || off(bar) < off(best) ? bar : best), null);
    }

    const laneOf = (chart) => chart.group.lanes.findIndex((lane) => lane.bars.includes(chart.bar));

    /* The bar `step` places on in its lane; without one the first that the window shows. */
    function along(chart, step) {
        const lane = chart.group.lanes[laneOf(chart)];
        if (!lane) {
            const shown = chart.group.lanes.find((each) => each.bars.length > 0);
            return shown ? near(shown, W.clock.window[0]) : null;
        }
        return lane.bars[lane.bars.indexOf(chart.bar) + step] || chart.bar;
    }

    /* The bar at the same time in the next lane that has one. */
    function across(chart, step) {
        const at = laneOf(chart);
        if (at < 0) {
            return along(chart, 0);
        }
        const lanes = chart.group.lanes;
        for (let i = at + step; i >= 0 && i < lanes.length; i += step) {
            if (lanes[i].bars.length > 0) {
                return near(lanes[i], (chart.bar.from + chart.bar.to) / 2);
            }
        }
        return chart.bar;
    }

    function end(chart, last) {
        const lane = chart.group.lanes[Math.max(laneOf(chart), 0)];
        return lane.bars[last ? lane.bars.length - 1 : 0] || chart.bar;
    }

    const MOVES = { ArrowRight: (chart) => along(chart, 1), ArrowLeft: (chart) => along(chart, -1),
        ArrowDown: (chart) => across(chart, 1), ArrowUp: (chart) => across(chart, -1), Home: (chart) => end(chart, false),
        End: (chart) => end(chart, true), Escape: () => null };

    /* Turns the page of time until the bar is seen. */
    function show(bar) {
        const [from, to] = W.clock.window;
        if (bar && (bar.to < from || bar.from > to)) {
            const begin = (bar.from + bar.to - (to - from)) / 2;
            W.clock.setWindow(begin, begin + to - from);
        }
    }

    /* True if the key means something here. */
    function act(chart, key, paint) {
        if (MOVES[key]) {
            const bar = MOVES[key](chart);
            show(bar);
            tell(chart, bar, paint);
            W.say(bar ? bar.say : 'no bar');
            return true;
        }
        const isChoice = (key === 'Enter' || key === ' ') && chart.bar;
        if (isChoice) {
            choose(chart, chart.bar, chart.bar.from);
        }
        return isChoice;
    }

    function pressed(chart, event, paint) {
        const other = event.ctrlKey || event.altKey || event.metaKey || event.shiftKey;
        if (!other && act(chart, event.key, paint)) {
            event.preventDefault();
            event.stopPropagation();
        }
    }

    function choose(chart, bar, t) {
        W.clock.seek(t);
        chart.group.choose(bar);
    }

    /* `barAt` finds the bar under a pointer, `paint` draws the chart. */
    function listen(chart, barAt, paint) {
        chart.bar = null;
        chart.readout = W.element('p', { class: 'note readout', 'aria-hidden': 'true' }, HINT);
        chart.canvas.setAttribute('tabindex', 0);
        chart.canvas.setAttribute('role', 'application');
        chart.canvas.setAttribute('aria-roledescription', 'chart');
        chart.canvas.addEventListener('pointermove', (event) => tell(chart, barAt(chart, event), paint));
        chart.canvas.addEventListener('pointerleave', () => tell(chart, null, paint));
        chart.canvas.addEventListener('keydown', (event) => pressed(chart, event, paint));
        return chart.readout;
    }

    W.hand = { listen };
}(window.Waferhand));
