/* Puts the page together: the parts that are seen first come first, the rest follows when there is time. */
(function (W) {
    'use strict';

    /* A part that cannot be shown says so in its place and leaves the others alone. */
    function part(host, build) {
        try {
            build();
        } catch (error) {
            host.append(W.why(`This part cannot be shown: ${error.message}.`));
            W.faults.push(error);
        }
    }

    const host = (id) => document.getElementById(id);

    function plots(doc) {
        host('plots').append(W.cycle.toolbar());
        W.plots.start(doc);
        const curves = W.curves.groups(doc);
        const bars = W.bars.groups(doc);
        host('plots').append(W.plots.section(curves[0]), ...bars.map(W.lanes.section),
            ...curves.slice(1).map(W.plots.section));
        if (!doc.grows) {
            W.scans.start(doc, host('plots'));
            W.centrings.start(doc, host('plots'));
        }
        W.plots.fill(false);
        W.clock.on('growth', () => W.lanes.renew(W.bars.groups(doc)));
    }

    function tables(doc) {
        W.tables.start(doc, host('tables'));
        W.reproduce.start(doc, host('tables'));
    }

    /* Builds the rest, after the first picture. */
    function rest(doc) {
        part(host('plots'), () => plots(doc));
        part(host('tables'), () => tables(doc));
        W.print.start();
        W.given.shown();
        performance.mark('complete');
    }

    function show(doc) {
        if (W.isOver) {
            return;
        }
        if (!doc) {
            host('head').append(W.why(`The document of this report cannot be read: ${W.fault}.`));
            performance.mark('complete');
            return;
        }
        W.shown = doc;
        W.clock.start(doc);
        W.cycle.start(doc);
        host('head').replaceChildren();
        part(host('head'), () => W.summary.start(doc));
        W.lanes.start();
        part(host('flow'), () => W.flow.start(doc, host('flow')));
        part(host('canvas'), () => W.stage.start(doc));
        part(host('transport'), () => W.transport.start(doc));
        part(host('now'), () => W.now.start(doc));
        part(host('measure'), () => W.measure.start(doc));
        if (doc.grows) {
            part(host('cards'), () => W.cards.start(doc, host('cards')));
        }
        W.keys.start();
        W.link.start();
        if (doc.grows) {
            W.live.start(doc);
        }
        requestAnimationFrame(() => setTimeout(() => {
            if (!W.isOver) {
                performance.mark('interactive');
                W.given.seen();
                rest(doc);
            }
        }, 0));
    }

    W.faults = [];
    W.document.read().then(show);
}(window.Waferhand));
