/* Tells what this page is, what it cannot do, and which subcommand can. */
(function (P) {
    'use strict';

    const LACKS = [
        ['many runs: drawn errors, budgets, ranges of values', 'threads', 'waferhand study, budget, sweep, test'],
        ['processes in step, lcm-spy', 'LCM', 'waferhand sim, mcs, run --lcm'],
        ['the tool\u2019s own host software at ports', 'TCP and serial ports', 'waferhand serve'],
        ['a page that follows a cell live', 'a server', 'waferhand run --page'],
        ['recordings, and their replay', 'files that stay', 'waferhand run --record, replay'],
        ['plots for print', 'gnuplot', 'waferhand run --svg'],
        ['native modules and all of Lua', 'a machine to trust it with', 'waferhand run --trust'],
        ['scripts of more than 300 million steps', 'time', 'waferhand run --budget'],
    ];
    const KEYS = [['Ctrl Space', 'complete'], ['Ctrl Enter', 'run again'], ['Ctrl /', 'comment out'],
        ['Esc', 'leave the editor']];

    const cell = (text, i) => P.element('td', {}, i === 2 ? P.element('code', {}, text) : text);

    function rows(list) {
        return P.element('table', {}, P.element('tbody', {}, ...list.map((row) => P.element('tr', {}, ...row.map(cell)))));
    }

    P.about = {
        start() {
            const dialog = P.host('about');
            dialog.append(P.element('h2', {}, `Waferhand ${P.files.version} in a page`),
                P.element('p', {}, 'The engine runs here, in this browser. Nothing is sent anywhere; the page works from disk. '
                    + 'The hash is the one that waferhand run gives, bit by bit.'),
                P.element('h3', {}, 'What a page cannot do, what it would take, and what can'), rows(LACKS),
                P.element('h3', {}, 'Keys'), rows(KEYS),
                P.element('button', { type: 'button', click: () => dialog.close() }, 'Close'));
        },
        open: () => P.host('about').showModal(),
    };
}(window.Playground));
