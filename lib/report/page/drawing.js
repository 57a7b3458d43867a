/* Shows the cell without WebGL: drawings from above and from the side, moved to the shown time. It does what scene.js does. */
(function (W) {
    'use strict';

    /* The directions across, up and towards the eye, as base's axes. */
    const SIDES = {
        top: { title: 'from above', across: 0, up: 1, near: (p) => p[2] },
        side: { title: 'from the side', across: 0, up: 2, near: (p) => -p[1] },
    };

    function movers(doc) {
        const found = {};
        const add = (kind, i, name, at) => { found[W.gltf.key(kind, i)] = { kind, i, name, at }; };
        doc.tracks.machine.links.forEach((name, i) => add('link', i, name, (t) => W.robot.link(doc.tracks, i, t)));
        doc.names.grippers.forEach((name, i) => add('gripper', i, name, (t) => W.robot.gripper(doc.tracks, i, t)));
        doc.names.doors.forEach((name, i) => add('door', i, name, (t) => W.robot.door(doc.tracks, i, t)));
        doc.names.wafers.forEach((name, i) => add('wafer', i, name, (t) => W.tracks.wafer(doc.tracks, i, t)));
        return found;
    }

    /* Computes the points of each body now; bodies that stand still are computed once. */
    function pose(view, t) {
        view.at = t;
        Object.values(view.movers).forEach((mover) => { mover.pose = mover.at(t); });
        view.bodies.forEach((body) => {
            if (!body.mover) {
                body.now = body.points;
            } else if (body.mover.pose) {
                const { r, q } = body.mover.pose;
                body.now = body.points.map((p) => W.pose.add(r, W.pose.rotate(q, p)));
            } else {
                body.now = null;
            }
        });
    }

    function bounds(view) {
        const box = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
        view.bodies.filter((body) => body.now).forEach((body) => body.now.forEach((p) => p.forEach((x, i) => {
            box.low[i] = Math.min(box.low[i], x);
            box.high[i] = Math.max(box.high[i], x);
        })));
        return box;
    }

    /* The panels in view, side by side or, where it is narrow, one above the other. */
    function panels(view) {
        const sides = view.shown === 'top' || view.shown === 'side' ? [view.shown] : ['top', 'side'];
        const { clientWidth: width, clientHeight: height } = view.host;
        const wide = width > height;
        const share = 1 / sides.length;
        const areas = sides.map((_, i) => (wide ? { x: i * share * width, y: 0, w: share * width, h: height }
            : { x: 0, y: i * share * height, w: width, h: share * height }));
        const scale = scaleOf(view.box, sides.map((name) => SIDES[name]), areas[0]);
        return sides.map((name, i) => fit(view.box, SIDES[name], areas[i], scale));
    }

    const size = (box, side) => [side.across, side.up].map((i) => box.high[i] - box.low[i]);

    /* All panels have one scale, so that they can be compared. */
    function scaleOf(box, sides, area) {
        return Math.min(...sides.map((side) => Math.min((area.w - 40) / size(box, side)[0],
            (area.h - 120) / size(box, side)[1])));
    }

    function fit(box, side, area, scale) {
        const middle = [side.across, side.up].map((i) => (box.high[i] + box.low[i]) / 2);
        return { side, area, spot: (p) => [area.x + area.w / 2 + (p[side.across] - middle[0]) * scale,
            area.y + area.h / 2 + 14 - (p[side.up] - middle[1]) * scale] };
    }

    function colourOf(view, body) {
        if (body.mover && body.mover.kind === 'gripper') {
            return W.theme.series(body.mover.i);
        }
        if (body.mover && body.mover.kind === 'wafer') {
            const state = W.tracks.hold(view.doc.tracks.wafers[body.mover.i], view.at);
            return state && typeof state.holder === 'number' ? W.theme.series(state.holder) : W.theme.colour('wafer');
        }
        return W.gltf.colour(body.part);
    }

    function path(pen, shapes) {
        pen.beginPath();
        shapes.forEach((points) => {
            points.forEach((p, i) => (i === 0 ? pen.moveTo(...p) : pen.lineTo(...p)));
            pen.closePath();
        });
    }

    /* Fills a body's triangles as one shape, without lines between them. */
    function drawBody(view, panel, body) {
        const pen = view.pen;
        path(pen, W.hulls.shapes(body, body.now.map(panel.spot)));
        pen.globalAlpha = body.mover ? 0.55 : Math.min(0.3, body.part.alpha);
        pen.fillStyle = colourOf(view, body);
        pen.fill();
        pen.globalAlpha = 0.8;
        pen.strokeStyle = W.theme.colour('edge');
        if (!body.dented) {
            pen.stroke();
        }
        pen.globalAlpha = 1;
    }

    function text(view, words, x, y, colour) {
        const pen = view.pen;
        pen.lineWidth = 4;
        pen.strokeStyle = W.theme.colour('stage');
        pen.strokeText(words, x, y);
        pen.fillStyle = colour;
        pen.fillText(words, x, y);
        pen.lineWidth = 1;
    }

    /* The names of obstacles, in the middle of their tops. */
    function obstacles(view) {
        return view.bodies.filter((body) => body.owner && body.owner.kind === 'obstacle').map(({ owner, points }) => {
            const middle = [0, 1].map((i) => points.reduce((sum, p) => sum + p[i], 0) / points.length);
            return { name: owner.name, kind: 'obstacle', i: owner.index, at: [...middle, Math.max(...points.map((p) => p[2]))] };
        });
    }

    /* The things that have names, the most important first, with their places. */
    function named(view) {
        const { slots, names } = view.doc;
        const moving = Object.values(view.movers).filter((mover) => mover.pose)
            .map(({ kind, i, name, pose: { r } }) => ({ kind, i, name, at: r }));
        const stations = slots.filter((slot) => slot.slot === 1 && names.stations[slot.station] !== undefined)
            .map(({ station, r }) => ({ kind: 'station', i: station, name: names.stations[station], at: r }));
        return [].concat(moving.filter(({ kind }) => kind === 'gripper'), stations, obstacles(view),
            moving.filter(({ kind }) => kind === 'wafer')).filter(({ kind, i }) => !W.parts.isHidden(kind, i));
    }

    /* If two names would cover each other, the first stays. */
    function drawNames(view, panel) {
        const taken = [];
        named(view).forEach(({ name, kind, at }) => {
            const [x, y] = panel.spot(at);
            const high = kind === 'station' ? y + 16 : y - 6;
            const box = { left: x, right: x + view.pen.measureText(name).width + 8, top: high - 14, bottom: high + 3 };
            if (!taken.some((other) => box.left < other.right && other.left < box.right && box.top < other.bottom
                && other.top < box.bottom)) {
                taken.push(box);
                text(view, name, x + 6, high, W.theme.colour('ink'));
            }
        });
    }

    /* Draws the trail; its older parts are fainter. */
    function drawTrail(view, panel, i) {
        const points = W.trail.points(view.doc, i, view.at);
        const spots = points.map((point) => panel.spot(point.r));
        const colour = W.theme.series(i);
        points.forEach(({ age, dot }, k) => {
            view.pen.globalAlpha = 1 - 0.85 * age;
            if (k > 0) {
                line(view, spots[k - 1], spots[k], colour, 1.5);
            }
            if (dot) {
                view.pen.fillStyle = colour;
                view.pen.fillRect(spots[k][0] - 2, spots[k][1] - 2, 4, 4);
            }
        });
        view.pen.globalAlpha = 1;
    }

    function drawFrames(view, panel) {
        const framed = Object.values(view.movers).filter((mover) => !['link', 'door'].includes(mover.kind) && mover.pose);
        framed.forEach(({ pose: { r, q } }) => {
            [0, 1, 2].forEach((i) => {
                const tip = W.pose.add(r, W.pose.axis(q, i).map((x) => 100 * x));
                line(view, panel.spot(r), panel.spot(tip), W.theme.colour('axis-' + 'xyz'[i]), 2);
            });
        });
    }

    function line(view, from, to, colour, width) {
        const pen = view.pen;
        pen.beginPath();
        pen.moveTo(...from);
        pen.lineTo(...to);
        pen.lineWidth = width;
        pen.strokeStyle = colour;
        pen.stroke();
        pen.lineWidth = 1;
    }

    /* Writes words beside a mark, within the panel; the words of several marks stand one above the other. */
    function drawWords(view, panel, words, [x, y]) {
        const { x: left, w: width } = panel.area;
        const last = left + width - view.pen.measureText(words).width - 6;
        text(view, words, W.clamp(x, left + 4, Math.max(left + 4, last)), y, view.pen.fillStyle);
    }

    function drawMarks(view, panel) {
        let above = 0;
        view.marks.forEach((mark) => {
            const near = W.marks.isNear(mark, view.at);
            const [x, y] = panel.spot(mark.at);
            view.pen.fillStyle = W.theme.colour(W.marks.colourName(mark));
            view.pen.beginPath();
            view.pen.arc(x, y, near ? 7 : 3.5, 0, 7);
            view.pen.fill();
            if (near) {
                drawWords(view, panel, W.marks.text(mark), [x + 10, y - 11 - 20 * above++]);
            }
        });
    }

    function drawRuler(view, panel) {
        const [from, to] = view.ends.map(panel.spot);
        line(view, from, to, W.theme.colour('ink'), 2);
        text(view, view.measured, (from[0] + to[0]) / 2 + 6, (from[1] + to[1]) / 2 - 6, W.theme.colour('ink'));
    }

    function drawPanel(view, panel) {
        const nearest = (body) => Math.max(...body.now.map(panel.side.near));
        const isShown = ({ owner }) => !owner || !W.parts.isHidden(owner.kind, owner.index);
        view.bodies.filter((body) => body.now && isShown(body)).map((body) => [nearest(body), body])
            .sort((a, b) => a[0] - b[0]).forEach(([, body]) => drawBody(view, panel, body));
        text(view, panel.side.title, panel.area.x + 14, panel.area.y + 64, W.theme.colour('dim'));
        drawMarks(view, panel);
        if (view.options.trail) {
            W.trail.riders(view.doc).filter((i) => !W.parts.isHidden('gripper', i)).forEach((i) => drawTrail(view, panel, i));
        }
        if (view.options.frames) {
            drawFrames(view, panel);
        }
        if (view.options.names) {
            drawNames(view, panel);
        }
        if (view.ends) {
            drawRuler(view, panel);
        }
    }

    function render(view) {
        const scale = window.devicePixelRatio || 1;
        const { clientWidth: width, clientHeight: height } = view.host;
        view.due = false;
        view.canvas.width = width * scale;
        view.canvas.height = height * scale;
        view.pen.setTransform(scale, 0, 0, scale, 0, 0);
        view.pen.font = '13px system-ui, "DejaVu Sans", sans-serif';
        view.pen.lineJoin = 'round';
        view.pen.fillStyle = W.theme.colour('stage');
        view.pen.fillRect(0, 0, width, height);
        panels(view).forEach((panel) => drawPanel(view, panel));
    }

    function draw(view) {
        if (!view.due) {
            view.due = true;
            requestAnimationFrame(() => render(view));
        }
    }

    /* The frames whose origins are within a finger's width of the pointer, the nearest first. */
    function pick(view, event) {
        const area = view.canvas.getBoundingClientRect();
        const spot = [event.clientX - area.left, event.clientY - area.top];
        const found = [];
        panels(view).forEach((panel) => Object.values(view.movers).forEach(({ kind, i, pose: at }) => {
            if (at && kind !== 'link' && !W.parts.isHidden(kind, i)) {
                const [x, y] = panel.spot(at.r);
                found.push({ kind, i, at: at.r, far: Math.hypot(x - spot[0], y - spot[1]) });
            }
        }));
        return found.filter((each) => each.far < 30).sort((a, b) => a.far - b.far);
    }

    function make(host, doc, roots) {
        const canvas = W.element('canvas');
        const view = { host, doc, canvas, pen: canvas.getContext('2d'), options: {}, shown: 'whole', due: false };
        host.append(canvas);
        view.movers = movers(doc);
        view.bodies = W.hulls.make(roots || [], view.movers);
        view.marks = W.marks.placed(doc);
        pose(view, 0);
        view.box = bounds(view);
        view.update = (t) => { pose(view, t); draw(view); };
        view.paint = () => draw(view);
        view.resize = () => draw(view);
        view.show = (name) => { view.shown = name; draw(view); };
        view.hide = () => draw(view);
        view.set = (options) => { Object.assign(view.options, options); draw(view); };
        view.rule = (ends, words) => { Object.assign(view, { ends, measured: words }); draw(view); };
        view.pick = (event) => pick(view, event);
        view.panels = () => panels(view);
        view.still = () => { render(view); return canvas.toDataURL('image/png'); };
        W.observe(host, view.resize);
        return view;
    }

    W.drawing = { make };
}(window.Waferhand));
