/* The axis of time that plots and lanes share: the room left of it, its cursor, and times along it. */
(function (W) {
    'use strict';

    /* The width left of the plots, for numbers and names. */
    const gutter = () => (document.body.clientWidth < 560 ? 70 : 92);

    /* Places the cursor's line: at the time if it is within the window, and nowhere otherwise. */
    function place(cursor, left, width) {
        const [from, to] = W.clock.window;
        const inside = W.clock.now >= from && W.clock.now <= to;
        cursor.hidden = !inside;
        if (inside) {
            const x = left + width * (W.clock.now - from) / (to - from);
            cursor.style.transform = `translateX(${x.toFixed(2)}px)`;
        }
    }

    W.axis = { gutter, place };
}(window.Waferhand));
