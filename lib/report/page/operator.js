/* An operator's commands from a live page to the prompt of motion control: a line with completion and history, jogging, stop,
 * undo, and states that are saved and restored. Each is a line of the prompt. After RESET, RESTORE and UNDO the page is loaded
 * anew, so what it has to know then is kept for the window. */
(function (W) {
    'use strict';

    const KEY = 'waferhand-operator';
    const MOST = 100; /* lines of history, and answers that came before the number that they have */
    const DEGREES = 180 / Math.PI;
    const STEPS = [0.1, 1, 5, 10, 50];

    const operator = { awaited: new Map(), early: new Map(), completing: null, at: null, targets: new Map(),
        open: 0 /* lines without an answer */ };

    function load() {
        const nothing = { history: [], sent: null, answer: null, typing: false, text: '' };
        try {
            return Object.assign(nothing, JSON.parse(sessionStorage.getItem(KEY)));
        } catch (error) {
            return nothing;
        }
    }

    /* A page that goes keeps what it has: its requests fail then. */
    function keep(more) {
        if (operator.leaves) {
            return;
        }
        Object.assign(operator.kept, more);
        sessionStorage.setItem(KEY, JSON.stringify(operator.kept));
    }

    /* ----------------------------------------------------------------------------------------------------- answers */

    function show({ line, text, ok }) {
        W.control.tell(`${line}: ${text}`, ok ? 'note' : 'failure');
        keep({ answer: { line, text, ok } });
        if (ok && /^\s*(save|reset)\b/i.test(line)) {
            askSaved();
        }
    }

    /* With no answer to come, the axes stand where they are. */
    function close() {
        --operator.open;
        if (operator.open === 0) {
            operator.targets.clear();
            keep({ sent: null });
        }
    }

    /* An answer that nobody has asked for is another page's, or it came before the number that it has. */
    function putAside(what) {
        operator.early.set(what.id, what);
        if (operator.early.size > MOST) {
            operator.early.delete(operator.early.keys().next().value);
        }
    }

    function hearEarly(id) {
        const what = operator.early.get(id);
        if (what) {
            operator.early.delete(id);
            operator.hear(what);
        }
    }

    function hearAnswer(what) {
        const waiting = operator.awaited.get(what.id);
        if (waiting === undefined) {
            putAside(what);
            return;
        }
        operator.awaited.delete(what.id);
        close();
        show({ line: waiting, text: what.text, ok: what.ok });
    }

    /* An answer that came while the page was loaded anew is the last one in the list of what was said. */
    function findMissed(doc) {
        const said = (doc.run.frames || []).filter((frame) => frame.port === 'page');
        const last = said[said.length - 1];
        if (operator.missed && last && last.kind === '<') {
            show({ line: operator.missed, text: last.text, ok: !last.text.startsWith('ERROR') });
            operator.missed = null;
            keep({ sent: null });
        }
    }

    async function send(line) {
        const { history } = operator.kept;
        if (history[history.length - 1] !== line) {
            history.push(line);
            history.splice(0, history.length - MOST);
        }
        operator.at = null;
        list([], '');
        ++operator.open;
        keep({ sent: line });
        const told = await W.control.ask({ line });
        if (told) {
            operator.awaited.set(told.id, line);
            hearEarly(told.id);
        } else {
            close();
        }
    }

    /* -------------------------------------------------------------------------------------------------- completion */

    /* The beginning that all candidates share. */
    function common(words) {
        let length = words[0].length;
        words.forEach((word) => {
            while (word.slice(0, length) !== words[0].slice(0, length)) {
                --length;
            }
        });
        return words[0].slice(0, length);
    }

    /* Puts a word in the place of the one before the cursor. */
    function insert(kept, word, isWhole) {
        const { line } = operator;
        const rest = line.value.slice(line.selectionStart);
        const text = kept + word + (isWhole && !word.endsWith('=') && !rest.startsWith(' ') ? ' ' : '');
        line.value = text + rest;
        line.setSelectionRange(text.length, text.length);
        line.focus();
    }

    function list(words, kept) {
        operator.list.replaceChildren(...words.map((word) => W.element('button', { type: 'button',
            click: () => { insert(kept, word, true); list([], ''); } }, word)));
        operator.list.hidden = words.length === 0;
    }

    /* Answers that are late, and those of other pages, are left out. */
    function hearCandidates({ id, line, kept, candidates }) {
        const own = operator.completing;
        if (!own || own.id !== id || operator.line.value.slice(0, operator.line.selectionStart) !== line) {
            return;
        }
        operator.completing = null;
        if (candidates.length > 0) {
            const shared = common(candidates);
            if (candidates.length === 1 || (kept + shared).length > line.length) {
                insert(kept, shared, candidates.length === 1);
            }
            W.say(`${candidates.length} candidates`);
        } else {
            W.say('no candidates');
        }
        list(candidates.length > 1 ? candidates : [], kept);
    }

    async function complete() {
        const { line } = operator;
        const own = { id: null };
        operator.completing = own;
        const told = await W.control.ask({ complete: line.value.slice(0, line.selectionStart) });
        if (told) {
            own.id = told.id;
            hearEarly(told.id);
        }
    }

    /* The names of saved states, as RESTORE is completed. */
    async function askSaved() {
        const own = { id: null };
        operator.asking = own;
        const told = await W.control.ask({ complete: 'RESTORE ' });
        if (told) {
            own.id = told.id;
            hearEarly(told.id);
        }
    }

    function hearSaved(names) {
        operator.saved = names;
        operator.restore.replaceChildren(W.element('option', { value: '' }, 'Restore \u2026'),
            ...names.map((name) => W.element('option', { value: name }, name)));
        operator.restore.disabled = names.length === 0;
    }

    /* { id, ok, line, text } answers a line, { id, ok, line, kept, candidates } completes one. */
    operator.hear = function (what) {
        if (!operator.line) {
            return;
        }
        if (!what.candidates) {
            hearAnswer(what);
        } else if (operator.asking && operator.asking.id === what.id) {
            operator.asking = null;
            hearSaved(what.candidates);
        } else if (operator.completing && operator.completing.id === what.id) {
            hearCandidates(what);
        } else {
            putAside(what);
        }
    };

    /* ----------------------------------------------------------------------------------------------------- history */

    function recall(by) {
        const { history } = operator.kept;
        const at = W.clamp((operator.at === null ? history.length : operator.at) + by, 0, history.length);
        operator.at = at;
        operator.line.value = history[at] || '';
        operator.line.setSelectionRange(operator.line.value.length, operator.line.value.length);
    }

    function typed() {
        list([], '');
        keep({ text: operator.line.value });
    }

    /* In an empty line the tabulator leads on, as everywhere. */
    function pressed(event) {
        const { key } = event;
        if (key === 'Tab' && !event.shiftKey && operator.line.value.trim() !== '') {
            complete();
        } else if (key === 'ArrowUp' || key === 'ArrowDown') {
            recall(key === 'ArrowUp' ? -1 : 1);
        } else if (key === 'Escape') {
            operator.line.value = '';
            typed();
        } else {
            return;
        }
        event.preventDefault();
    }

    /* --------------------------------------------------------------------------------------------------------- jog */

    const AXIS = /^(?:(.*) )?(theta|r|z|yaw|forearm|rail|tilt_x|tilt_y|r2|yaw2)$/i;

    /* The axes of robots, which MOVE knows by name, and straight ways along x, y and z, which LINE goes. */
    function ways(doc) {
        const axes = doc.names.axes.map(({ name, unit }, i) => ({ name, unit, axis: i, found: AXIS.exec(name) }))
            .filter(({ axis, found }) => found && doc.tracks.axes[axis])
            .map((way) => Object.assign(way, { robot: way.found[1], command: way.found[2].toLowerCase() }));
        const robots = Array.from(new Set(axes.map(({ robot }) => robot)));
        return axes.concat(...robots.map((robot) => ['x', 'y', 'z'].map((way) => ({ robot, unit: 'mm', command: way,
            name: `${robot ? `${robot} ` : ''}${way}, straight` }))));
    }

    /* Where the axis stands, or will once the lines that wait have been executed. */
    function placeOf(doc, { axis, unit }) {
        const now = W.tracks.curve(doc.tracks.axes[axis], doc.duration, false);
        return operator.targets.has(axis) ? operator.targets.get(axis) : (unit === 'rad' ? DEGREES : 1) * now;
    }

    function jog(doc, sign) {
        const way = operator.ways[Number(operator.axis.value)];
        const step = sign * Number(operator.step.value);
        const robot = way.robot ? ` robot=${W.control.quoted(way.robot)}` : '';
        if (way.axis === undefined) {
            send(`LINE d${way.command}=${step}${robot}`);
            return;
        }
        const target = Number((placeOf(doc, way) + step).toFixed(4));
        operator.targets.set(way.axis, target);
        send(`MOVE ${way.command}=${target}${robot}`);
    }

    function jogging(doc) {
        const unit = () => (operator.ways[Number(operator.axis.value)].unit === 'rad' ? '\u00b0' : '\u00a0mm');
        const steps = () => operator.step.replaceChildren(...STEPS.map((step) => W.element('option', { value: step,
            selected: step === Number(operator.step.value || 1) }, `${step}${unit()}`)));
        operator.ways = ways(doc);
        operator.axis = W.element('select', { id: 'jogaxis', 'aria-label': 'What is jogged', change: steps },
            ...operator.ways.map(({ name }, i) => W.element('option', { value: i }, name)));
        operator.step = W.element('select', { id: 'jogstep', 'aria-label': 'By how much' });
        if (operator.ways.length > 0) {
            steps();
        }
        return W.element('span', { class: 'row', role: 'group', 'aria-label': 'Jog', hidden: operator.ways.length === 0 }, 'Jog',
            operator.axis, operator.step, W.control.button('jogless', '\u2212', 'By a step back', () => jog(doc, -1)),
            W.control.button('jogmore', '+', 'By a step on', () => jog(doc, 1)));
    }

    /* -------------------------------------------------------------------------------------------------------- parts */

    /* A name for a state that none has yet. */
    function nextName() {
        let number = 1;
        while ((operator.saved || []).includes(`state${number}`)) {
            ++number;
        }
        return `state${number}`;
    }

    /* Faults are put into the line, where they can be changed before they are sent. */
    function faults(doc, kinds) {
        const select = W.element('select', { id: 'faults', 'aria-label': 'A fault for the line', change: () => {
            operator.line.value = select.value;
            select.value = '';
            operator.line.focus();
        } }, W.element('option', { value: '' }, 'Fault \u2026'));
        doc.names.grippers.forEach((name) => kinds.forEach((kind) => {
            const text = `FAULT ${kind} gripper=${W.control.quoted(name)}`;
            select.append(W.element('option', { value: text }, text));
        }));
        return select;
    }

    function form(doc) {
        operator.line = W.element('input', { type: 'text', id: 'line', maxlength: 1000, autocomplete: 'off', spellcheck: 'false',
            autocapitalize: 'off', 'aria-label': 'A command', placeholder: 'GET, PUT, MOVE \u2026 (Tab completes)',
            value: operator.kept.text, keydown: pressed, input: typed, focus: () => keep({ typing: true }),
            blur: () => keep({ typing: false }) });
        operator.list = W.element('div', { id: 'candidates', class: 'row', role: 'group', 'aria-label': 'Candidates',
            hidden: true });
        W.clock.on('growth', () => findMissed(doc));
        return W.element('form', { submit: (event) => {
            event.preventDefault();
            if (operator.line.value.trim() !== '') {
                send(operator.line.value);
                operator.line.value = '';
                typed();
            }
        } }, operator.line, W.control.button('complete', '\u2026', 'Complete the word (Tab)', complete),
        W.element('button', { type: 'submit' }, 'Send'));
    }

    function states() {
        operator.restore = W.element('select', { id: 'restore', disabled: true, 'aria-label': 'A saved state to restore',
            change: () => { send(`RESTORE ${operator.restore.value}`); operator.restore.value = ''; } });
        hearSaved([]);
        return [W.control.button('save', 'Save', 'Keep the whole state under a name', () => send(`SAVE ${nextName()}`)),
            operator.restore, W.control.button('undo', 'Undo', 'Take the last command back', () => send('UNDO'))];
    }

    /* The rows of an operator's commands; `kinds` are those of faults. */
    operator.start = function (doc, kinds) {
        operator.kept = load();
        W.listen(window, 'beforeunload', () => { operator.leaves = true; });
        operator.missed = operator.kept.sent;
        const row = (...parts) => W.element('div', { class: 'row' }, ...parts);
        const made = [row(form(doc), faults(doc, kinds)), operator.list,
            row(W.control.button('stop', 'Stop', 'End what runs', () => send('STOP')), ...states(), jogging(doc))];
        return made;
    };

    /* After the rows are in the page. */
    operator.begin = function (doc) {
        const { answer, typing } = operator.kept;
        if (answer) {
            W.control.tell(`${answer.line}: ${answer.text}`, answer.ok ? 'note' : 'failure');
        }
        findMissed(doc);
        askSaved();
        if (typing) {
            operator.line.focus();
            operator.line.setSelectionRange(operator.line.value.length, operator.line.value.length);
        }
    };

    W.operator = operator;
}(window.Waferhand));
