/* The cell in motion: the report's page in a frame, which takes one document after the other. A flow by times alone has another
 * page. A frame is made when it is first needed; then no script is loaded again. */
(function (P) {
    'use strict';

    const picture = { frames: {}, shown: null };
    const PAGES = { report: 'report.html.in', flow: 'flow.html.in' };

    function make(kind) {
        const frame = P.element('iframe', { title: kind === 'flow' ? 'The flow' : 'The cell in motion', 'data-kind': kind });
        const made = { frame, kind, next: null, isReady: false };
        picture.frames[kind] = made;
        P.host('picture').append(frame);
        P.runner.ask('page', PAGES[kind]).then((text) => { frame.srcdoc = text; });
        return made;
    }

    function send(made) {
        if (made.isReady && made.next) {
            made.frame.contentWindow.postMessage({ document: made.next, theme: P.bar.theme() }, '*', [made.next.buffer]);
            made.next = null;
        }
    }

    function show(kind) {
        const made = picture.frames[kind] || make(kind);
        picture.shown = kind;
        P.host('picture').classList.remove('old');
        Object.values(picture.frames).forEach((each) => { each.frame.hidden = each !== made; });
        picture.note.hidden = true;
        return made;
    }

    function hear(event) {
        const made = Object.values(picture.frames).find((each) => each.frame.contentWindow === event.source);
        const data = event.data || {};
        if (made && data.waiting) {
            made.isReady = true;
            send(made);
        } else if (made && data.seen) {
            P.tell('seen');
        } else if (made && data.theme) {
            P.bar.choose(data.theme);
        }
    }

    /* Says that an earlier run is shown, and why. */
    function age(why) {
        P.host('picture').classList.add('old');
        picture.note.textContent = why;
        picture.note.hidden = false;
    }

    picture.start = function () {
        picture.note = P.element('p', { id: 'why', hidden: true });
        P.host('picture').append(picture.note);
        window.addEventListener('message', hear);
        P.on('document', ({ bytes, isFlow, reason }) => {
            if (!bytes) {
                age(reason || 'This run was not played; what is shown is an earlier one.');
                return;
            }
            const made = show(isFlow ? 'flow' : 'report');
            made.next = bytes;
            send(made);
        });
        P.on('fault', () => age('This run ended early; what is shown is an earlier one.'));
        P.on('stopped', () => age('Stopped; what is shown is an earlier run.'));
        P.on('theme', (theme) => Object.values(picture.frames).filter((each) => each.isReady)
            .forEach((each) => each.frame.contentWindow.postMessage({ theme }, '*')));
        make('report');
    };

    P.picture = picture;
}(window.Playground));
