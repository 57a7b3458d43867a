/* The line at the top: which cell, parameters, Stop, what can be taken along, and light or dark; on a phone also which part is
 * shown. */
(function (P) {
    'use strict';

    const bar = {};
    const PANES = [['edit', 'Edit'], ['result', 'Result'], ['picture', 'Picture']];
    const root = document.documentElement;
    const system = window.matchMedia('(prefers-color-scheme: dark)');

    bar.theme = () => root.dataset.theme;

    bar.choose = function (theme) {
        if (root.dataset.theme !== theme) {
            root.dataset.theme = theme;
            P.tell('theme', theme);
        }
    };

    const button = (text, title, act, id) => P.element('button', { type: 'button', title, id, click: act }, text);

    /* Shows a text for a moment, or until there is another one. */
    bar.tell = function (text, stays) {
        bar.note.textContent = text;
        P.say(text);
        clearTimeout(bar.later);
        bar.later = stays ? null : setTimeout(() => { bar.note.textContent = ''; }, 4000);
    };

    const nameOf = (path) => path.replace(/^.*\//, '').replace(/\.lua$/, '').replace(/_/g, ' ');

    /* Another cell, or the same as it was: the parameters and the link of the one before go. */
    function begin(open) {
        P.editor.forget();
        P.runner.parameters = [];
        bar.set.value = '';
        history.replaceState(null, '', location.href.replace(/#.*$/, ''));
        open();
    }

    const chosen = (path) => begin(() => P.files.choose(path));

    function examples() {
        const select = P.element('select', { id: 'example', 'aria-label': 'Cell', change: () => chosen(select.value) },
            P.element('option', { value: '' }, 'a new cell'),
            ...P.files.examples().map((path) => P.element('option', { value: path }, nameOf(path))));
        return select;
    }

    /* Parameters as --set takes them: NAME=VALUE, with blanks between them. */
    function parameters() {
        const input = P.element('input', { id: 'set', placeholder: 'params: NAME=VALUE', size: 20, spellcheck: 'false',
            'aria-label': 'Parameters, NAME=VALUE', input: () => {
                P.runner.parameters = input.value.split(/\s+/).filter((each) => each !== '');
                P.tell('edited', P.files.script);
            } });
        bar.set = input;
        return input;
    }

    function saving() {
        const menu = P.element('select', { id: 'save', 'aria-label': 'Save', change: () => {
            const what = menu.value;
            menu.value = '';
            P.save[what]();
        } }, P.element('option', { value: '', selected: true }, 'Save \u2026'),
        ...[['script', 'the script'], ['layout', 'the layout'], ['report', 'the report, one page'], ['json', 'the run as JSON']]
            .map(([value, text]) => P.element('option', { value }, text)));
        return menu;
    }

    bar.pane = function (name) {
        document.body.dataset.pane = name;
        PANES.forEach(([each]) => P.host(`pane-${each}`).setAttribute('aria-pressed', String(each === name)));
        P.editor.mirror.refresh();
    };

    function panes() {
        P.host('panes').append(...PANES.map(([name, text]) => button(text, `Show: ${text}`, () => bar.pane(name),
            `pane-${name}`)));
    }

    /* The verdict stands at the part that is not shown, too. */
    const SIGNS = { met: ' \u2713', failed: ' \u2717', bad_input: ' !' };

    function follow() {
        P.on('answer', ({ answer }) => { P.host('pane-result').textContent = `Result${SIGNS[answer.outcome]}`; });
        P.on('begun', () => { bar.stop.disabled = false; });
        P.on('ended', () => { bar.stop.disabled = true; });
        P.on('edited', () => { bar.reset.disabled = !P.files.areChanged(); });
        P.on('opened', () => {
            bar.examples.value = P.files.examples().includes(P.files.script) ? P.files.script : '';
        });
    }

    bar.start = function () {
        bar.examples = examples();
        bar.stop = button('Stop', 'End the run', () => P.runner.stop(), 'stop');
        bar.stop.disabled = true;
        bar.reset = button('Reset', 'Take back all changes of this cell', () => begin(P.files.reset), 'reset');
        bar.reset.disabled = true;
        bar.note = P.element('span', { class: 'note', id: 'told' });
        P.host('bar').append(P.element('h1', {}, 'Waferhand', P.element('small', {}, ' playground')), bar.examples,
            parameters(), bar.stop, bar.reset, P.element('span', { class: 'space' }), bar.note,
            button('Link', 'A link that holds this cell', () => P.link.take(), 'link'), saving(),
            button('About', 'What this page is, and what it cannot do', P.about.open, 'what'),
            button('\u25d0', 'Light or dark', () => bar.choose(bar.theme() === 'dark' ? 'light' : 'dark'), 'theme'));
        panes();
        follow();
        system.addEventListener('change', () => bar.choose(system.matches ? 'dark' : 'light'));
    };

    root.dataset.theme = system.matches ? 'dark' : 'light';
    P.bar = bar;
}(window.Playground));
