/* Light and dark: the system's choice holds until the switch is used. Colours come from the style sheet. */
(function (W) {
    'use strict';

    const root = document.documentElement;
    const system = window.matchMedia('(prefers-color-scheme: dark)');
    const listeners = [];
    let colours = {};
    let chosen = W.kept.theme || null;

    /* A colour of the style sheet by its name, without the dashes. */
    function colour(name) {
        if (!colours[name]) {
            colours[name] = getComputedStyle(root).getPropertyValue('--' + name).trim();
        }
        return colours[name];
    }

    /* The colour of a series, a gripper, ...: there are six, then they repeat. */
    const series = (i) => colour('s' + (i % 6));

    function show(name) {
        root.dataset.theme = name;
        colours = {};
        listeners.forEach((listener) => listener(name));
    }

    const wanted = () => chosen || (system.matches ? 'dark' : 'light');

    function choose(name) {
        chosen = name;
        W.kept.theme = name;
        show(name);
    }

    const toggle = () => choose(root.dataset.theme === 'dark' ? 'light' : 'dark');

    W.listen(system, 'change', () => show(wanted()));
    show(wanted());

    W.theme = { colour, series, choose, toggle, show, restore: () => show(wanted()), on: (listener) => listeners.push(listener),
        name: () => root.dataset.theme };
}(window.Waferhand));
