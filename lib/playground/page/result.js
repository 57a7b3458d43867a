/* The verdict, the hash, the tables as the program prints them, and where in the files something is wrong. */
(function (P) {
    'use strict';

    const WORDS = { met: ['\u2713 passed', 'good'], failed: ['\u2717 failed', 'bad'], bad_input: ['not usable', 'bad'] };
    const result = { answer: null, marks: [] };
    const pill = (text, kind) => P.element('span', { class: `pill ${kind || ''}` }, text);

    /* The place that a message begins with, in one of our files: FILE:LINE, or FILE: FIELD with the line of that field. */
    function headOf(text) {
        const [, named, line, field, rest] = /^(\S[^:\n]*\.\w+):(?:(\d+):|(?: ([\w.[\]" ]+): )?)([^]*)$/.exec(text) || [];
        const path = named ? P.files.plain(named) : '';
        if (typeof P.files.text(path) !== 'string') {
            return null;
        }
        const told = field ? `${field}: ${rest}` : rest.trim();
        return { path, line: Number(line) || P.hints.lineOf(P.files.text(path), field || '') || 1, text: told };
    }

    /* The innermost place of a message: a script's line names a layout, and that a field. */
    function placeOf(message) {
        const outer = headOf(message || '');
        const inner = outer && placeOf(outer.text);
        return inner || outer;
    }

    function marksOf(answer) {
        const failure = placeOf(answer.message);
        const unmet = (answer.unmet || []).map(({ line, text }) => ({ path: P.files.script, line, text }));
        return (failure ? [failure] : []).concat(unmet);
    }

    function place({ path, line }) {
        return P.element('button', { type: 'button', class: 'place', click: () => P.editor.go(path, line) },
            `${path.replace(/^.*\//, '')}:${line}`);
    }

    function reason({ message }) {
        const at = placeOf(message);
        return message ? [P.element('p', { class: 'failure' }, ...(at ? [place(at), ' ', at.text] : [message]))] : [];
    }

    function others(answer) {
        return (answer.others || []).map((name) => P.element('p', { class: 'note' },
            `The layout has what waferhand ${name} plays in many runs, in threads: a page plays this one alone.`));
    }

    const isRow = (line) => /\S {2,}\S|\t/.test(line);

    /* Rows of a table keep their blanks; a sentence, which has no two of them in a row, goes on in the next line. */
    function lines(text) {
        return (text.match(/.*\n|.+$/g) || [])
            .map((line) => (isRow(line) ? line : P.element('span', { class: 'sentence' }, line)));
    }

    function show(answer, ms) {
        const [text, kind] = WORDS[answer.outcome];
        const hash = P.element('code', { id: 'hash', title: 'The hash of the last state, as waferhand run gives it' },
            answer.hash || '');
        const took = P.element('span', { class: 'note', id: 'took' }, `${Math.round(ms)}\u00a0ms`);
        P.host('verdict').replaceChildren(P.element('div', { class: 'row' }, pill(text, kind), hash, took), ...reason(answer),
            ...others(answer));
        P.host('tables').replaceChildren(...lines(answer.tables));
        P.say(text);
    }

    function showFault(text, kind) {
        P.host('verdict').replaceChildren(P.element('div', { class: 'row' }, pill(kind, 'bad')),
            P.element('p', { class: 'failure' }, text));
        P.host('tables').textContent = '';
    }

    result.start = function () {
        P.on('begun', () => P.host('result').classList.add('busy'));
        P.on('ended', () => P.host('result').classList.remove('busy'));
        P.on('answer', ({ answer, ms }) => {
            result.answer = answer;
            result.marks = marksOf(answer);
            show(answer, ms);
            P.files.notice(answer.inputs || []);
            P.editor.mark(result.marks);
        });
        P.on('fault', ({ text }) => {
            result.answer = null;
            result.marks = [];
            showFault(text, 'ended');
            P.editor.mark([]);
        });
        P.on('stopped', () => showFault('The run was stopped before its end.', 'stopped'));
    };

    P.result = result;
}(window.Playground));
