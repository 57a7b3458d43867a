/* Saves what can be taken along: the script, the layout, the report, and the run as JSON. */
(function (P) {
    'use strict';

    const base = (path) => path.replace(/^.*\//, '');
    const stem = () => base(P.files.script).replace(/\.lua$/, '');

    function file(path) {
        if (path) {
            P.download(base(path), P.files.text(path), 'text/plain');
        }
    }

    /* Saves something of the last run, once it has ended. */
    async function ofRun(kind, name, type) {
        const text = P.runner.busy ? null : await P.runner.ask(kind);
        if (text === null) {
            P.bar.tell('There is nothing to save: nothing was played.');
        } else {
            P.download(name, text, type);
        }
    }

    P.save = {
        script: () => file(P.files.script),
        layout: () => file(P.files.list()[1]),
        report: () => ofRun('report', `${stem()}.html`, 'text/html'),
        json: () => ofRun('json', `${stem()}.json`, 'application/json'),
    };
}(window.Playground));
