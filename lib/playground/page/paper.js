/* Paper: the verdict, the picture as it stands, the tables, and the texts of the cell, black on white. */
(function (P) {
    'use strict';

    const paper = {};

    /* The picture of the cell at the shown time; null: there is none. */
    function still() {
        const frame = document.querySelector('#picture iframe:not([hidden])');
        const shown = frame && frame.contentWindow.Waferhand;
        const view = shown && shown.stage && shown.stage.view;
        return view && view.still ? P.element('img', { src: view.still(), alt: 'The cell at the shown time' }) : null;
    }

    const text = (title, content) => [P.element('h2', {}, title), P.element('pre', {}, content)];

    paper.make = function () {
        const verdict = P.host('verdict').cloneNode(true);
        verdict.removeAttribute('id');
        const picture = still();
        const made = P.element('section', { id: 'paper' }, P.element('h1', {}, P.files.script), ...verdict.children,
            ...(picture ? [picture] : []), ...text('Result', P.host('tables').textContent),
            ...[].concat(...P.files.list().map((path) => text(path, P.files.text(path)))));
        made.querySelectorAll('[id]').forEach((each) => each.removeAttribute('id'));
        return made;
    };

    paper.start = function () {
        window.addEventListener('beforeprint', () => document.body.append(paper.make()));
        window.addEventListener('afterprint', () => P.host('paper').remove());
    };

    P.paper = paper;
}(window.Playground));
