/* The editor: a tab for each file of the cell, Lua's colours, completion, and what is wrong at its line. */
(function (P) {
    'use strict';

    const editor = { documents: new Map(), marks: [], made: [] };
    const indent = (mirror) => (mirror.somethingSelected() ? mirror.indentSelection('add') : mirror.replaceSelection('  '));
    const KEYS = { Tab: indent, 'Shift-Tab': 'indentLess', 'Ctrl-Space': 'autocomplete', 'Ctrl-/': 'toggleComment',
        'Cmd-/': 'toggleComment',
        'Ctrl-Enter': () => P.runner.run(), 'Cmd-Enter': () => P.runner.run(),
        Esc: (mirror) => mirror.getInputField().blur() };

    function documentOf(path) {
        if (!editor.documents.has(path)) {
            const mode = /\.lua$/.test(path) ? 'lua' : null;
            const made = window.CodeMirror.Doc(P.files.text(path), mode);
            made.on('change', () => P.files.change(path, made.getValue()));
            editor.documents.set(path, made);
        }
        return editor.documents.get(path);
    }

    const TITLES = ['Script', 'Layout', 'File'];

    function tab(path, i) {
        const isShown = path === P.files.shown;
        const bad = editor.marks.some((mark) => mark.path === path);
        const name = path.replace(/^.*\//, '') + (P.files.isChanged(path) ? ' \u2022' : '');
        return P.element('button', { type: 'button', role: 'tab', 'aria-selected': String(isShown), class: bad ? 'bad' : '',
            title: path, click: () => P.files.show(path) }, P.element('small', {}, TITLES[Math.min(i, 2)]), name);
    }

    function showTabs() {
        P.host('tabs').replaceChildren(...P.files.list().map(tab));
    }

    /* Takes the marks away that the shown file has. */
    function clear() {
        editor.made.splice(0).forEach((each) => each());
    }

    function markLine(mirror, { line, text }) {
        const at = Math.min(Math.max(line, 1), mirror.lineCount()) - 1;
        const note = P.element('div', { class: 'problem', role: 'note' }, text);
        const widget = mirror.addLineWidget(at, note, { coverGutter: false, noHScroll: true });
        mirror.addLineClass(at, 'background', 'problemline');
        editor.made.push(() => {
            widget.clear();
            mirror.removeLineClass(widget.line, 'background', 'problemline');
        });
    }

    function showMarks() {
        clear();
        editor.marks.filter((mark) => mark.path === P.files.shown).forEach((mark) => markLine(editor.mirror, mark));
        showTabs();
    }

    /* Marks lines: [{ path, line, text }]. */
    editor.mark = function (marks) {
        editor.marks = marks;
        showMarks();
    };

    editor.go = function (path, line) {
        P.files.show(path);
        P.bar.pane('edit');
        editor.mirror.setCursor({ line: line - 1, ch: 0 });
        editor.mirror.scrollIntoView(null, 120);
        editor.mirror.focus();
    };

    function open(path) {
        clear();
        editor.mirror.swapDoc(documentOf(path));
        showMarks();
    }

    /* Another cell: texts of the one before are forgotten. */
    editor.forget = () => editor.documents.clear();

    /* Completion comes by itself behind a letter or a quote. */
    function complete(mirror, change) {
        if (change.origin === '+input' && /^[A-Za-z_"]$/.test(change.text.join('')) && !mirror.state.completionActive) {
            mirror.showHint({ hint: P.hints.find, completeSingle: false });
        }
    }

    editor.start = function () {
        editor.mirror = window.CodeMirror(P.host('editor'), { lineNumbers: true, indentUnit: 2, tabSize: 2, matchBrackets: true,
            autoCloseBrackets: true, styleActiveLine: true, extraKeys: KEYS,
            hintOptions: { hint: P.hints.find, completeSingle: false }, inputStyle: 'contenteditable', viewportMargin: 20 });
        editor.mirror.getInputField().setAttribute('aria-label', 'Text of the file; Escape leaves it');
        editor.mirror.on('inputRead', complete);
        P.on('opened', open);
        P.on('edited', showTabs);
    };

    P.editor = editor;
}(window.Playground));
