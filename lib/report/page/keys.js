/* The keyboard, and the list of its keys. */
(function (W) {
    'use strict';

    const view = (name) => () => W.stage.view && W.stage.show(name);
    const option = (name) => () => W.stage.view && W.stage.toggle(name);

    /* Keys of a page with a scene. */
    const SCENE = [
        { keys: [' '], name: 'Space', text: 'play or pause', act: () => W.clock.toggle() },
        { keys: ['ArrowLeft'], name: '\u2190', text: 'one slice back', act: () => W.clock.stepSlice(-1) },
        { keys: ['ArrowRight'], name: '\u2192', text: 'one slice on', act: () => W.clock.stepSlice(1) },
        { keys: ['Shift+ArrowLeft', ','], name: 'Shift \u2190', text: 'to the event before', act: () => W.clock.stepStop(-1) },
        { keys: ['Shift+ArrowRight', '.'], name: 'Shift \u2192', text: 'to the next event', act: () => W.clock.stepStop(1) },
        { keys: ['Home'], name: 'Home', text: 'to the begin', act: () => W.clock.seek(W.clock.begin) },
        { keys: ['End'], name: 'End', text: 'to the end', act: () => W.clock.seek(W.clock.end) },
        { keys: ['['], name: '[', text: 'slower', act: () => W.transport.faster(-1) },
        { keys: [']'], name: ']', text: 'faster', act: () => W.transport.faster(1) },
        { keys: ['1'], name: '1', text: 'view of the whole cell', act: view('whole') },
        { keys: ['2'], name: '2', text: 'view from the top', act: view('top') },
        { keys: ['3'], name: '3', text: 'view from the side', act: view('side') },
        { keys: ['4'], name: '4', text: 'ride along with a gripper; again: with the next', act: view('gripper') },
        { keys: ['m'], name: 'm', text: 'measure', act: () => W.measure.toggle() },
        { keys: ['f'], name: 'f', text: 'frames', act: option('frames') },
        { keys: ['n'], name: 'n', text: 'names of wafers, grippers, stations and obstacles', act: option('names') },
        { keys: ['r'], name: 'r', text: 'trail: where grippers were in the last 3 s, a dot each 0.1 s', act: option('trail') },
        { keys: ['s'], name: 's', text: 'shadows', act: option('shadows') },
        { keys: ['h'], name: 'h', text: 'list of parts to hide and to show', act: () => W.stage.view && W.stage.list() },
        { keys: ['x'], name: 'x', text: 'section: a plane that cuts the cell', act: () => W.stage.view && W.stage.section() },
        { keys: ['l'], name: 'l', text: 'a link to this moment and view', act: () => W.link.take() },
        { keys: ['p'], name: 'p', text: 'save the picture', act: () => W.stage.view && W.link.picture() },
    ];

    const PLOTS = [
        { keys: ['+', '='], name: '+', text: 'plots: shorter time', act: () => W.clock.zoom(0.5) },
        { keys: ['-'], name: '\u2212', text: 'plots: longer time', act: () => W.clock.zoom(2) },
        { keys: ['c'], name: 'c', text: 'plots: the first steady cycle', act: () => W.cycle.show() },
        { keys: ['0'], name: '0', text: 'plots: the whole run', act: () => W.clock.reset() },
        { keys: ['t'], name: 't', text: 'light or dark', act: () => W.theme.toggle() },
        { keys: ['?'], name: '?', text: 'this list', act: () => keys.help() },
    ];

    const MOVES = ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', 'Home', 'End'];
    const OWN = { BUTTON: [' '], SUMMARY: [' '], checkbox: [' '], radio: [' ', ...MOVES], range: MOVES };

    const known = () => (W.stage ? SCENE : []).concat(PLOTS);

    /* True for keys that the focused element needs itself; the scrubber's keys do the same as the page's. */
    function isTaken(target, key) {
        const kind = target.tagName === 'INPUT' ? target.type : target.tagName;
        return ['TEXTAREA', 'SELECT', 'text'].includes(kind) || (target.id !== 'scrubber' && (OWN[kind] || []).includes(key));
    }

    function pressed(event) {
        const key = (event.shiftKey && event.key.startsWith('Arrow') ? 'Shift+' : '') + event.key;
        const found = known().find((each) => each.keys.includes(key));
        const other = event.ctrlKey || event.altKey || event.metaKey || document.getElementById('help').open;
        if (found && !other && !isTaken(event.target, event.key)) {
            event.preventDefault();
            found.act();
        }
    }

    const keys = {
        help() {
            const dialog = document.getElementById('help');
            if (!dialog.open) {
                dialog.showModal();
            }
        },
        start() {
            const rows = known().map(({ name, text }) => W.element('tr', {}, W.element('td', {}, W.element('kbd', {}, name)),
                W.element('td', {}, text)));
            const dialog = document.getElementById('help');
            dialog.append(W.element('h2', {}, 'Keys'), W.element('table', {}, W.element('tbody', {}, ...rows)),
                W.element('p', {}, W.stage ? 'In the picture: drag to orbit, with the right button to move, scroll to '
                    + 'zoom once it has the focus. ' : '',
                'In the plots: drag to zoom, click to go there, double click for the whole run.'),
                W.element('button', { type: 'button', click: () => dialog.close() }, 'Close'));
            W.listen(document, 'keydown', pressed);
        },
    };

    W.keys = keys;
}(window.Waferhand));
