/* Documents that the page around this one hands over, one after the other: the page of the playground does, for each run. It
 * posts { document: text or UTF-8 bytes, theme } to this window, and hears { waiting }, { seen } at the first picture, { shown }
 * when all is there, and { theme } when a reader has chosen one.
 *
 * With another document the page begins anew, without being loaded: its parts are emptied and its scripts run again. Code of
 * others (three.js, dygraphs) stays, and so does what a reader has chosen: view, hidden parts, speed, and the time if the title
 * is the same. */
(function (W) {
    'use strict';

    const { kept } = W;
    const PARTS = 'header, main, dialog, #said';
    const tell = (what) => window.parent.postMessage(what, '*');

    function parse(given) {
        return JSON.parse(typeof given === 'string' ? given : new TextDecoder().decode(given));
    }

    /* The reader's choices, to be made again. */
    function choices() {
        const { clock, stage } = W;
        return { title: W.shown.title, speed: clock.speed, playing: clock.playing, scroll: window.scrollY,
            options: stage && Object.assign({}, stage.options), link: stage && W.link ? W.link.text() : '' };
    }

    /* Empties the page. Its height stays until it is filled again, so that it does not jump. */
    function empty() {
        document.body.style.minHeight = `${document.body.scrollHeight}px`;
        document.querySelectorAll(PARTS).forEach((part, i) => part.replaceWith(kept.blank[i].cloneNode(true)));
    }

    function beginAnew() {
        if (W.shown) {
            kept.chosen = choices();
            W.clock.pause();
        }
        W.end();
        empty();
        window.WaferhandPage();
    }

    function hand(given) {
        if (kept.theme !== given.theme && given.theme) {
            window.Waferhand.theme.choose(given.theme);
        }
        if (given.document === undefined) {
            return;
        }
        kept.next = given.document;
        if (kept.waiting) {
            kept.waiting();
        } else {
            kept.again();
        }
    }

    function hear(event) {
        if (event.source === window.parent && event.data && typeof event.data === 'object') {
            hand(event.data);
        }
    }

    /* Takes place once: from then on the page can be emptied. */
    function attend() {
        if (!kept.blank) {
            kept.blank = Array.from(document.querySelectorAll(PARTS), (part) => part.cloneNode(true));
            window.addEventListener('message', hear);
            tell({ waiting: true });
        }
        kept.again = beginAnew;
        W.theme.on((theme) => tell({ theme }));
    }

    function taken() {
        const given = kept.next;
        kept.next = undefined;
        kept.waiting = null;
        return parse(given);
    }

    const isNext = () => kept.next !== undefined;

    function take() {
        attend();
        return isNext() ? Promise.resolve(taken())
            : new Promise((done) => { kept.waiting = () => done(taken()); });
    }

    /* The picture as it was; a run of something else is seen from its begin. */
    function chooseAgain({ title, speed, playing, options, link }) {
        W.clock.setSpeed(speed);
        if (W.stage && W.stage.view) {
            Object.entries(options || {}).forEach(([name, on]) => W.stage.choose(name, on));
        }
        if (W.stage && title === W.shown.title) {
            W.link.restore(link);
        }
        if (playing && title === W.shown.title) {
            W.clock.play();
        }
    }

    /* The first picture is there. */
    function seen() {
        if (kept.blank && kept.chosen) {
            chooseAgain(kept.chosen);
        }
        if (kept.blank) {
            W.clock.flush();
            tell({ seen: true });
        }
    }

    /* All of it is there. */
    function shown() {
        if (kept.blank) {
            document.body.style.minHeight = '';
            window.scrollTo(0, kept.chosen && kept.chosen.title === W.shown.title ? kept.chosen.scroll : 0);
            tell({ shown: true });
        }
    }

    W.given = { attend, hand, isNext, take, seen, shown };
}(window.Waferhand));
