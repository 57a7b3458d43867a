/* Completion: where the cursor stands in Lua's tables and calls, and what may stand there by the definitions. */
(function (P) {
    'use strict';

    const TOKENS = /--\[\[[^]*?(?:\]\]|$)|--[^\n]*|"(?:\\.|[^"\\\n])*"?|'(?:\\.|[^'\\\n])*'?|[A-Za-z_][\w.:]*|\d[\w.]*|[^\s]/g;
    const MOST = 60;

    const isWord = (token) => /^[A-Za-z_]/.test(token);
    const isText = (token) => /^["']/.test(token);
    const bare = (token) => token.replace(/^["']|["']$/g, '');

    const topOf = (at) => at.stack[at.stack.length - 1];

    function open(at, token) {
        const top = topOf(at);
        const call = isWord(at.last) && at.last !== 'return' ? at.last : null;
        const place = at.key !== null ? at.key : String(top ? top.count + 1 : 1);
        at.stack.push({ by: token, key: at.key, call, count: 0, place });
        at.key = null;
    }

    function close(at) {
        at.stack.pop();
        at.key = null;
    }

    function pass(at) {
        at.key = null;
        if (at.stack.length > 0) {
            ++topOf(at).count;
        }
    }

    const STEPS = { '{': open, '(': open, '}': close, ')': close, ',': pass, ';': pass,
        '=': (at) => { at.key = bare(at.last === ']' ? at.before : at.last); } };

    /* Where a text ends: { stack, key, last, before }. The stack has what is open: { by, key, call, count, place }. `heard` is
     * called with the state before each token, the token, and where it stands. */
    function follow(text, heard) {
        const at = { stack: [], key: null, last: '', before: '' };
        for (const found of text.matchAll(TOKENS)) {
            const token = found[0];
            if (!token.startsWith('--')) {
                heard(at, token, found.index);
                if (STEPS[token]) {
                    STEPS[token](at, token);
                }
                at.before = at.last;
                at.last = token;
            }
        }
        return at;
    }

    /* Where a token begins something: [a key], [a number in a list], or nothing. */
    function placeHere(at, token) {
        if (token === '=') {
            return [bare(at.last === ']' ? at.before : at.last)];
        }
        return token === '{' && at.stack.length > 0 && at.key === null ? [String(topOf(at).count + 1)] : [];
    }

    /* The line of a field such as stations.A.at[2]: of the innermost part of it that the text has. */
    function lineOf(text, field) {
        const wanted = (field.match(/[^.[\]"]+/g) || []);
        let best = 0;
        let place = 0;
        follow(text, (at, token, index) => {
            const path = at.stack.slice(1).map((each) => each.place);
            const here = path.concat(placeHere(at, token));
            const deeper = here.length > Math.max(best, path.length) && here.length <= wanted.length;
            if (deeper && here.every((part, i) => part === wanted[i])) {
                best = here.length;
                place = index;
            }
        });
        return best > 0 ? text.slice(0, place).split('\n').length : 0;
    }

    /* Names in the layout: of its stations, wafers and grippers. */
    function namesOf(group) {
        const names = [];
        follow(P.files.text(P.files.list()[1]) || '', (at, token) => {
            const keys = at.stack.map((each) => each.key).filter((key) => key !== null);
            if (token === '{' && keys.length === 1 && keys[0] === group && at.key) {
                names.push(at.key);
            } else if (isText(token) && at.key === 'name' && keys[0] === group) {
                names.push(bare(token));
            }
        });
        return names;
    }

    /* The type of a call's argument: that of `get("A", 1, {`, or of `flow {`. */
    function argument(opened, around) {
        const { functions } = P.definitions;
        const inside = around && around.by === '(' ? functions.get(around.call) : null;
        const called = functions.get(opened.call) || inside;
        const found = called && called.parameters[called === inside ? around.count : 0];
        return called ? (found || { type: '' }).type : null;
    }

    /* The classes of a table within one of these classes. A list or a table by names has the classes of what is in it. */
    function within(classes, opened, around) {
        const { classesOf, field } = P.definitions;
        const type = argument(opened, around);
        if (type !== null) {
            return classesOf(type);
        }
        if (!around && opened.key === null) {
            return classesOf('waferhand.layout|waferhand.timed_layout');
        }
        const own = opened.key !== null ? field(classes, opened.key) : null;
        return own ? classesOf(own.type) : classes;
    }

    /* The classes of the innermost open table. */
    const classesAt = (stack) => stack.reduce((classes, opened, i) => (opened.by === '(' ? []
        : within(classes, opened, stack[i - 1])), []);

    const OF_NAMES = { station: 'stations', to: 'stations', from: 'stations', wafer: 'wafers', gripper: 'grippers' };

    /* The values that may stand here, quotes included. */
    function values(at) {
        const top = topOf(at);
        const call = top && top.by === '(' ? P.definitions.functions.get(top.call) : null;
        const parameter = call && call.parameters[top.count];
        const field = at.key !== null ? P.definitions.field(classesAt(at.stack), at.key) : null;
        const name = parameter ? parameter.name : at.key;
        const listed = P.definitions.valuesOf((parameter || field || {}).type);
        return listed.length > 0 || !OF_NAMES[name] ? listed : namesOf(OF_NAMES[name]).map((each) => `"${each}"`);
    }

    const entry = (text, note, shown) => ({ text, displayText: shown || text, note: note || '', render });

    function render(item, all, { displayText, note }) {
        item.append(displayText, P.element('small', {}, note));
    }

    function fields(at) {
        return [].concat(...classesAt(at.stack).map((name) => Array.from(P.definitions.classes.get(name).fields)))
            .map(([name, { type, text }]) => entry(`${name} = `, text, `${name}${/^\w+$/.test(type) ? `: ${type}` : ''}`));
    }

    const LUA = ['local', 'function', 'return', 'if', 'then', 'else', 'for', 'do', 'end', 'while', 'repeat', 'until'];

    const words = () => Array.from(P.definitions.functions)
        .map(([name, { text, list }]) => entry(name, text, `${name}(${list})`)).concat(LUA.map((each) => entry(each)));

    function candidates(at) {
        const top = topOf(at);
        const isTable = Boolean(top) && top.by === '{';
        if (at.key !== null || (top && top.by === '(')) {
            return values(at).map((each) => entry(each));
        }
        return isTable ? fields(at) : words();
    }

    /* The word or the text that has been begun where a text ends. */
    function partOf(before) {
        const tokens = before.match(/[^\n]*$/)[0].match(TOKENS) || [''];
        const token = tokens[tokens.length - 1];
        const isOpen = isText(token) && (token.length === 1 || token[token.length - 1] !== token[0]);
        return before.endsWith(token) && (isOpen || isWord(token)) ? token : '';
    }

    /* For CodeMirror's showHint. */
    function find(mirror) {
        const cursor = mirror.getCursor();
        const before = mirror.getRange({ line: 0, ch: 0 }, cursor);
        const part = partOf(before);
        const at = follow(before.slice(0, before.length - part.length), () => {});
        const isWhole = /["']/.test(mirror.getRange(cursor, { line: cursor.line, ch: cursor.ch + 1 })) && isText(part);
        const from = { line: cursor.line, ch: cursor.ch - part.length };
        const list = candidates(at).filter(({ text }) => text.toLowerCase().startsWith(part.toLowerCase()) && text !== part);
        return { list: list.slice(0, MOST), from, to: { line: cursor.line, ch: cursor.ch + (isWhole ? 1 : 0) } };
    }

    P.hints = { find, follow, classesAt, lineOf };
}(window.Playground));
