/* A link to what is shown. Time, window of the plots, view, hidden parts and the cutting plane stand at the end of the page's
 * address; opening such an address restores them. Anything else there is ignored. */
(function (W) {
    'use strict';

    const VIEWS = ['whole', 'top', 'side', 'gripper'];
    const link = {};

    const digits = (values, count) => values.map((value) => Number(value.toFixed(count))).join(',');

    /* Returns `count` numbers with commas between them, or null. */
    function numbers(text, count) {
        const found = text ? text.split(',').map((each) => (each.trim() === '' ? NaN : Number(each))) : [];
        return found.length === count && found.every(isFinite) ? found : null;
    }

    /* The camera where a hand has moved it, in metres: its place, then the point that it looks at. */
    function eye() {
        const rig = W.stage.view && W.stage.view.rig;
        return rig && rig.moved ? rig.camera.position.toArray().concat(rig.controls.target.toArray()) : null;
    }

    /* The text at the end of the address. */
    link.text = function () {
        const parts = [['t', digits([W.clock.now], 6)]];
        const [from, to] = W.clock.window;
        if (from !== W.cycle.opened[0] || to !== W.cycle.opened[1]) {
            parts.push(['window', digits([from, to], 6)]);
        }
        if (W.stage.view) {
            parts.push(['view', W.stage.shown]);
        }
        if (W.stage.view && W.stage.shown === 'gripper') {
            parts.push(['gripper', W.stage.rider + 1]);
        }
        if (W.parts.text()) {
            parts.push(['hide', W.parts.text()]);
        }
        if (W.section.text()) {
            parts.push(['cut', W.section.text()]);
        }
        const seen = eye();
        return parts.concat(seen ? [['eye', digits(seen, 4)]] : []).map((each) => each.join('=')).join('&');
    };

    function restoreView(found) {
        const name = found.get('view');
        const rider = numbers(found.get('gripper'), 1);
        if (!W.stage.view || !VIEWS.includes(name)) {
            return;
        }
        if (name === 'gripper' && rider && W.shown.names.grippers[rider[0] - 1] !== undefined) {
            W.stage.rider = rider[0] - 1;
        }
        W.stage.shown = '';
        W.stage.show(name);
        const seen = numbers(found.get('eye'), 6);
        if (seen && W.stage.view.rig) {
            W.stage.view.rig.place(seen.slice(0, 3), seen.slice(3));
        }
    }

    link.restore = function (text) {
        const found = new URLSearchParams(text);
        const [window_, t] = [numbers(found.get('window'), 2), numbers(found.get('t'), 1)];
        if (window_ && window_[0] < window_[1]) {
            W.clock.setWindow(...window_);
        }
        if (t) {
            W.clock.seek(t[0]);
        }
        restoreView(found);
        if (W.stage.view) {
            W.parts.set((found.get('hide') || '').split(','));
        }
        if (W.stage.view && W.stage.view.cut) {
            W.section.restore(found.get('cut'));
        }
    };

    const restore = () => link.restore(location.hash.slice(1));

    /* Writes it into the address, and into the clipboard where the browser allows it. */
    link.take = function () {
        location.hash = link.text();
        const copied = navigator.clipboard ? navigator.clipboard.writeText(location.href) : Promise.reject();
        copied.then(() => W.say('link copied'), () => W.say('the link stands in the address'));
    };

    /* Saves the picture of the cell as it is seen in a file. */
    link.picture = function () {
        const name = `${W.shown.title.replace(/^.*\//, '').replace(/[^\w.-]+/g, '_')}_${W.clock.now.toFixed(3)}s.png`;
        W.element('a', { href: W.stage.view.still(), download: name }).click();
        W.say(`picture saved as ${name}`);
    };

    link.start = function () {
        restore();
        W.listen(window, 'hashchange', restore);
    };

    W.link = link;
}(window.Waferhand));
