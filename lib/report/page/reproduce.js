/* Shows how to repeat the run: the command, the parameters, the version, the hash of the last state. */
(function (W) {
    'use strict';

    /* Copies by the clipboard, or by a selection if a page may not use the clipboard. */
    function copy(text) {
        const area = W.element('textarea', { class: 'aside', 'aria-hidden': 'true' });
        const select = () => {
            area.value = text;
            document.body.append(area);
            area.select();
            const copied = document.execCommand('copy');
            area.remove();
            return copied;
        };
        return navigator.clipboard ? navigator.clipboard.writeText(text).then(() => true, select)
            : Promise.resolve(select());
    }

    function command(doc) {
        return commandOf(doc.reproduce, 'copy');
    }

    /* Shows a command to read and to copy. */
    function commandOf(text, id) {
        const button = W.element('button', { type: 'button', id, click() {
            copy(text).then((copied) => {
                button.textContent = copied ? 'Copied' : 'Please copy by hand';
                W.say(button.textContent);
                setTimeout(() => { button.textContent = 'Copy'; }, 2000);
            });
        } }, 'Copy');
        return W.element('div', { class: 'command' }, W.element('code', {}, text), button);
    }

    function facts(doc) {
        const { run, thinning } = doc;
        const parameters = Object.entries(doc.parameters).map(([name, value]) => [`parameter ${name}`, String(value)]);
        return [['version', doc.version], ['hash of the last state', run.hash], ['script', run.script],
            ['layout', run.layout], ...parameters, ['slices', run.slices],
            ['shown', thinning && typeof thinning.kept === 'number' ? `${thinning.kept} of ${thinning.of} points: axes to `
                + `${W.figure(thinning.mm)} mm and ${W.figure(thinning.rad)} rad, grippers to `
                + `${W.figure(thinning.gripper_mm)} mm; exact at events` : null]]
            .filter(([, value]) => value !== null && value !== undefined && value !== '')
            .map(([name, value]) => () => W.tables.row([name, String(value)]));
    }

    W.reproduce = {
        commandOf,
        start(doc, host) {
            const made = W.tables.section('reproduce', 'To have this run again', ['', ''], facts(doc),
                'The document does not hold what reproduces the run.');
            made.insertBefore(doc.reproduce ? command(doc) : W.why('The document holds no command that reproduces the run.'),
                made.children[1] || null);
            host.append(made);
        },
    };
}(window.Waferhand));
