/* Play, pause, speed, the scrubber with a tick for each event, and the shown time. */
(function (W) {
    'use strict';

    const SPEEDS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];
    const THUMB = 16;
    const ICONS = { play: 'M6 4l14 8-14 8z', pause: 'M6 4h4v16H6zM14 4h4v16h-4z', before: 'M5 4h3v16H5zM20 4v16L9 12z',
        next: 'M16 4h3v16h-3zM4 4v16l11-8z' };
    const transport = {};

    function tool(name, title, keys, pressed) {
        return W.element('button', { type: 'button', id: name, class: 'tool', title: `${title} (${keys})`,
            'aria-label': title, 'aria-keyshortcuts': keys, click: pressed }, W.icon(ICONS[name]));
    }

    function speeds() {
        const select = W.element('select', { id: 'speed', 'aria-label': 'Speed',
            change: () => W.clock.setSpeed(Number(select.value)) });
        SPEEDS.forEach((speed) => select.append(W.element('option', { value: speed, selected: speed === 1 },
            `${speed}\u00d7`)));
        return select;
    }

    transport.faster = function (way) {
        const at = SPEEDS.indexOf(W.clock.speed);
        W.clock.setSpeed(SPEEDS[W.clamp(at + way, 0, SPEEDS.length - 1)]);
    };

    /* The scrubber counts slices, so that its keys step by one. */
    function range(doc) {
        const made = W.element('input', { type: 'range', id: 'scrubber', min: W.clock.number(doc.begin),
            max: W.clock.number(doc.duration), step: 1, value: W.clock.number(doc.begin), 'aria-label': 'Time',
            input: () => W.clock.seek(W.clock.time(Number(made.value))) });
        return made;
    }

    /* Draws at most one stroke per pixel, the most serious event on top. */
    function ticks() {
        const canvas = transport.ticks;
        const width = canvas.clientWidth;
        const scale = window.devicePixelRatio || 1;
        canvas.width = width * scale;
        canvas.height = 10 * scale;
        const pen = canvas.getContext('2d');
        pen.scale(scale, scale);
        ['accent', 'warn', 'bad'].forEach((colour) => {
            pen.fillStyle = W.theme.colour(colour);
            const spots = transport.doc.events.filter((event) => W.events.colour(event.kind) === colour)
                .map((event) => Math.round(THUMB / 2 + (width - THUMB) * (event.t - W.clock.begin)
                    / (W.clock.end - W.clock.begin)));
            new Set(spots).forEach((x) => pen.fillRect(x - 1, 0, 2, 10));
        });
    }

    function eventsAt(t) {
        const { events } = transport.doc;
        const last = W.tracks.indexOf(events, t);
        let first = last;
        while (first > 0 && events[first - 1].t === t) {
            --first;
        }
        return last >= 0 && events[last].t === t ? events.slice(first, last + 1) : [];
    }

    function showTime(clock) {
        const events = eventsAt(clock.now);
        const here = events.map(W.events.tell).join(', ');
        transport.range.max = clock.number(clock.end);
        transport.range.value = clock.number(clock.now);
        transport.range.setAttribute('aria-valuetext', `${clock.now.toFixed(3)} seconds. ${here}`);
        transport.time.textContent = W.number(clock.now, 3);
        transport.whole.textContent = ` / ${W.number(clock.end, 3)} s`;
        transport.here.textContent = here || `slice ${clock.number(clock.now)}`;
        transport.here.className = 'here ' + (here ? W.events.colour(events[0].kind) : '');
        transport.here.title = here;
    }

    function showPlay(clock) {
        const goes = clock.playing || clock.following;
        transport.play.replaceChildren(W.icon(goes ? ICONS.pause : ICONS.play));
        transport.play.setAttribute('aria-label', goes ? 'Pause' : 'Play');
        transport.speed.value = clock.speed;
    }

    transport.start = function (doc) {
        const host = document.getElementById('transport');
        transport.doc = doc;
        transport.play = tool('play', 'Play', 'Space', W.clock.toggle);
        transport.speed = speeds();
        transport.range = range(doc);
        transport.ticks = W.element('canvas', { class: 'ticks', 'aria-hidden': 'true' });
        transport.time = W.element('output', { id: 'time', for: 'scrubber' });
        transport.here = W.element('span', { class: 'here' });
        transport.whole = W.element('span');
        host.append(
            W.element('div', { class: 'buttons' },
                tool('before', 'Event before', 'Shift+ArrowLeft', () => W.clock.stepStop(-1)), transport.play,
                tool('next', 'Next event', 'Shift+ArrowRight', () => W.clock.stepStop(1)), transport.speed),
            W.element('div', { class: 'line' }, transport.range, transport.ticks),
            W.element('div', { class: 'clock' },
                W.element('span', {}, transport.time, transport.whole), transport.here));
        W.clock.on('time', showTime);
        W.clock.on('play', showPlay);
        W.clock.on('growth', (clock) => {
            ticks();
            showTime(clock);
        });
        W.theme.on(ticks);
        W.observe(transport.ticks, ticks);
        showTime(W.clock);
        showPlay(W.clock);
    };

    W.transport = transport;
}(window.Waferhand));
