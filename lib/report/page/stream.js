/* The source of a live cell's page: the program, by its server. See source.js. */
(function (W) {
    'use strict';

    const AGAIN_MS = 1000;
    const wait = (ms) => new Promise((done) => setTimeout(done, ms));

    async function ask(path) {
        const answer = await fetch(path, { cache: 'no-store' });
        if (!answer.ok) {
            throw new Error((await answer.text()).trim());
        }
        return answer.json();
    }

    const own = { next: 0, id: '', state: {}, heard: null, events: null };
    const known = (more) => Object.assign({}, own.state, more);

    function waiting(reason) {
        if (own.heard) {
            own.heard('state', known({ lost: true, reason }));
        } else {
            document.getElementById('head').replaceChildren(W.why(`Waiting for the program: ${reason}.`));
        }
    }

    /* Asks until the program has a cell: it may start later than its page. */
    async function fetched() {
        for (;;) {
            try {
                const { next, id, state, document: taken } = await ask('document');
                own.next = next;
                own.id = id;
                own.state = state;
                return taken;
            } catch (error) {
                waiting(error.message);
                await wait(AGAIN_MS);
            }
        }
    }

    function told(kind, event) {
        const what = JSON.parse(event.data);
        own.next = Number(event.lastEventId) + 1;
        if (what.state) {
            own.state = what.state;
            own.heard('state', known({ lost: false }));
        }
        own.heard(kind, what);
    }

    /* The browser connects again by itself, and tells from where on. Once it has given up, we do, unless the page was hidden
     * meanwhile: it connects when it is seen. */
    function connect() {
        own.events = new EventSource(`stream?from=${own.next}&id=${own.id}`);
        ['frame', 'growth', 'anew', 'answer'].forEach((kind) => own.events.addEventListener(kind, (event) => told(kind, event)));
        own.events.addEventListener('open', () => own.heard('state', known({ lost: false })));
        own.events.addEventListener('error', (event) => {
            waiting('no answer');
            if (event.target.readyState === EventSource.CLOSED) {
                setTimeout(() => own.events === event.target && connect(), AGAIN_MS);
            }
        });
    }

    /* A page that nobody sees needs no connection, of which a browser has few. */
    function seen() {
        if (document.hidden && own.events) {
            own.events.close();
            own.events = null;
        } else if (!document.hidden && !own.events) {
            connect();
        }
    }

    W.source = {
        take: fetched,
        follow(heard) {
            own.heard = heard;
            heard('state', known({ lost: false }));
            document.addEventListener('visibilitychange', seen);
            seen();
        },
    };
}(window.Waferhand));
