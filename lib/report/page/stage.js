/* The picture of the cell with its buttons and its legend: by three.js if possible, by drawings otherwise. */
(function (W) {
    'use strict';

    const VIEWS = [['whole', 'Whole', '1'], ['top', 'Top', '2'], ['side', 'Side', '3'], ['gripper', 'Gripper', '4']];
    const OPTIONS = [['names', 'Names', 'n'], ['frames', 'Frames', 'f'], ['trail', 'Trail', 'r'], ['shadows', 'Shadows', 's']];

    const TAKEN = [['link', 'Link', 'l', () => W.link.take()], ['picture', 'Picture', 'p', () => W.link.picture()]];

    const stage = { view: null, shown: 'whole', rider: 0, buttons: {}, marked: 0,
        options: { names: false, frames: false, trail: false, shadows: true } };

    function button(name, text, key, pressed) {
        const made = W.element('button', { type: 'button', 'aria-pressed': 'false', title: `${text} (${key})`,
            'aria-keyshortcuts': key, 'data-name': name, click: pressed }, text);
        stage.buttons[name] = made;
        return made;
    }

    /* Shows a view by its name; choosing the gripper's view again rides along with the next gripper. */
    stage.show = function (name) {
        const doc = stage.doc;
        const count = doc.names.grippers.length;
        stage.rider = name === 'gripper' && stage.shown === 'gripper' && count > 0 ? (stage.rider + 1) % count
            : stage.rider;
        stage.shown = name;
        stage.view.show(name, () => W.robot.gripper(doc.tracks, stage.rider, W.clock.now));
        VIEWS.forEach(([each]) => stage.buttons[each].setAttribute('aria-pressed', each === name));
        W.say(name === 'gripper' ? `riding along with ${doc.names.grippers[stage.rider]}` : `view: ${name}`);
    };

    stage.choose = function (name, on) {
        if (!stage.buttons[name]) {
            return;
        }
        stage.options[name] = on;
        stage.buttons[name].setAttribute('aria-pressed', on);
        stage.view.set(stage.options);
        legend();
    };

    stage.toggle = (name) => stage.choose(name, !stage.options[name]);

    /* Opens and closes the list of parts; the focus follows. */
    stage.list = function () {
        stage.parts.hidden = !stage.parts.hidden;
        stage.buttons.parts.setAttribute('aria-pressed', !stage.parts.hidden);
        stage.buttons.parts.setAttribute('aria-expanded', !stage.parts.hidden);
        (stage.parts.hidden ? stage.buttons.parts : stage.parts.querySelector('input')).focus({ preventScroll: true });
    };

    stage.section = function () {
        if (stage.buttons.section) {
            W.section.toggle();
            W.say(W.section.on ? 'a plane cuts the cell' : 'no section');
        }
    };

    /* Tells the view which parts are hidden, and where the cell is cut. */
    function changed() {
        stage.view.hide();
        if (stage.buttons.section) {
            stage.view.cut(W.section.plane());
            stage.buttons.section.setAttribute('aria-pressed', W.section.on);
        }
    }

    function sheets(doc, roots) {
        const host = W.element('div', { id: 'sheets' });
        stage.parts = W.parts.make(doc, roots, changed);
        host.append(stage.parts);
        if (stage.view.cut) {
            host.append(W.section.make(stage.view.bounds(), changed));
        }
        document.getElementById('toolbar').append(host);
    }

    const item = (colour, text, shape) => W.element('span', { class: 'item' },
        W.element('i', { class: 'dot ' + (shape || ''), style: `background: var(--${colour})` }), text);

    /* The legend of the colours. */
    function legend() {
        const doc = stage.doc;
        const holders = doc.names.grippers.map((name, i) => item(`s${i % 6}`, `${name}, and what it holds`));
        const kinds = Array.from(new Set(W.marks.placed(doc).map((mark) => mark.kind)));
        const marks = kinds.map((kind) => item(W.marks.colourName({ kind }), W.words(kind), 'mark'));
        const axes = stage.options.frames ? ['x', 'y', 'z'].map((axis) => item('axis-' + axis, axis)) : [];
        const key = document.getElementById('key');
        key.replaceChildren(item('wafer', 'free wafer'), ...holders, ...marks, ...axes);
    }

    function toolbar() {
        const bar = document.getElementById('toolbar');
        const views = VIEWS.map(([name, text, key]) => button(name, text, key, () => stage.show(name)));
        const options = OPTIONS.filter(([name]) => name !== 'shadows' || stage.view.cut)
            .map(([name, text, key]) => button(name, text, key, () => stage.toggle(name)));
        const lists = [button('parts', 'Parts', 'h', stage.list)].concat(stage.view.cut
            ? [button('section', 'Section', 'x', stage.section)] : []);
        const taken = TAKEN.map(([name, text, key, act]) => W.element('button', { type: 'button', title: `${text} (${key})`,
            'aria-keyshortcuts': key, 'data-name': name, click: act }, text));
        bar.append(...[views, options, lists, taken].map((group) => W.element('span', { class: 'group' }, ...group)));
    }

    function picture(host, doc) {
        const roots = W.gltf.read(doc.scene);
        if (!roots) {
            host.append(W.why(doc.scene ? `The cell is not shown: ${W.fault}.`
                : 'The cell is not shown: the document holds no scene.'));
            return null;
        }
        stage.roots = roots;
        const view = W.scene.make(host, doc, roots);
        if (!view) {
            host.classList.add('flat');
        }
        return view || W.drawing.make(host, doc, roots);
    }

    function describe(canvas) {
        canvas.tabIndex = 0;
        canvas.setAttribute('role', 'img');
        canvas.setAttribute('aria-label', 'The cell at the shown time. Drag to orbit, scroll while focused to zoom.');
    }

    stage.start = function (doc) {
        const host = document.getElementById('canvas');
        stage.doc = doc;
        stage.marked = doc.marks.length;
        stage.view = picture(host, doc);
        if (!stage.view) {
            document.getElementById('view').classList.add('empty');
            return;
        }
        describe(stage.view.canvas);
        toolbar();
        sheets(doc, stage.roots);
        stage.choose('shadows', true);
        legend();
        stage.buttons.whole.setAttribute('aria-pressed', 'true');
        W.clock.on('time', (clock) => stage.view.update(clock.now));
        W.clock.on('growth', () => {
            if (stage.view.marks && stage.view.marks.grow && doc.marks.length > stage.marked) {
                stage.marked = doc.marks.length;
                stage.view.marks.grow();
                stage.view.update(W.clock.now);
                legend();
            }
        });
        W.theme.on(() => stage.view.paint());
    };

    W.stage = stage;
}(window.Waferhand));
