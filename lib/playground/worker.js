/* The worker of the playground: plays scripts by the engine. It hears { kind: "open", module, files, folder }, then
 *   { kind: "run", id, request, changed }   changed: { path: text } over the files of the page
 *   { kind: "page", name }, { kind: "definitions" }, and { kind: "report", id }, { kind: "json", id } of the run with this id
 * and answers with { kind, id, ... }: "answer" with what wh_playground_run says, "document" with UTF-8 bytes or why there is
 * none, and the others with their text. Whatever ends an instance is told as { kind: "fault", id, text }.
 *
 * Each run has a fresh instance: 20 ms, and nothing of another run. */
(function () {
    'use strict';

    const own = { module: null, files: {}, folder: '/', engine: null, id: null };
    const encoder = new TextEncoder();

    /* From the root, without dots: folders are made by such paths alone. */
    function absolute(path) {
        const parts = [];
        (path.startsWith('/') ? path : `${own.folder}/${path}`).split('/').forEach((part) => {
            if (part === '..') {
                parts.pop();
            } else if (part !== '.' && part !== '') {
                parts.push(part);
            }
        });
        return `/${parts.join('/')}`;
    }

    function write(engine, path, content) {
        const place = absolute(path);
        engine.FS.mkdirTree(place.slice(0, place.lastIndexOf('/')));
        engine.FS.writeFile(place, typeof content === 'string' ? encoder.encode(content) : content);
    }

    /* An instance with these files; those below /javascript are large, and only pages need them. */
    async function open(changed, withPages) {
        const engine = await self.WaferhandEngine({
            noInitialRun: true,
            print: () => {},
            printErr: (text) => { own.said = text; },
            instantiateWasm(imports, done) {
                WebAssembly.instantiate(own.module, imports).then((instance) => done(instance));
                return {};
            },
        });
        engine.FS.mkdirTree(own.folder);
        engine.FS.chdir(own.folder);
        Object.entries(own.files).filter(([path]) => withPages || !path.startsWith('/javascript/'))
            .forEach(([path, content]) => write(engine, path, content));
        Object.entries(changed).forEach(([path, content]) => write(engine, path, content));
        return engine;
    }

    const ask = (engine, name, ...given) => engine.ccall(`wh_playground_${name}`, 'string', given.map(() => 'string'), given);

    async function run({ id, request, changed }) {
        const began = performance.now();
        own.engine = await open(changed, false);
        own.id = id;
        const answer = JSON.parse(ask(own.engine, 'run', JSON.stringify(request)));
        self.postMessage({ kind: 'answer', id, answer, ms: performance.now() - began });
        if (answer.shown !== null) {
            self.postMessage({ kind: 'document', id, reason: answer.shown });
            return;
        }
        const at = own.engine.ccall('wh_playground_document', 'number', [], []);
        const memory = own.engine.HEAPU8;
        const bytes = memory.slice(at, memory.indexOf(0, at));
        self.postMessage({ kind: 'document', id, bytes, isFlow: answer.flow, ms: performance.now() - began }, [bytes.buffer]);
    }

    /* The report needs the files of its page beside the run. */
    function report(id) {
        Object.entries(own.files).filter(([path]) => path.startsWith('/javascript/'))
            .forEach(([path, content]) => write(own.engine, path, content));
        return { kind: 'report', id, text: ask(own.engine, 'report') };
    }

    const PARTS = {
        async open({ module, files, folder }) {
            own.module = module;
            own.files = files;
            own.folder = folder || '/';
        },
        run,
        async page({ name }) {
            self.postMessage({ kind: 'page', name, text: ask(await open({}, true), 'page', name) });
        },
        async definitions() {
            self.postMessage({ kind: 'definitions', text: ask(await open({}, false), 'definitions') });
        },
        async report({ id }) {
            self.postMessage(own.id === id ? report(id) : { kind: 'report', id, text: null });
        },
        async json({ id }) {
            self.postMessage({ kind: 'json', id, text: own.id === id ? ask(own.engine, 'json') : null });
        },
    };

    /* Tells what an engine's end means. An endless recursion of a reader ends the JavaScript stack, and with it the instance. */
    function why(error) {
        if (error instanceof RangeError || error instanceof WebAssembly.RuntimeError) {
            return `the engine has ended: ${error.message} (expected a cell and a script within a page's stack and memory)`;
        }
        return error && error.name === 'ExitStatus' ? own.said || 'out of memory'
            : `the engine has ended: ${error && error.message}`;
    }

    self.addEventListener('message', ({ data }) => {
        PARTS[data.kind](data).catch((error) => {
            own.engine = null;
            own.id = null;
            self.postMessage({ kind: 'fault', id: data.id, text: why(error) });
        });
    });
}());
