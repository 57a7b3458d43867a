/* Puts the page of a flow by times alone together. */
(function (W) {
    'use strict';

    const host = (id) => document.getElementById(id);

    function part(at, build) {
        try {
            build();
        } catch (error) {
            at.append(W.why(`This part cannot be shown: ${error.message}.`));
            W.faults.push(error);
        }
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
        W.lanes.start();
        part(host('head'), () => W.summary.start(doc));
        part(host('flow'), () => W.flow.start(doc, host('flow')));
        part(host('tables'), () => {
            host('tables').append(W.tables.expectations(doc));
            W.reproduce.start(doc, host('tables'));
        });
        W.keys.start();
        W.print.start();
        W.given.seen();
        W.given.shown();
        performance.mark('interactive');
        performance.mark('complete');
    }

    W.faults = [];
    W.document.read().then(show);
}(window.Waferhand));
