/* Plays the run again with other parameters, by the engine that a report of --live carries, in a worker. The page takes each
 * document in place of the one before (given.js). The parameters are those that were handed over, and those that the files read.
 *
 * When the page opens, the engine plays the run as it was: so a reader knows that it gives the report's own hash. */
(function () {
    'use strict';

    const REST_MS = 150; /* of a hand, before a run begins */
    const own = { cell: null, fields: [], worker: null, module: null, url: '', id: 0, later: null, isBusy: false,
        isCheck: false };
    /* Deep, so that a cell may read files of folders above its own. */
    const FOLDER = '/of/the/run/that/this/page/was/made/of';
    const host = (id) => document.getElementById(id);
    const W = () => window.Waferhand;

    /* ------------------------------------------------------------------------------------------ what is carried */

    function bytesOf(base64) {
        const text = atob(base64.trim());
        const bytes = new Uint8Array(text.length);
        for (let i = 0; i < text.length; ++i) {
            bytes[i] = text.charCodeAt(i);
        }
        return bytes;
    }

    function carried(id, format) {
        const stream = new Blob([bytesOf(host(id).textContent)]).stream();
        return new Response(stream.pipeThrough(new window.DecompressionStream(format)));
    }

    async function unpack() {
        const [cell, wasm, script] = await Promise.all([carried('cell', 'deflate').json(),
            carried('engine', 'gzip').arrayBuffer(), carried('worker', 'gzip').text()]);
        Object.entries(cell.files).forEach(([path, content]) => {
            cell.files[path] = typeof content === 'string' ? content : bytesOf(content.base64);
        });
        own.cell = cell;
        own.module = await WebAssembly.compile(wasm);
        own.url = URL.createObjectURL(new Blob([script], { type: 'text/javascript' }));
    }

    /* ---------------------------------------------------------------------------------------------- parameters */

    const READ = /\bparams\.([A-Za-z_]\w*)(?:\s+or\s+("[^"\n]*"|'[^'\n]*'|-?\d[\w.]*(?:e[+-]?\d+)?|true|false))?/g;

    /* The parameters that the files read, by name, with what stands in for one that is not handed over; '' if that is unknown. */
    function readOnes() {
        const found = new Map();
        Object.values(own.cell.files).filter((text) => typeof text === 'string').forEach((text) => {
            for (const [, name, value] of text.replace(/--[^\n]*/g, '').matchAll(READ)) {
                if (!found.get(name)) {
                    found.set(name, (value || '').replace(/^["']|["']$/g, ''));
                }
            }
        });
        return found;
    }

    function parametersOf(cell) {
        const found = Array.from(readOnes(), ([name, value]) => ({ name, given: null, stands: value }));
        cell.parameters.forEach((text) => {
            const [, name, given] = /^([^=]*)=([^]*)$/.exec(text) || [null, text, ''];
            const known = found.find((each) => each.name === name);
            if (known) {
                known.given = given;
            } else {
                found.push({ name, given, stands: '' });
            }
        });
        return found;
    }

    const isNumber = (text) => text.trim() !== '' && Number.isFinite(Number(text));

    /* A range around a value, and its step: whole numbers stay whole. */
    function rangeOf(text) {
        const value = Number(text), isWhole = Number.isInteger(value) && !/[.eE]/.test(text);
        const size = value === 0 ? (isWhole ? 10 : 1) : 2 * Math.abs(value);
        const step = isWhole ? 1 : 10 ** Math.floor(Math.log10(size / 50));
        return { min: value < 0 ? -size : value === 0 && !isWhole ? -1 : 0, max: value < 0 ? 0 : size, step };
    }

    function makeField(of) {
        const { element } = W();
        const first = of.given !== null ? of.given : of.stands;
        const input = element('input', { id: `set-${of.name}`, value: first, spellcheck: 'false', autocomplete: 'off',
            placeholder: 'not set', input: () => { follow(); changed(); } });
        const slider = isNumber(first) ? element('input', Object.assign({ type: 'range', value: first, 'aria-label': of.name,
            input: () => { input.value = slider.value; changed(); } }, rangeOf(first))) : null;
        const follow = () => { if (slider && isNumber(input.value)) { slider.value = input.value; } };
        own.fields.push({ of, input, reset: () => { input.value = first; follow(); } });
        return element('label', {}, of.name, element('span', { class: 'value' }, ...(slider ? [slider] : []), input));
    }

    /* NAME=VALUE of all that was handed over, or is other than what stands in for it. */
    function parameters() {
        return own.fields.filter(({ of, input }) => (of.given !== null || input.value !== of.stands) && input.value !== '')
            .map(({ of, input }) => `${of.name}=${input.value}`);
    }

    /* ---------------------------------------------------------------------------------------------- the worker */

    function tell(...parts) {
        host('rerun-told').replaceChildren(...parts);
    }

    function makeWorker() {
        const made = new Worker(own.url);
        made.postMessage({ kind: 'open', module: own.module, files: own.cell.files, folder: FOLDER });
        made.addEventListener('message', ({ data }) => {
            if (made === own.worker && data.id === own.id) {
                HEARD[data.kind](data);
            }
        });
        made.addEventListener('error', ({ message }) => {
            if (made === own.worker) {
                HEARD.fault({ text: message });
            }
        });
        return made;
    }

    function busy(is) {
        own.isBusy = is;
        host('rerun').classList.toggle('busy', is);
        host('rerun-stop').disabled = !is;
    }

    function stop() {
        own.worker.terminate();
        own.worker = makeWorker();
        busy(false);
    }

    function play(isCheck) {
        if (own.isBusy) {
            stop();
        }
        ++own.id;
        own.isCheck = isCheck;
        busy(true);
        own.worker.postMessage({ kind: 'run', id: own.id, changed: {},
            request: { script: own.cell.script, parameters: parameters(), budget: own.cell.budget } });
    }

    function changed() {
        clearTimeout(own.later);
        own.later = setTimeout(() => play(false), REST_MS);
    }

    /* --------------------------------------------------------------------------------------------- its answers */

    const WORDS = { met: ['\u2713 passed', 'good'], failed: ['\u2717 failed', 'bad'], bad_input: ['not usable', 'bad'] };

    const pill = (text, kind) => W().element('span', { class: `verdict ${kind}` }, text);

    function failure(text) {
        return W().element('span', { class: 'failure' }, text);
    }

    /* The engine has played the run as it was. */
    function checked(answer) {
        const want = W().shown ? W().shown.run.hash : null;
        if (!want) {
            setTimeout(() => checked(answer), 100);
        } else if (own.isCheck) {
            tell(answer.hash === want ? W().why('The engine of this page gives the hash of this report.')
                : failure('The engine of this page gives another hash than this report has: it is of another build, or a file '
                    + 'has changed since. Its run cannot be compared with this one.'));
        }
    }

    function answered({ answer, ms }) {
        if (own.isCheck) {
            checked(answer);
            return;
        }
        const [text, kind] = WORDS[answer.outcome];
        tell(pill(text, kind), ' ', W().element('code', { id: 'rerun-hash' }, answer.hash || ''), ` ${Math.round(ms)} ms `,
            ...(answer.message ? [failure(answer.message)] : []));
    }

    /* A cell with axes and one of times alone have pages of their own. */
    function documented({ bytes, isFlow, reason }) {
        busy(false);
        if (own.isCheck) {
            return;
        }
        if (!bytes) {
            host('rerun-told').append(failure(` ${reason || 'not played'}; what is shown is an earlier run.`));
        } else if (Boolean(isFlow) !== !host('canvas')) {
            host('rerun-told').append(failure(' These values make a cell of another kind, which this page does not show.'));
        } else {
            W().given.hand({ document: bytes });
        }
    }

    const HEARD = {
        answer: answered,
        document: documented,
        fault({ text }) {
            busy(false);
            tell(pill('ended', 'bad'), ' ', failure(text || 'the engine has ended'));
        },
    };

    /* ------------------------------------------------------------------------------------------------ the strip */

    function button(text, id, click) {
        return W().element('button', { type: 'button', id, click }, text);
    }

    function build() {
        const { element, why } = W();
        const found = parametersOf(own.cell);
        const form = element('form', { submit: (event) => { event.preventDefault(); changed(); } }, ...found.map(makeField));
        if (found.length === 0) {
            form.append(why('Neither the script nor what it reads has params.NAME: there is nothing to change here.'));
        } else {
            form.append(button('As reported', 'rerun-reset', () => {
                own.fields.forEach(({ reset }) => reset());
                changed();
            }));
        }
        const stopping = button('Stop', 'rerun-stop', () => {
            stop();
            tell(pill('stopped', 'bad'), ' What is shown is an earlier run.');
        });
        stopping.disabled = true;
        form.append(stopping);
        const section = element('section', { id: 'rerun', 'aria-label': 'Play again with other values' },
            form, element('output', { id: 'rerun-told' }));
        document.querySelector('main').before(section);
    }

    async function start() {
        await unpack();
        build();
        own.worker = makeWorker();
        play(true);
        performance.mark('rerun');
    }

    start().catch((error) => document.querySelector('main')
        .before(W().why(`The run cannot be played again here: ${error.message}.`)));
}());
