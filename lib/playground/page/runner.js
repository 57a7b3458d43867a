/* Runs scripts in a worker, one at a time. With another one, or with Stop, the worker that is busy is ended, and one that waits
 * takes its place. */
(function (P) {
    'use strict';

    const runner = { busy: false, id: 0, parameters: [], worker: null, spare: null };
    const BUDGET = 300e6; /* steps of a script: `waferhand run` has 1e9, which take a page too long */
    const waiting = [];

    /* Answers to what is asked beside runs. */
    const ASKED = ['page', 'definitions', 'report', 'json'];

    function make() {
        const made = new Worker(runner.url);
        made.postMessage({ kind: 'open', module: runner.module, files: P.files.carried });
        made.addEventListener('message', ({ data }) => hear(made, data));
        made.addEventListener('error', ({ message }) => hear(made, { kind: 'fault', id: runner.id,
            text: message || 'the worker has ended' }));
        return made;
    }

    function reply(kind, data) {
        const at = waiting.findIndex((each) => each.kind === kind && (!data.name || each.name === data.name));
        if (at >= 0) {
            waiting.splice(at, 1)[0].done(data.text);
        }
    }

    function end() {
        runner.busy = false;
        P.tell('ended');
    }

    function hear(worker, data) {
        if (ASKED.includes(data.kind)) {
            reply(data.kind, data);
        } else if (worker === runner.worker && data.id === runner.id) {
            P.tell(data.kind, data);
            if (data.kind !== 'answer') {
                end();
            }
        }
    }

    /* The worker that is busy goes; the other one takes over. */
    function replace() {
        runner.worker.terminate();
        runner.worker = runner.spare || make();
        runner.spare = null;
        setTimeout(() => { runner.spare = runner.spare || make(); }, 0);
    }

    runner.stop = function () {
        if (runner.busy) {
            replace();
            end();
            P.tell('stopped');
        }
    };

    runner.run = function () {
        if (runner.busy) {
            replace();
        }
        runner.busy = true;
        ++runner.id;
        P.tell('begun');
        runner.worker.postMessage({ kind: 'run', id: runner.id, changed: P.files.changed,
            request: { script: P.files.script, parameters: runner.parameters, budget: BUDGET } });
    };

    /* Promises a text: "page" with its template's name, "definitions"; "report" and "json" of the last run. */
    runner.ask = (kind, name) => new Promise((done) => {
        waiting.push({ kind, name, done });
        const isOfRun = kind === 'report' || kind === 'json';
        (isOfRun ? runner.worker : runner.spare || runner.worker).postMessage({ kind, name, id: runner.id });
    });

    runner.start = async function () {
        const [module, script] = await Promise.all([P.carried('engine').arrayBuffer().then((bytes) => WebAssembly.compile(bytes)),
            P.carried('worker').text()]);
        runner.module = module;
        runner.url = URL.createObjectURL(new Blob([script], { type: 'text/javascript' }));
        runner.worker = make();
        runner.spare = make();
    };

    P.runner = runner;
}(window.Playground));
