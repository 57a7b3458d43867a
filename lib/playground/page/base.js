/* The playground's one global name, and the small helpers that every part uses. */
window.Playground = { listeners: {} };
(function (P) {
    'use strict';

    /* Makes an element: attributes by name (a function listens), then children or strings. */
    function element(name, attributes, ...children) {
        const made = document.createElement(name);
        Object.entries(attributes || {}).forEach(([key, value]) => {
            if (typeof value === 'function') {
                made.addEventListener(key, value);
            } else if (value !== null && value !== undefined && value !== false) {
                made.setAttribute(key, value === true ? '' : value);
            }
        });
        made.append(...children);
        return made;
    }

    const host = (id) => document.getElementById(id);

    /* The parts hear of each other by what has happened: "edited", "opened", "begun", "answer", "document", "fault", "stopped",
     * "ended", "seen", "theme". */
    function on(what, listener) {
        (P.listeners[what] = P.listeners[what] || []).push(listener);
    }

    function tell(what, ...told) {
        (P.listeners[what] || []).forEach((listener) => listener(...told));
    }

    function bytesOf(base64) {
        const text = atob(base64);
        const bytes = new Uint8Array(text.length);
        for (let i = 0; i < text.length; ++i) {
            bytes[i] = text.charCodeAt(i);
        }
        return bytes;
    }

    const through = (bytes, stream) => new Response(new Blob([bytes]).stream().pipeThrough(stream));
    const inflate = (bytes, format) => through(bytes, new window.DecompressionStream(format));
    const deflate = (bytes, format) => through(bytes, new window.CompressionStream(format));

    /* Unpacks what the page carries in an element: a Response. The element's text is freed. */
    function carried(id) {
        const carrier = host(id);
        const bytes = bytesOf(carrier.textContent.trim());
        carrier.textContent = '';
        return inflate(bytes, 'gzip');
    }

    /* Tells screen readers a text. */
    function say(text) {
        host('said').textContent = text;
    }

    /* Offers bytes or a text as a file. */
    function download(name, content, type) {
        const url = URL.createObjectURL(new Blob([content], { type }));
        element('a', { href: url, download: name }).click();
        setTimeout(() => URL.revokeObjectURL(url), 10000);
        say(`saved as ${name}`);
    }

    Object.assign(P, { element, host, on, tell, bytesOf, inflate, deflate, carried, say, download });
}(window.Playground));
