/* The page's one global name, and the small helpers that every part uses. A page that is given another document begins anew (see
 * given.js): what it keeps of itself is in `kept`. */
window.Waferhand = { kept: (window.Waferhand || { kept: {} }).kept };
(function (W) {
    'use strict';

    const DASH = '\u2013';
    const MINUS = '\u2212';

    /* Makes an element: attributes by name (a function listens, `text` is the text), then children or strings. */
    function element(name, attributes, ...children) {
        const made = document.createElement(name);
        Object.entries(attributes || {}).forEach(([key, value]) => {
            if (typeof value === 'function') {
                made.addEventListener(key, value);
            } else if (key === 'text') {
                made.textContent = value;
            } else if (value !== null && value !== undefined && value !== false) {
                made.setAttribute(key, value === true ? '' : value);
            }
        });
        children.forEach((child) => made.append(child));
        return made;
    }

    /* Writes a number for people: fixed decimals, a true minus, no negative zero, a dash for none. */
    function number(value, decimals) {
        if (typeof value !== 'number' || !isFinite(value)) {
            return DASH;
        }
        const text = value.toFixed(decimals);
        return Number(text) === 0 ? text.replace('-', '') : text.replace('-', MINUS);
    }

    /* Writes at most four significant digits: 0.4923, 49.99, 1235. */
    function figure(value) {
        if (typeof value !== 'number' || !isFinite(value)) {
            return DASH;
        }
        const size = Math.abs(value);
        if (size !== 0 && size < 1e-6) {
            return value.toExponential(1).replace(/-/g, MINUS);
        }
        const before = size < 1 ? 0 : Math.floor(Math.log10(size));
        return number(value, Math.max(0, 3 - before + (size < 1 ? 1 : 0)));
    }

    /* Writes a tick's number, with the digits that tell it from its neighbours in a range of this width, and without rounding
     * errors. Near 1 the difference to 1 tells more. */
    function tick(value, span) {
        const decimals = clamp(3 - Math.floor(Math.log10(span)), 0, 18);
        const lack = Number((1 - value).toFixed(decimals));
        const text = lack > 0 && lack < 1e-5 ? `1 - ${lack.toExponential()}` : String(Number(value.toFixed(decimals)));
        return (text === '-0' ? '0' : text).replace(/-/g, MINUS);
    }

    const SPACE = 'http://www.w3.org/2000/svg';

    /* Makes a shape within an SVG, or the SVG itself; a function listens. */
    function shape(name, attributes, text) {
        const made = document.createElementNS(SPACE, name);
        Object.entries(attributes).forEach(([key, value]) => {
            if (typeof value === 'function') {
                made.addEventListener(key, value);
            } else {
                made.setAttribute(key, value);
            }
        });
        if (text !== undefined) {
            made.textContent = text;
        }
        return made;
    }

    /* Makes a small picture of filled paths on a grid of 24 by 24. */
    function icon(path) {
        const made = shape('svg', { viewBox: '0 0 24 24', class: 'icon', 'aria-hidden': 'true' });
        made.append(shape('path', { d: path }));
        return made;
    }

    const seconds = (t) => number(t, 3) + '\u00a0s';

    /* Writes a word of the program's JSON for people. */
    const words = (text) => String(text).replace(/_/g, ' ');

    const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

    /* The text that a section shows if the document lacks its content. */
    const why = (text) => element('p', { class: 'why', text });

    /* Tells screen readers a text. */
    function say(text) {
        document.getElementById('said').textContent = text;
    }

    /* Calls that end what must not outlive the document. */
    const ends = [];
    const atEnd = (what) => ends.push(what);

    function end() {
        W.isOver = true;
        ends.splice(0).forEach((each) => each());
    }

    /* Listens at a place that outlives the document. */
    function listen(target, kind, heard) {
        target.addEventListener(kind, heard);
        atEnd(() => target.removeEventListener(kind, heard));
    }

    /* Calls back when an element's size changes. */
    function observe(seen, changed) {
        const observer = new ResizeObserver(changed);
        observer.observe(seen);
        atEnd(() => observer.disconnect());
    }

    Object.assign(W, { atEnd, end, listen, observe, element, shape, icon, number, figure, tick, seconds, words, clamp, why, say,
        DASH });
}(window.Waferhand));
