/* The cell in three dimensions, by three.js: the document's scene, moved to the shown time. Lengths here are metres, and z is
 * up. */
(function (W) {
    'use strict';

    const THREE = window.THREE;
    const M = 0.001;

    /* glTF has y up; this undoes it, so that everything below it is in the cell's base. */
    function world(doc, roots, named) {
        const group = new THREE.Group();
        group.rotation.x = Math.PI / 2;
        roots.forEach((root) => group.add(W.shapes.tree(root, named)));
        group.updateMatrixWorld(true);
        return group;
    }

    /* Parts that move hang from the base itself, whatever they hang from in the file. */
    function movers(doc, scene, named) {
        const found = [];
        const take = (kind, i, name) => {
            const object = named[W.gltf.key(kind, i)];
            if (object) {
                scene.add(object);
                object.scale.set(1, 1, 1);
                found.push({ object, kind, i, name });
            }
        };
        doc.tracks.machine.links.forEach((name, i) => take('link', i, name));
        doc.names.grippers.forEach((name, i) => take('gripper', i, name));
        doc.names.doors.forEach((name, i) => take('door', i, name));
        doc.names.wafers.forEach((name, i) => take('wafer', i, name));
        return found;
    }

    function poseOf(doc, mover, t) {
        switch (mover.kind) {
        case 'wafer':
            return W.tracks.wafer(doc.tracks, mover.i, t);
        case 'gripper':
            return W.robot.gripper(doc.tracks, mover.i, t);
        case 'door':
            return W.robot.door(doc.tracks, mover.i, t);
        default:
            return W.robot.link(doc.tracks, mover.i, t);
        }
    }

    function put(object, { r, q }) {
        object.position.fromArray(r).multiplyScalar(M);
        object.quaternion.fromArray(q);
    }

    /* Gives every mesh and every edge of an object one colour. */
    function dye(object, colour) {
        object.traverse((child) => {
            if (child.userData.part) {
                child.material.color.set(colour);
            }
        });
    }

    function holderOf(doc, i, t) {
        const state = W.tracks.hold(doc.tracks.wafers[i], t);
        return state && typeof state.holder === 'number' ? state.holder : -1;
    }

    /* A held wafer is paler than its holder, so that the blade shows on it. */
    function waferColour(holder) {
        const colour = new THREE.Color(holder < 0 ? W.theme.colour('wafer') : W.theme.series(holder));
        return holder < 0 ? colour : colour.lerp(new THREE.Color(W.theme.colour('stage')), 0.42);
    }

    /* Draws the floor, in squares of 200 mm. */
    function addFloor(view) {
        const far = Math.max(...view.corners.map((corner) => Math.max(Math.abs(corner.x), Math.abs(corner.y))));
        const count = 4 * Math.ceil(far / 0.2);
        const made = new THREE.GridHelper(count * 0.2, count);
        made.rotation.x = Math.PI / 2;
        made.position.z = Math.min(...view.corners.map((corner) => corner.z)) - 0.002;
        made.material.vertexColors = THREE.NoColors;
        made.material.needsUpdate = true;
        view.floor = made;
        view.scene.add(made);
    }

    /* Draws a triad for each gripper, wafer and station, and for base. */
    function addTriads(doc, scene, moving) {
        const triads = [];
        const add = (parent, size) => {
            const made = W.shapes.triad(size);
            parent.add(made);
            triads.push(made);
            return made;
        };
        add(scene, 0.3);
        moving.filter((mover) => mover.kind !== 'link' && mover.kind !== 'door')
            .forEach((mover) => add(mover.object, 0.12));
        doc.slots.filter((slot) => slot.slot === 1).forEach((slot) => put(add(scene, 0.2), slot));
        return triads;
    }

    /* Returns null without WebGL; it asks here, because three.js would print an error. The picture is kept for paper. */
    function renderer() {
        if (W.kept.gl) {
            return W.kept.gl;
        }
        const canvas = W.element('canvas');
        const wanted = { antialias: true, alpha: false, preserveDrawingBuffer: true };
        const context = canvas.getContext('webgl', wanted) || canvas.getContext('experimental-webgl', wanted);
        if (!context) {
            return null;
        }
        const made = new THREE.WebGLRenderer(Object.assign({ canvas, context }, wanted));
        made.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
        W.kept.gl = made;
        return made;
    }

    /* Returns null without WebGL or without a scene. */
    function make(host, doc, roots) {
        const gl = roots && renderer();
        if (!gl) {
            return null;
        }
        const view = { host, doc, named: {}, scene: new THREE.Scene(), gl, options: {}, due: false };
        view.canvas = view.gl.domElement;
        host.append(view.canvas);
        view.scene.add(world(doc, roots, view.named));
        view.moving = movers(doc, view.scene, view.named);
        pose(view, 0);
        view.corners = W.camera.corners(view.scene);
        addFloor(view);
        W.light.add(view);
        W.light.mark(view.scene);
        view.gl.localClippingEnabled = true;
        view.trails = W.trail.riders(doc).map((i) => {
            const path = W.shapes.path(W.trail.most);
            view.scene.add(path);
            return { i, path };
        });
        view.triads = addTriads(doc, view.scene, view.moving);
        view.marks = W.marks.make(view.scene, doc, (kind, text) => W.labels.make(view, kind, text));
        W.labels.add(view);
        view.rig = W.camera.make(view.canvas, view.corners, () => draw(view));
        return finish(view);
    }

    function finish(view) {
        view.update = (t) => { pose(view, t); draw(view); };
        view.paint = () => { paint(view); draw(view); };
        view.resize = () => { resize(view); draw(view); };
        view.show = (name, rider) => { view.rig.show(name, rider); draw(view); };
        view.set = (options) => {
            Object.assign(view.options, options);
            W.light.set(view, !!view.options.shadows);
            view.paint();
        };
        view.hide = () => { hide(view); draw(view); };
        view.cut = (plane) => { cut(view, plane); draw(view); };
        view.bounds = () => bounds(view);
        view.rule = (ends, text) => W.labels.rule(view, ends, text);
        view.draw = () => draw(view);
        view.pick = (event) => pick(view, event);
        view.still = () => { render(view); return view.canvas.toDataURL('image/png'); };
        W.observe(view.host, view.resize);
        W.atEnd(() => free(view));
        resize(view);
        view.show('whole');
        paint(view);
        return view;
    }

    /* Frees what the scene has in the graphics' memory; the canvas and its programs stay. */
    function free(view) {
        view.isOver = true;
        view.scene.traverse((child) => {
            [child.geometry, child.material, child.shadow && child.shadow.map].filter(Boolean).forEach((each) => each.dispose());
        });
        view.gl.renderLists.dispose();
    }

    function pose(view, t) {
        view.at = t;
        view.moving.forEach((mover) => {
            const found = poseOf(view.doc, mover, t);
            mover.object.visible = found !== null && !W.parts.isHidden(mover.kind, mover.i);
            if (found) {
                put(mover.object, found);
            }
            const holder = mover.kind === 'wafer' ? holderOf(view.doc, mover.i, t) : -1;
            if (mover.kind === 'wafer' && mover.holder !== holder) {
                mover.holder = holder;
                dye(mover.object, waferColour(holder));
            }
        });
        W.light.stale(view);
    }

    /* Hides parts that stand still; parts that move are hidden with their pose. */
    function hide(view) {
        Object.values(view.named).forEach((object) => {
            object.visible = !W.parts.isHidden(object.userData.node.kind, object.userData.node.index);
        });
        pose(view, view.at);
    }

    /* Shows only what lies on one side of a plane; null shows all. */
    function cut(view, plane) {
        const normal = new THREE.Vector3().setComponent(plane ? plane.axis : 0, plane ? plane.keep : 1);
        const planes = plane ? [new THREE.Plane(normal, -plane.keep * plane.at * M)] : [];
        W.shapes.CUT.shown.value = plane ? 1 : 0;
        view.scene.traverse((child) => {
            if (child.userData.part || child.userData.edges !== undefined) {
                child.material.clippingPlanes = planes;
            }
        });
        W.light.stale(view);
    }

    /* The box of all that is in the cell, mm of base. */
    function bounds(view) {
        const { min, max } = new THREE.Box3().setFromPoints(view.corners);
        return { low: min.toArray().map((x) => x / M), high: max.toArray().map((x) => x / M) };
    }

    /* Computes trails only if they are seen, because each point is a pose. */
    function layTrails(view) {
        view.trails.forEach(({ i, path }) => {
            path.visible = !!view.options.trail && !W.parts.isHidden('gripper', i);
            if (path.visible) {
                W.shapes.lay(path, W.trail.points(view.doc, i, view.at), W.theme.series(i), W.theme.colour('stage'));
            }
        });
    }

    /* Sets the colours after a change of the theme or of the shown parts. */
    function paint(view) {
        const colour = W.theme.colour;
        view.scene.background = new THREE.Color(colour('stage'));
        W.shapes.CUT.colour.value.set(colour('cut'));
        view.scene.traverse((child) => {
            if (child.userData.edges !== undefined) {
                child.material.color.set(colour('edge'));
                child.material.opacity = child.userData.edges < 1 ? 0.35 : 0.8;
            } else if (child.userData.part) {
                child.material.color.set(W.gltf.colour(child.userData.part));
            } else if (child.userData.axis) {
                child.material.color.set(colour('axis-' + child.userData.axis));
            }
        });
        view.moving.forEach((mover) => {
            if (mover.kind !== 'link' && mover.kind !== 'door') {
                dye(mover.object, mover.kind === 'wafer' ? waferColour(mover.holder) : W.theme.series(mover.i));
            }
        });
        view.triads.forEach((triad) => { triad.visible = !!view.options.frames; });
        view.marks.paint();
        view.floor.material.color.set(colour('rule'));
        view.ruler.material.color.set(colour('ink'));
    }

    function resize(view) {
        const width = Math.max(view.host.clientWidth, 1);
        const height = Math.max(view.host.clientHeight, 1);
        view.gl.setSize(width, height);
        view.rig.resize(width, height);
    }

    /* Draws at most once a frame, and only when something has changed. */
    function draw(view) {
        if (!view.due) {
            view.due = true;
            requestAnimationFrame(() => render(view));
        }
    }

    function render(view) {
        view.due = false;
        if (view.isOver) {
            return;
        }
        view.rig.ride();
        view.marks.update(view.at);
        layTrails(view);
        view.gl.render(view.scene, view.rig.camera);
        W.labels.hang(view);
    }

    const isSeen = (object) => object === null || (object.visible && isSeen(object.parent));

    /* The part that a mesh belongs to: the nearest node above it that has a kind. */
    function owner(object) {
        return !object || object.userData.node ? object : owner(object.parent);
    }

    /* The things under the pointer, the nearest first: [{ kind, i, at }], at in mm of base. */
    function pick(view, event) {
        const area = view.canvas.getBoundingClientRect();
        const spot = new THREE.Vector2((event.clientX - area.left) / area.width * 2 - 1,
            1 - (event.clientY - area.top) / area.height * 2);
        const ray = new THREE.Raycaster();
        ray.setFromCamera(spot, view.rig.camera);
        return ray.intersectObjects(view.scene.children, true).filter((hit) => hit.object.userData.part && isSeen(hit.object))
            .map((hit) => ({ node: owner(hit.object), at: hit.point.toArray().map((x) => x / M) }))
            .filter((hit) => hit.node && !W.section.isAway(hit.at))
            .map(({ node, at }) => ({ kind: node.userData.node.kind, i: node.userData.node.index, at }));
    }

    W.scene = { make };
}(window.Waferhand));
