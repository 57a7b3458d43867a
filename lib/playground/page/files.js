/* The files of the page: those that it carries, and what a reader has changed of them. A cell is a script, the layout that it
 * names, and whatever else its run reads. */
(function (P) {
    'use strict';

    const files = { carried: {}, changed: {}, script: '', shown: '', seen: [], left: new Map() };
    const SCRIPT = 'script.lua', LAYOUT = 'layout.lua';

    const NEW = {
        [SCRIPT]: 'cell "layout.lua"\n\nget("A", 1)\nput("B", 1)\n\nexpect_offset("Wafer 1", "B", 1, 0, 0)\n',
        [LAYOUT]: 'return {\n  wafer = { diameter = 300 },\n  grippers = { { name = "EE" } },\n  stations = {\n'
            + '    A = { at = { 700, 0, 900 }, slots = 25 },\n'
            + '    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 25 },\n  },\n'
            + '  wafers = { { name = "Wafer 1", station = "A", slot = 1 } },\n}\n',
    };

    const originals = (script) => (script === SCRIPT ? NEW : {});
    const hasOriginal = (script) => script === SCRIPT || script in files.carried;

    /* A path without its dots: "lua/examples/../layouts/paper.lua" is "lua/layouts/paper.lua". */
    function plain(path) {
        const parts = [];
        path.split('/').forEach((part) => {
            if (part === '..' && parts.length > 0) {
                parts.pop();
            } else if (part !== '.' && part !== '') {
                parts.push(part);
            }
        });
        return parts.join('/');
    }

    const isText = (path) => typeof (path in files.changed ? files.changed[path] : files.carried[path]) === 'string';
    const text = (path) => (path in files.changed ? files.changed[path] : files.carried[path]);

    /* Paths of scripts that can be chosen. */
    files.examples = () => Object.keys(files.carried).filter((path) => /^lua\/examples\/\d.*\.lua$/.test(path)).sort();

    /* The layout that a script names: as it was read in its last run, else by its text. */
    function named(path) {
        const found = /^[^\S\n]*cell\s*\(?\s*["']([^"'\n]+)["']/m.exec(text(path) || '');
        return found ? plain(path.replace(/[^/]*$/, '') + found[1]) : null;
    }

    /* The files of the cell, in the order of their tabs: the script, the layout, then what else was read. */
    files.list = () => Array.from(new Set([files.script, named(files.script), ...files.seen]))
        .filter((path) => path && isText(path));

    files.text = text;
    files.plain = plain;

    files.change = function (path, changed) {
        if (text(path) !== changed) {
            files.changed[path] = changed;
            P.tell('edited', path);
        }
    };

    files.isChanged = (path) => path in files.changed && files.changed[path] !== files.carried[path];

    /* Takes notice of what a run has read. */
    files.notice = function (inputs) {
        const read = inputs.map(plain).filter((path) => isText(path) && path !== files.script);
        if (read.join('\n') !== files.seen.join('\n')) {
            files.seen = read;
            P.tell('opened', files.shown);
        }
    };

    /* True if the cell that is shown is not as the page brought it. */
    files.areChanged = () => hasOriginal(files.script) && Object.entries(files.changed)
        .some(([path, content]) => content !== originals(files.script)[path] && content !== files.carried[path]);

    /* Begins with a script: a carried one, or an own one whose files are given. Changes of the one before are kept. */
    files.open = function (script, given) {
        files.left.set(files.script, files.changed);
        files.changed = Object.assign({}, given);
        files.script = script;
        files.seen = [];
        files.shown = script;
        P.tell('opened', script);
        P.tell('edited', script);
    };

    files.show = function (path) {
        files.shown = path;
        P.tell('opened', path);
    };

    /* Chooses an example, or '' for a new cell: as it was left, if it was changed. */
    files.choose = function (path) {
        const script = path || SCRIPT;
        files.open(script, files.left.get(script) || originals(script));
    };

    /* Takes back all changes of the cell that is shown. */
    files.reset = () => files.open(files.script, originals(files.script));

    const bytesOf = (content) => (typeof content === 'string' ? content : P.bytesOf(content.base64));

    files.start = async function () {
        files.version = P.host('files').dataset.version;
        const all = await P.carried('files').json();
        Object.entries(all).forEach(([path, content]) => { files.carried[path] = bytesOf(content); });
    };

    P.files = files;
}(window.Playground));
