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

    const isOfRun = (kind) => kind === 'report' || kind === 'json';

    function post(asked, worker) {
        waiting.push(Object.assign(asked, { worker }));
        worker.postMessage({ kind: asked.kind, name: asked.name, id: runner.id });
    }

    /* Asks another worker what one that has ended has not answered. Questions about its run have no answer any more. */
    function askAgain(ended) {
        waiting.splice(0).forEach((asked) => {
            if (asked.worker !== ended) {
                waiting.push(asked);
            } else if (isOfRun(asked.kind)) {
                asked.done(null);
            } else {
                post(asked, runner.worker);
            }
        });
    }

    /* The worker that is busy goes; the other one takes over. */
    function replace() {
        const ended = runner.worker;
        ended.terminate();
        runner.worker = runner.spare || make();
        runner.spare = null;
        askAgain(ended);
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

    /* Promises a text: "page" with its template's name, "definitions"; "report" and "json" of the last run, or null if that is
     * gone. */
    runner.ask = (kind, name) => new Promise((done) => {
        post({ kind, name, done }, isOfRun(kind) ? runner.worker : runner.spare || runner.worker);
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
