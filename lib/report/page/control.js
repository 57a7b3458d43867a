/* Commands of a live page: pause, steps and pace of a run; lines of a tester beside the hosts, or of an operator (operator.js).
 * The token comes behind the page's address, and is kept from there on by this window alone. */
(function (W) {
    'use strict';

    const KEY = 'waferhand-token';
    const RATES = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 1000];
    const control = { token: null };

    /* Takes the token out of the address, so that a link that is passed on has none. */
    function findToken() {
        const found = new URLSearchParams(location.hash.slice(1));
        if (found.has('token')) {
            sessionStorage.setItem(KEY, found.get('token'));
            found.delete('token');
            history.replaceState(null, '', location.pathname + (String(found) ? `#${found}` : ''));
        }
        return sessionStorage.getItem(KEY);
    }

    function tell(text, kind) {
        control.said.textContent = text;
        control.said.className = kind;
    }

    /* Promises the answer, or null if it was refused. */
    async function ask(request) {
        try {
            const answer = await fetch('control', { method: 'POST', headers: { 'Content-Type': 'application/json' },
                body: JSON.stringify(Object.assign({ token: control.token }, request)) });
            const told = await answer.json();
            if (!told.ok || !('complete' in request)) {
                tell(told.ok ? '' : told.text, told.ok ? 'note' : 'failure');
            }
            return told.ok ? told : null;
        } catch (error) {
            tell(`not sent: ${error.message}`, 'failure');
            return null;
        }
    }

    const button = (id, text, title, act) => W.element('button', { type: 'button', id, title, click: act }, text);

    function rates() {
        const select = control.rate = W.element('select', { id: 'rate', 'aria-label': 'Pace of the cell',
            change: () => ask({ rate: Number(select.value) }) });
        RATES.concat(0).forEach((rate) => select.append(W.element('option', { value: rate },
            rate > 0 ? `${rate}\u00d7` : 'as fast as it can')));
        return select;
    }

    /* The pace may be one that is not listed, of the command line. */
    function showRate(rate) {
        const text = String(typeof rate === 'number' ? rate : 0);
        const { rate: select } = control;
        if (select && document.activeElement !== select) {
            if (!Array.from(select.options).some((option) => option.value === text)) {
                select.append(W.element('option', { value: text }, `${W.figure(rate)}\u00d7`));
            }
            select.value = text;
        }
    }

    function ofRun() {
        control.pause = button('pause', 'Pause', 'The cell stands still, and goes on', () => ask({ pause: !control.isPaused }));
        control.steps = [button('slice', 'One slice', 'One slice on, then it stands again', () => ask({ slices: 1 })),
            button('command', 'One command', 'To the end of a command, then it stands', () => ask({ command: true }))];
        return [control.pause, ...control.steps];
    }

    /* HOLD and CONTINUE of a flow's robots. */
    function holds(state) {
        const select = W.element('select', { id: 'robot', 'aria-label': 'Robots of a flow' });
        select.append(W.element('option', { value: '' }, 'all robots'));
        (state.robots || []).forEach((robot) => select.append(W.element('option', { value: robot }, robot)));
        const which = () => select.value || true;
        const why = 'This robot of a flow stands after the segment that runs';
        return [select, button('hold', 'Hold', why, () => ask({ hold: which() })),
            button('continue', 'Continue', 'It goes on', () => ask({ continue: which() }))];
    }
    /* A name as the prompt reads it. */
    const quoted = (name) => (/^[\w./-]+$/.test(name) ? name : `"${name.replace(/["\\]/g, '\\$&')}"`);

    const LINES = ['STATUS', 'ALARM WAFER_MISSING', 'CLEAR'];

    /* The lines that a reader may begin with: each fault of each gripper, and where the wafers are. */
    function suggestions(doc, faults) {
        const lines = LINES.concat(doc.names.wafers.map((name) => `WHERE ${quoted(name)}`),
            ...doc.names.grippers.map((name) => faults.map((kind) => `FAULT ${kind} gripper=${quoted(name)}`)));
        return W.element('datalist', { id: 'lines' }, ...lines.map((line) => W.element('option', { value: line })));
    }

    /* The answer is a frame of the tester's port that has the request's id: as an object, or null. */
    function answerOf(doc, id) {
        const told = (doc.run.frames || []).filter((frame) => frame.kind === '<' && frame.port.startsWith('control'))
            .map((frame) => frame.text.replace(/\\n$/, '').replace(/\\(["\\])/g, '$1'));
        const found = told.find((text) => text.includes(`"id":${id},`));
        try {
            return found ? JSON.parse(found) : null;
        } catch (error) {
            return { ok: true, answer: found };
        }
    }

    function ofTester(doc, faults) {
        const line = W.element('input', { type: 'text', id: 'line', list: 'lines', maxlength: 1000, autocomplete: 'off',
            spellcheck: 'false', 'aria-label': 'A tester\u2019s line', placeholder: 'FAULT, ALARM, CLEAR, STATUS \u2026' });
        const form = W.element('form', { submit: async (event) => {
            event.preventDefault();
            const told = await ask({ line: line.value });
            control.awaited = told ? told.id : null;
            show(doc);
        } }, line, suggestions(doc, faults), W.element('button', { type: 'submit' }, 'Send'));
        W.clock.on('growth', () => show(doc));
        return [form];
    }

    function show(doc) {
        const answer = control.awaited ? answerOf(doc, control.awaited) : null;
        if (answer) {
            control.awaited = null;
            tell(answer.answer || answer.text || answer.name, answer.ok ? 'note' : 'failure');
        }
    }

    function hear(state) {
        control.isPaused = state.paused;
        showRate(state.rate);
        control.row.hidden = !!state.over || !!state.lost;
        if (control.pause) {
            control.pause.textContent = state.paused ? 'Go on' : 'Pause';
            control.pause.setAttribute('aria-pressed', !!state.paused);
        }
    }

    /* Shows what this program lets one command, to who has the token. */
    control.start = function (doc, state) {
        control.token = findToken();
        if (!state.control || !control.token) {
            return;
        }
        control.said = W.element('span', { class: 'note', role: 'status', id: 'answer' });
        const isPrompt = state.control === 'prompt';
        const held = state.paces ? [...ofRun(), ...(isPrompt ? [] : holds(state)), rates()] : [];
        const parts = state.control === 'tester' ? [...ofTester(doc, state.faults || []), rates()] : held;
        const rows = isPrompt ? W.operator.start(doc, state.faults || []) : [];
        control.row = W.element('div', { id: 'control', role: 'group', 'aria-label': 'Commands to the program' },
            W.element('div', { class: 'row' }, ...parts, control.said), ...rows);
        document.getElementById('head').append(control.row);
        W.live.on(hear);
        hear(state);
        if (isPrompt) {
            W.operator.begin(doc);
        }
    };

    Object.assign(control, { ask, tell, button, quoted });
    W.control = control;
}(window.Waferhand));
