/* A link that holds a cell: what the files of it say, deflated, behind the # of the page's address. A browser sends that part of
 * an address to nobody. */
(function (P) {
    'use strict';

    const link = {};
    const MARK = '#cell=';
    const MOST = 4e6; /* characters, packed and unpacked: no cell of ours comes near */

    const toUrl = (text) => text.replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '');
    const fromUrl = (text) => text.replace(/-/g, '+').replace(/_/g, '/');

    function base64(bytes) {
        let text = '';
        for (let i = 0; i < bytes.length; i += 4096) {
            text += String.fromCharCode(...bytes.subarray(i, i + 4096));
        }
        return btoa(text);
    }

    /* Script and layout are there in any case, so that a link keeps its meaning when examples change. */
    function held() {
        const { script, changed } = P.files;
        const texts = P.files.list().slice(0, 2).concat(Object.keys(changed));
        const all = {};
        texts.forEach((path) => { all[path] = P.files.text(path); });
        return { format: 1, script, files: all, parameters: P.runner.parameters };
    }

    link.make = async function () {
        const bytes = new TextEncoder().encode(JSON.stringify(held()));
        const packed = new Uint8Array(await P.deflate(bytes, 'deflate').arrayBuffer());
        return location.href.replace(/#.*$/, '') + MARK + toUrl(base64(packed));
    };

    const areTexts = (list) => list.every((text) => typeof text === 'string');
    const isTexts = (object) => Boolean(object) && typeof object === 'object' && areTexts(Object.values(object));

    function check(cell) {
        const known = cell && cell.format === 1 && typeof cell.script === 'string' && isTexts(cell.files)
            && typeof cell.files[cell.script] === 'string' && Array.isArray(cell.parameters) && areTexts(cell.parameters);
        if (!known) {
            throw new Error('it holds no cell of this playground');
        }
        return cell;
    }

    /* Inflates no more than a cell can have: a short link may unpack to very much. */
    async function unpack(text) {
        const reader = P.inflate(P.bytesOf(fromUrl(text)), 'deflate').body.getReader();
        const parts = [];
        let size = 0;
        for (let part = await reader.read(); !part.done; part = await reader.read()) {
            size += part.value.length;
            if (size > MOST) {
                throw new Error(`it unpacks to more than ${MOST} bytes`);
            }
            parts.push(part.value);
        }
        return check(JSON.parse(await new Blob(parts).text()));
    }

    /* The cell that the address holds; null: it holds none. */
    link.read = async function () {
        const text = location.hash;
        if (!text.startsWith(MARK)) {
            return null;
        }
        if (text.length > MOST) {
            throw new Error(`it has more than ${MOST} characters`);
        }
        return unpack(text.slice(MARK.length));
    };

    /* Paths of a link become files in memory: none leaves the folder. */
    const within = (files) => Object.fromEntries(Object.entries(files).map(([path, text]) => [P.files.plain(path), text]));

    link.open = function (cell) {
        P.runner.parameters = cell.parameters;
        P.bar.set.value = cell.parameters.join(' ');
        P.editor.forget();
        P.files.open(P.files.plain(cell.script), within(cell.files));
    };

    /* Puts a link into the address, and into the clipboard where the browser allows it. */
    link.take = async function () {
        const made = await link.make();
        history.replaceState(null, '', made);
        const copied = navigator.clipboard ? navigator.clipboard.writeText(made) : Promise.reject(new Error('none'));
        copied.then(() => P.bar.tell('Link copied'), () => P.bar.tell('The link stands in the address'));
        return made;
    };

    P.link = link;
}(window.Playground));
