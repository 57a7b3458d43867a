/* The shown time and the shown window of it. All parts listen here; no part talks to another. */
(function (W) {
    'use strict';

    const listeners = { time: [], window: [], play: [], growth: [] };
    const pending = new Set();
    let begun = null;

    const clock = { now: 0, begin: 0, end: 0, slice: 0.001, speed: 1, playing: false, window: [0, 1], stops: [],
        grows: false, following: false, tied: true };

    /* A document that grows is shown over this time at its end, unless a reader chooses another window, s. */
    const SHOWN = 30;

    /* Calls the listeners once a frame, however often something changes. */
    function changed(what) {
        if (pending.size === 0) {
            requestAnimationFrame(clock.flush);
        }
        pending.add(what);
    }

    clock.flush = function () {
        const due = Array.from(pending);
        pending.clear();
        due.forEach((what) => listeners[what].forEach((listener) => listener(clock)));
    };

    clock.on = (what, listener) => listeners[what].push(listener);

    /* The time of a slice. It is computed like the program's event times: equal times are equal to the last bit. */
    clock.time = (number) => number * Math.round(clock.slice * 1e6) / 1e6;
    clock.number = (t) => Math.round(t / clock.slice);

    /* The end of a document that grows is the present: there the shown time goes along. */
    clock.seek = function (t) {
        const wasFollowing = clock.following;
        clock.now = W.clamp(t, clock.begin, clock.end);
        clock.following = clock.grows && clock.now >= clock.end;
        if (clock.following !== wasFollowing) {
            clock.tied = clock.following;
            clock.playing = false;
            changed('play');
        }
        if (clock.now < clock.window[0] || clock.now > clock.window[1]) {
            follow();
        }
        changed('time');
    };

    /* Moves the shown window on when the time leaves it, as one turns a page. */
    function follow() {
        const width = clock.window[1] - clock.window[0];
        const from = clock.now - 0.05 * width;
        clock.setWindow(from, from + width);
    }

    clock.setWindow = function (from, to) {
        const most = clock.end - clock.begin;
        const width = W.clamp(to - from, Math.min(10 * clock.slice, most), most);
        const low = W.clamp(from, clock.begin, clock.end - width);
        clock.window = [low, low + width];
        clock.tied = low + width >= clock.end - clock.slice;
        changed('window');
    };

    /* The document has grown to this time. `all`: by more than a sample of the present. A window that ended at the end is
     * tied to it. */
    clock.grow = function (end, all) {
        clock.end = Math.max(end, clock.end);
        if (clock.following) {
            clock.now = clock.end;
            changed('time');
        }
        if (all && clock.following && clock.tied) {
            const width = Math.max(clock.window[1] - clock.window[0], Math.min(SHOWN, clock.end - clock.begin));
            clock.window = [Math.max(clock.end - width, clock.begin), clock.end];
            changed('window');
        }
        if (all) {
            changed('growth');
        }
    };

    clock.zoom = function (factor) {
        const [from, to] = clock.window;
        const middle = clock.now >= from && clock.now <= to ? clock.now : (from + to) / 2;
        clock.setWindow(middle - (middle - from) * factor, middle + (to - middle) * factor);
    };

    clock.reset = () => clock.setWindow(clock.begin, clock.end);

    clock.stepSlice = (count) => clock.seek(clock.time(clock.number(clock.now) + count));

    /* Steps to the next (1) or the previous (-1) event. */
    clock.stepStop = function (way) {
        const at = W.tracks.index(clock.stops, clock.now);
        const before = at >= 0 && clock.stops[at] === clock.now ? at - 1 : at;
        const to = clock.stops[way > 0 ? at + 1 : before];
        clock.seek(to === undefined ? (way > 0 ? clock.end : clock.begin) : to);
    };

    function frame(stamp) {
        if (!clock.playing) {
            return;
        }
        const passed = begun === null ? 0 : (stamp - begun) / 1000;
        begun = stamp;
        clock.seek(clock.now + clock.speed * passed);
        if (clock.now >= clock.end && !clock.following) {
            clock.pause();
        }
        requestAnimationFrame(frame);
    }

    clock.play = function () {
        if (clock.playing || clock.following) {
            return;
        }
        if (clock.now >= clock.end) {
            clock.seek(clock.grows ? clock.end : clock.begin);
        }
        if (clock.following) {
            return;
        }
        clock.playing = true;
        begun = null;
        changed('play');
        requestAnimationFrame(frame);
    };

    clock.pause = function () {
        clock.playing = false;
        clock.following = false;
        changed('play');
    };

    clock.toggle = () => (clock.playing || clock.following ? clock.pause() : clock.play());

    clock.setSpeed = function (speed) {
        clock.speed = speed;
        changed('play');
    };

    /* After its end nobody is told anything. */
    const end = () => Object.values(listeners).forEach((list) => list.splice(0));

    clock.start = function (doc) {
        W.atEnd(end);
        clock.end = doc.duration;
        clock.slice = doc.slice;
        clock.begin = Math.min(doc.begin, doc.duration);
        clock.now = clock.begin;
        clock.window = [clock.begin, doc.duration];
        clock.grows = doc.grows;
        clock.following = doc.grows;
        clock.setStops(doc);
        if (doc.grows) {
            clock.now = clock.end;
            clock.window = [Math.max(clock.end - SHOWN, clock.begin), clock.end];
        }
    };

    /* The times that one steps to. */
    clock.setStops = function (doc) {
        clock.stops = Array.from(new Set(doc.events.map((event) => event.t))).sort((a, b) => a - b);
    };

    W.clock = clock;
}(window.Waferhand));
