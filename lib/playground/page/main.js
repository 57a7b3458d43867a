/* Puts the playground together, and runs the cell at each change. */
(function (P) {
    'use strict';

    const FIRST = 'lua/examples/01_transfer.lua';
    const REST_MS = 60; /* of the keyboard, before a run begins */
    let later = null;

    function edited() {
        clearTimeout(later);
        later = setTimeout(P.runner.run, REST_MS);
    }

    function refuse(text) {
        P.host('verdict').append(P.element('p', { class: 'failure' }, text));
    }

    /* The cell of a link, or the first example. */
    async function open() {
        const cell = await P.link.read().catch((error) => P.bar.tell(`The link cannot be used: ${error.message}.`, true));
        if (cell) {
            P.link.open(cell);
        } else {
            P.files.open(FIRST, {});
        }
    }

    async function start() {
        if (!window.DecompressionStream || !window.WebAssembly) {
            throw new Error('it takes a browser of 2023 or later');
        }
        await P.files.start();
        await P.runner.start();
        P.about.start();
        P.bar.start();
        P.editor.start();
        P.result.start();
        P.picture.start();
        P.paper.start();
        P.bar.pane('edit');
        P.on('edited', edited);
        await open();
        window.addEventListener('hashchange', open);
        P.runner.ask('definitions').then(P.definitions.read);
        performance.mark('ready');
    }

    start().catch((error) => refuse(`The playground does not work here: ${error.message}.`));
}(window.Playground));
