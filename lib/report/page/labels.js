/* Words in the picture: names of stations and of moving things, marks, and the measured distance with its line. */
(function (W) {
    'use strict';

    const THREE = window.THREE;
    const M = 0.001;
    const MANY = 20;
    /* Places of a name: left of its point, and pixels lower. A wafer that nobody holds has only the first place if there are
     * many names. */
    const PLACES = [[false, 0], [true, 0], [false, 19], [true, 19], [false, -19], [true, -19]];

    function make(view, kind, text) {
        const made = W.element('span', { class: 'tag ' + kind, text, 'aria-hidden': 'true', hidden: true });
        view.host.append(made);
        return made;
    }

    /* Stations have their names at their lowest slots. */
    function stations(view) {
        const { slots, names } = view.doc;
        return slots.filter((slot) => slot.slot === 1 && names.stations[slot.station] !== undefined)
            .map((slot) => ({ at: new THREE.Vector3(...slot.r).multiplyScalar(M), kind: 'station', i: slot.station,
                label: make(view, 'station', names.stations[slot.station]) }));
    }

    /* Obstacles have their names in the middle of their tops. */
    function obstacles(view) {
        return Object.values(view.named).map((object) => ({ object, node: object.userData.node }))
            .filter(({ node }) => node.kind === 'obstacle').map(({ object, node }) => {
                const box = new THREE.Box3().setFromObject(object);
                const at = box.getCenter(new THREE.Vector3()).setZ(box.max.z);
                return { at, kind: 'obstacle', i: node.index, label: make(view, 'obstacle', node.name) };
            });
    }

    /* Names for what moves by itself, stations and obstacles, the most important first. If two would cover each other, the
     * first stays. It adds the ruler, too. */
    function add(view) {
        const movers = view.moving.map(({ object, kind, i, name }) => ({ at: object.position, object, kind, i, name }));
        const named = (kind) => movers.filter((mover) => mover.kind === kind)
            .map((mover) => Object.assign(mover, { label: make(view, kind, mover.name) }));
        view.tags = [].concat(named('gripper'), stations(view), obstacles(view), named('wafer'));
        view.ruler = W.shapes.line();
        view.rulerLabel = make(view, 'ruler', '');
        view.ruler.visible = false;
        view.scene.add(view.ruler);
    }

    /* Wafers that are held come before the others. */
    const isHeld = (view, tag) => tag.kind === 'wafer' && view.moving.some((mover) => mover.kind === 'wafer' && mover.i === tag.i
        && mover.holder >= 0);

    const isCovered = (box, others) => others.some((other) => box.left < other.right && other.left < box.right
        && box.top < other.bottom && other.top < box.bottom);

    const isGone = (tag) => (tag.object && !tag.object.visible) || W.parts.isHidden(tag.kind, tag.i)
        || W.section.isAway(tag.at.toArray().map((x) => x / M));

    function placesOf(view, tag) {
        const one = tag.kind === 'wafer' && view.tags.length > MANY && !isHeld(view, tag);
        return PLACES.slice(0, one ? 1 : PLACES.length);
    }

    function hangTag(view, tag, taken) {
        tag.label.hidden = !view.options.names || isGone(tag);
        if (tag.label.hidden) {
            return;
        }
        const free = placesOf(view, tag).find(([left, down]) => {
            hangOne(view, tag.label, tag.at, left, down);
            return tag.label.hidden || !isCovered(tag.label.getBoundingClientRect(), taken);
        });
        tag.label.hidden = tag.label.hidden || !free;
        taken.push(...(tag.label.hidden ? [] : [tag.label.getBoundingClientRect()]));
    }

    /* Puts a label beside its point, `down` pixels lower, or hides it. It is to the left if the caller asks, or if a mark has
     * room only there. */
    function hangOne(view, each, point, left, down) {
        const spot = point.clone().project(view.rig.camera);
        const inside = Math.abs(spot.x) < 1 && Math.abs(spot.y) < 1 && spot.z < 1;
        each.hidden = !inside;
        if (inside) {
            const x = (spot.x + 1) / 2 * view.host.clientWidth;
            const y = (1 - spot.y) / 2 * view.host.clientHeight;
            const room = x > 0.55 * view.host.clientWidth && each.classList.contains('mark');
            const aside = left || room ? 'translateX(calc(-100% - 12px))' : '';
            each.style.transform = `translate(${x.toFixed(1)}px, ${(y + down).toFixed(1)}px) ${aside}`;
        }
    }

    function hang(view) {
        view.marks.shown.filter((each) => !each.label.hidden).forEach((each, i) => {
            hangOne(view, each.label, each.shape.position, false, 0);
            each.label.style.marginTop = `${-20 - 24 * i}px`;
        });
        const taken = view.marks.shown.filter((each) => !each.label.hidden).map((each) => each.label.getBoundingClientRect());
        const rank = (tag) => (tag.kind === 'gripper' || tag.kind === 'station' ? 0 : isHeld(view, tag) ? 1 : 2);
        const ranked = [].concat(...[0, 1, 2].map((wanted) => view.tags.filter((tag) => rank(tag) === wanted)));
        ranked.forEach((tag) => hangTag(view, tag, taken));
        if (view.ends) {
            hangOne(view, view.rulerLabel, view.ends[0].clone().lerp(view.ends[1], 0.5), false, 0);
        } else {
            view.rulerLabel.hidden = true;
        }
    }

    /* Draws the measured distance; without ends it draws no line. */
    function rule(view, ends, text) {
        view.ends = ends && ends.map((end) => new THREE.Vector3(...end).multiplyScalar(M));
        view.ruler.visible = !!view.ends;
        if (view.ends) {
            const points = view.ruler.geometry.attributes.position;
            view.ends.forEach((end, i) => points.setXYZ(i, end.x, end.y, end.z));
            points.needsUpdate = true;
            view.rulerLabel.textContent = text;
        }
        view.draw();
    }

    W.labels = { make, add, hang, rule };
}(window.Waferhand));
