/* The source of the page's document: the page itself carries it, or, if what it carries is empty, the page around it hands it
 * over (given.js). A page that plays its run again shows what it carries, then what the next runs hand over (rerun.js). The
 * page of a live cell has stream.js in its place, and no other part asks which. A source has
 *   take()          promises the document, or fails with the reason
 *   follow(heard)   calls `heard(kind, what)` from then on: "frame", "growth", "anew" and "answer" with their object, "state"
 *                   with what is known of the program and of the connection. A file never calls it. */
(function (W) {
    'use strict';

    function bytes(text) {
        const made = new Uint8Array(text.length);
        for (let i = 0; i < text.length; ++i) {
            made[i] = text.charCodeAt(i);
        }
        return made;
    }

    /* Inflates a text that was deflated and written as base64. */
    function inflate(packed) {
        if (!window.DecompressionStream) {
            throw new Error('it takes a browser of 2023 or later to unpack it');
        }
        const inflated = new Blob([bytes(atob(packed))]).stream().pipeThrough(new window.DecompressionStream('deflate'));
        return new Response(inflated).text();
    }

    W.source = {
        async take() {
            const text = W.given && W.given.isNext() ? '' : await inflate(document.getElementById('document').textContent.trim());
            if (text === '') {
                return W.given.take();
            }
            if (document.getElementById('cell')) {
                W.given.attend();
            }
            return JSON.parse(text);
        },
        follow() {},
    };
}(window.Waferhand));
