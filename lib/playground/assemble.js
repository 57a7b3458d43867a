/* assemble.js FOLDER JAVASCRIPT VERSION OUT FILE...: makes the playground, one HTML file, of the engine in FOLDER, the page beside this
 * script, JavaScript of others below JAVASCRIPT, and the files that the page offers. Beside the engine it leaves report_engine.html: what
 * a report of --live takes along. */
'use strict';
const fs = require('fs');
const path = require('path');
const zlib = require('zlib');

const [folder, javascript, version, out, ...files] = process.argv.slice(2);
const own = path.join(__dirname, 'page');

/* The parts of the report's page that are not our own: the engine reads it below /javascript. */
const PAGE = ['three/three.min.js', 'three/examples/js/controls/OrbitControls.js', 'dygraphs/dygraph.min.js',
    'dygraphs/dygraph.min.css'];
const EDITOR = { 'codemirror.css': 'codemirror/lib/codemirror.css', 'show-hint.css': 'codemirror/addon/hint/show-hint.css',
    'codemirror.js': 'codemirror/lib/codemirror.js', 'lua.js': 'codemirror/mode/lua/lua.js',
    'show-hint.js': 'codemirror/addon/hint/show-hint.js', 'matchbrackets.js': 'codemirror/addon/edit/matchbrackets.js',
    'closebrackets.js': 'codemirror/addon/edit/closebrackets.js', 'active-line.js': 'codemirror/addon/selection/active-line.js',
    'comment.js': 'codemirror/addon/comment/comment.js' };

const pack = (bytes) => zlib.gzipSync(bytes, { level: 9 }).toString('base64');

/* A file as JSON has it: its text, or its bytes in base 64 if it is no text. */
function content(name) {
    const bytes = fs.readFileSync(name);
    const text = bytes.toString('utf8');
    return Buffer.from(text, 'utf8').equals(bytes) ? text : { base64: bytes.toString('base64') };
}

function filesOf() {
    const all = {};
    files.forEach((name) => { all[name] = content(name); });
    PAGE.forEach((name) => { all[`/javascript/${name}`] = content(path.join(javascript, name)); });
    return JSON.stringify(all);
}

/* A backslash keeps an HTML parser from taking this for markup; JavaScript's strings and CSS ignore it. */
const inlined = (text) => text.replace(/<(?=\/script|\/style|!--)/gi, '<\\');

const read = (name) => fs.readFileSync(name, 'utf8');
const MADE = {
    version: () => version,
    'engine.wasm': () => pack(fs.readFileSync(path.join(folder, 'engine.wasm'))),
    worker: () => pack(read(path.join(folder, 'engine.js')) + read(path.join(__dirname, 'worker.js'))),
    files: () => pack(filesOf()),
};

function part(whole, name) {
    if (MADE[name]) {
        return MADE[name]();
    }
    if (EDITOR[name]) {
        return inlined(read(path.join(javascript, EDITOR[name])));
    }
    return fs.existsSync(path.join(own, name)) ? inlined(read(path.join(own, name))) : whole;
}

/* A report takes it along to play its run again. */
const ENGINE = `<script type="application/octet-stream" id="engine" data-version="@version@">@engine.wasm@</script>
<script type="application/octet-stream" id="worker">@worker@</script>
`;

const html = read(path.join(own, 'playground.html.in')).replace(/@([\w.-]+)@/g, part);
function write(name, text) {
    fs.writeFileSync(`${name}.new`, text);
    fs.renameSync(`${name}.new`, name);
}

write(out, html);
write(path.join(folder, 'report_engine.html'), ENGINE.replace(/@([\w.-]+)@/g, part));
