/* A link to what is shown: time, window of the plots, view, what is hidden and the plane that cuts stand behind the page's
 * address, and are there again when such an address is opened. What does not belong there is passed over. */
(function (W) {
    'use strict';

    const VIEWS = ['whole', 'top', 'side', 'gripper'];
    const link = {};

    const digits = (values, count) => values.map((value) => Number(value.toFixed(count))).join(',');

    /* So many numbers with commas between them, or null. */
    function numbers(text, count) {
        const found = text ? text.split(',').map((each) => (each.trim() === '' ? NaN : Number(each))) : [];
        return found.length === count && found.every(isFinite) ? found : null;
    }

    /* The camera where a hand has moved it, in metres: where it is, then where it looks. */
    function eye() {
        const rig = W.stage.view && W.stage.view.rig;
        return rig && rig.moved ? rig.camera.position.toArray().concat(rig.controls.target.toArray()) : null;
    }

    /* What stands behind the address. */
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

    function restore() {
        const found = new URLSearchParams(location.hash.slice(1));
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
    }

    /* Into the address, and to the clipboard where the browser lets it. */
    link.take = function () {
        location.hash = link.text();
        const copied = navigator.clipboard ? navigator.clipboard.writeText(location.href) : Promise.reject();
        copied.then(() => W.say('link copied'), () => W.say('the link stands in the address'));
    };

    /* The picture of the cell as it is seen, as a file. */
    link.picture = function () {
        const name = `${W.shown.title.replace(/^.*\//, '').replace(/[^\w.-]+/g, '_')}_${W.clock.now.toFixed(3)}s.png`;
        W.element('a', { href: W.stage.view.still(), download: name }).click();
        W.say(`picture saved as ${name}`);
    };

    link.start = function () {
        restore();
        window.addEventListener('hashchange', restore);
    };

    W.link = link;
}(window.Waferhand));
