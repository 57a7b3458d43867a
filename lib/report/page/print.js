/* The page on paper: light colours, every plot drawn, and a still picture of the cell in place of the moving one. */
(function (W) {
    'use strict';

    let still = null;
    let unfolded = [];

    /* Paper has no folds. */
    function unfold() {
        unfolded = Array.from(document.querySelectorAll('#flow details:not([open])'));
        unfolded.forEach((each) => { each.open = true; });
    }

    function before() {
        W.clock.pause();
        W.theme.show('light');
        W.clock.flush();
        W.lanes.showAll();
        unfold();
        if (W.plots) {
            W.plots.showAll();
            W.scans.resize();
        }
        if (W.stage && W.stage.view) {
            W.stage.view.paint();
            still = W.element('img', { id: 'still', src: W.stage.view.still(), alt: 'The cell at the shown time' });
            document.getElementById('canvas').append(still);
        }
    }

    function after() {
        if (still) {
            still.remove();
            still = null;
        }
        unfolded.forEach((each) => { each.open = false; });
        W.theme.restore();
    }

    W.print = {
        start() {
            W.listen(window, 'beforeprint', before);
            W.listen(window, 'afterprint', after);
        },
    };
}(window.Waferhand));
