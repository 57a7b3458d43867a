/* A cell that moves while it is looked at: what comes from the source goes into the document, and the parts hear of it by the
 * clock. The line above the picture says how it stands. */
(function (W) {
    'use strict';

    const live = { state: {}, hits: false, heard: [] };
    const FAST_MS = 250; /* between two changes of curves and tables */
    let later = null;

    /* Tells all parts that lists and curves have grown, but not too often. */
    function spread(doc) {
        if (later === null) {
            later = setTimeout(() => {
                later = null;
                W.clock.setStops(doc);
                W.clock.grow(doc.duration, true);
            }, FAST_MS);
        }
    }

    const isHit = (event) => ['hit', 'too_close', 'undecided', 'near_miss', 'contested'].includes(event.kind);

    /* With the switch on, the shown time stays at a hit; the cell goes on. */
    function stopAt(doc, events) {
        const hit = live.hits && W.clock.following && events.find(isHit);
        if (hit) {
            W.clock.seek(hit.utime / 1e6);
            W.clock.pause();
            W.say(`stopped at: ${W.events.tell(hit)}`);
        }
    }

    function grown(doc, what) {
        W.growth.add(doc, what);
        W.clock.grow(doc.duration, false);
        if (what.lists.events) {
            stopAt(doc, what.lists.events.list);
        }
        spread(doc);
    }

    function anew() {
        location.reload();
    }

    /* The link to this moment would be gone to after a reload: then the present is shown. */
    function hear(doc, kind, what) {
        if (kind === 'frame') {
            W.growth.now(doc, what);
            W.clock.grow(doc.duration, false);
        } else if (kind === 'growth') {
            grown(doc, what);
        } else if (kind === 'anew') {
            anew();
        } else if (kind === 'answer') {
            W.operator.hear(what);
        } else {
            live.state = what;
            live.heard.forEach((listener) => listener(what));
        }
    }

    /* In words: how fast the cell's time passes. */
    function pace(state) {
        const asked = typeof state.rate === 'number' ? `${W.figure(state.rate)}\u00d7 the wall clock` : 'as fast as it can';
        if (state.over || state.paused) {
            return state.over ? '' : 'paused';
        }
        if (state.held) {
            return state.held_robots ? `held: ${state.held_robots}` : 'held: what runs stands still by a HOLD';
        }
        if (typeof state.pace !== 'number') {
            return `pace: ${asked}`;
        }
        return state.pace === 0 ? 'nothing moves now' : `pace: ${W.figure(state.pace)}\u00d7 (asked: ${asked})`;
    }

    function verdict(state) {
        if (state.lost) {
            return ['no connection: trying again', 'warn'];
        }
        if (state.over) {
            return state.good ? ['\u2713 over: passed', 'good'] : ['\u2717 over: failed', 'bad'];
        }
        return ['\u25cf live', 'good'];
    }

    function show(state) {
        const [text, kind] = verdict(state);
        live.verdict.textContent = text;
        live.verdict.className = `verdict ${kind}`;
        live.pace.textContent = [pace(state), state.failure, state.dropped && 'the oldest entries of the lists are not kept']
            .filter(Boolean).join('; ');
        live.pace.className = state.failure ? 'failure' : 'note';
    }

    function follow(clock) {
        live.back.hidden = clock.following;
        live.back.setAttribute('aria-pressed', clock.following);
    }

    live.on = (listener) => live.heard.push(listener);

    function line() {
        const box = W.element('input', { type: 'checkbox', id: 'hits', change: () => { live.hits = box.checked; } });
        live.verdict = W.element('span', { id: 'live', role: 'status' });
        live.pace = W.element('span', { class: 'note' });
        live.back = W.element('button', { type: 'button', id: 'back', title: 'Back to the present (End)',
            'aria-keyshortcuts': 'End', hidden: true, click: () => W.clock.seek(W.clock.end) }, 'Back to the present');
        return W.element('div', { class: 'row', id: 'liveline' }, live.verdict, live.pace, W.element('span', { class: 'space' }),
            live.back, W.element('label', {}, box, ' stop at hits and misses'));
    }

    live.start = function (doc) {
        document.getElementById('head').append(line());
        live.on(show);
        live.on((state) => {
            if (!live.isControlled) {
                live.isControlled = true;
                W.control.start(doc, state);
            }
        });
        W.clock.on('time', follow);
        W.clock.on('play', follow);
        W.source.follow((kind, what) => hear(doc, kind, what));
    };

    W.live = live;
}(window.Waferhand));
