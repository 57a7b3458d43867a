/* A plane that cuts the cell: its direction, its place, and the side that is kept. */
(function (W) {
    'use strict';

    const AXES = ['x', 'y', 'z'];
    const section = { on: false, axis: 0, at: null, keep: -1, box: null };

    /* The plane begins in the middle of the cell. */
    const middle = () => Math.round((section.box.low[section.axis] + section.box.high[section.axis]) / 2);

    /* Returns { axis, at (mm of base), keep: -1 for below, 1 for above }, or null. */
    section.plane = () => (section.on ? { axis: section.axis, at: section.at, keep: section.keep } : null);

    /* True if a point of base, mm, is cut away. */
    section.isAway = (r) => section.on && section.keep * (r[section.axis] - section.at) < 0;

    function show() {
        const { slider, output, choice, flip } = section;
        slider.min = Math.floor(section.box.low[section.axis]);
        slider.max = Math.ceil(section.box.high[section.axis]);
        slider.value = section.at;
        slider.setAttribute('aria-valuetext', `${AXES[section.axis]} ${section.at} mm`);
        output.textContent = `${W.number(section.at, 0)}\u00a0mm`;
        choice.forEach((each, i) => { each.checked = i === section.axis; });
        flip.checked = section.keep > 0;
        section.sheet.hidden = !section.on;
        section.changed();
    }

    section.toggle = function () {
        section.on = !section.on;
        show();
    };

    function turn(axis) {
        section.axis = axis;
        section.at = middle();
        show();
    }

    /* The text in a link, such as x,350,-1. */
    section.text = () => (section.on ? [AXES[section.axis], section.at, section.keep].join(',') : '');

    section.restore = function (text) {
        const [axis, at, keep] = (text || '').split(',');
        const found = AXES.indexOf(axis);
        section.on = found >= 0 && at !== '' && isFinite(at) && (keep === '1' || keep === '-1');
        if (section.on) {
            section.axis = found;
            section.at = W.clamp(Math.round(Number(at)), Math.floor(section.box.low[found]), Math.ceil(section.box.high[found]));
            section.keep = Number(keep);
        }
        show();
    };

    function radio(i) {
        const made = W.element('input', { type: 'radio', name: 'section-axis', value: AXES[i], change: () => turn(i) });
        return [made, W.element('label', {}, made, AXES[i])];
    }

    /* The controls, for a cell between `low` and `high`, mm of base; `changed` is called when the plane moves. */
    section.make = function (box, changed) {
        const radios = AXES.map((_, i) => radio(i));
        Object.assign(section, { box, changed, choice: radios.map(([made]) => made), output: W.element('output', {}) });
        section.at = middle();
        section.slider = W.element('input', { type: 'range', step: 1, 'aria-label': 'Where the plane is, mm', input: () => {
            section.at = Number(section.slider.value);
            show();
        } });
        section.flip = W.element('input', { type: 'checkbox', change: () => {
            section.keep = -section.keep;
            show();
        } });
        section.sheet = W.element('div', { id: 'section', class: 'sheet', hidden: true, role: 'group', 'aria-label': 'Section' },
            W.element('div', { class: 'row' }, ...radios.map(([, label]) => label), section.output), section.slider,
            W.element('label', {}, section.flip, 'show the other side'));
        return section.sheet;
    };

    W.section = section;
}(window.Waferhand));
