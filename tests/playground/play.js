/* play.js ENGINE JAVASCRIPT FOLDER SCRIPT [NAME=VALUE...]: plays a script by the playground's engine (build/playground), under node. Leaves
 * `json`, `data`, `report` and `tables` in FOLDER, those that there are. Exit status: that of `waferhand run`. */
'use strict';
const fs = require('fs');
const path = require('path');

const [folder, javascript, out, script, ...parameters] = process.argv.slice(2);
const PAGE = ['three/three.min.js', 'three/examples/js/controls/OrbitControls.js', 'dygraphs/dygraph.min.js', 'dygraphs/dygraph.min.css'];
const STATUS = { met: 0, failed: 1, bad_input: 2 };

function filesBelow(name) {
    return fs.readdirSync(name, { withFileTypes: true }).flatMap((entry) => (entry.isDirectory()
        ? filesBelow(path.join(name, entry.name)) : [path.join(name, entry.name)]));
}

async function play() {
    const engine = await require(path.resolve(folder, 'engine.js'))({ noInitialRun: true,
        wasmBinary: fs.readFileSync(path.join(folder, 'engine.wasm')), print: console.log, printErr: console.error });
    const put = (name, bytes) => {
        engine.FS.mkdirTree(path.dirname(name));
        engine.FS.writeFile(name, bytes);
    };
    ['lua/examples', 'lua/layouts', 'lua/patterns', path.dirname(script)].flatMap(filesBelow).forEach((name) => put(name, fs.readFileSync(name)));
    PAGE.forEach((name) => put(`/javascript/${name}`, fs.readFileSync(path.join(javascript, name))));
    const ask = (name, ...given) => engine.ccall(`wh_playground_${name}`, 'string', given.map(() => 'string'), given);

    const began = process.hrtime.bigint();
    const answer = JSON.parse(ask('run', JSON.stringify({ script, parameters, budget: 1e9 })));
    const ms = Number(process.hrtime.bigint() - began) / 1e6;
    fs.mkdirSync(out, { recursive: true });
    const keep = (name, text) => (text ? fs.writeFileSync(path.join(out, name), text) : fs.rmSync(path.join(out, name), { force: true }));
    keep('tables', answer.tables);
    keep('json', ask('json'));
    keep('data', ask('document'));
    keep('report', ask('report'));
    console.log(`${answer.outcome} ${answer.hash} ${ms.toFixed(0)} ms ${answer.message || ''}`);
    process.exitCode = STATUS[answer.outcome];
}

play();
