/* Words in the picture: names of stations and what moves, marks, and the measured distance with its line. */
(function (W) {
    'use strict';

    const THREE = window.THREE;
    const M = 0.001;

    function make(view, kind, text) {
        const made = W.element('span', { class: 'tag ' + kind, text, 'aria-hidden': 'true', hidden: true });
        view.host.append(made);
        return made;
    }

    /* Stations are named at their lowest slots. */
    function stations(view) {
        const { slots, names } = view.doc;
        return slots.filter((slot) => slot.slot === 1 && names.stations[slot.station] !== undefined)
            .map((slot) => ({ at: new THREE.Vector3(...slot.r).multiplyScalar(M),
                label: make(view, 'station', names.stations[slot.station]) }));
    }

    /* Names for stations and all that moves by itself, and the ruler. */
    function add(view) {
        view.tags = view.moving.filter((mover) => mover.kind !== 'link')
            .map((mover) => ({ at: mover.object.position, label: make(view, mover.kind, mover.name) }))
            .concat(stations(view));
        view.ruler = W.shapes.line();
        view.rulerLabel = make(view, 'ruler', '');
        view.ruler.visible = false;
        view.scene.add(view.ruler);
    }

    /* Puts a label beside its point, or hides it. */
    function hangOne(view, each, point) {
        const spot = point.clone().project(view.rig.camera);
        const inside = Math.abs(spot.x) < 1 && Math.abs(spot.y) < 1 && spot.z < 1;
        each.hidden = !inside;
        if (inside) {
            const x = (spot.x + 1) / 2 * view.host.clientWidth;
            const y = (1 - spot.y) / 2 * view.host.clientHeight;
            const left = x > 0.55 * view.host.clientWidth && each.classList.contains('mark');
            const aside = left ? 'translateX(calc(-100% - 12px))' : '';
            each.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) ${aside}`;
        }
    }

    function hang(view) {
        view.tags.forEach((tag) => {
            if (view.options.names) {
                hangOne(view, tag.label, tag.at);
            } else {
                tag.label.hidden = true;
            }
        });
        view.marks.shown.filter((each) => !each.label.hidden).forEach((each, i) => {
            hangOne(view, each.label, each.shape.position);
            each.label.style.marginTop = `${-20 - 24 * i}px`;
        });
        if (view.ends) {
            hangOne(view, view.rulerLabel, view.ends[0].clone().lerp(view.ends[1], 0.5));
        } else {
            view.rulerLabel.hidden = true;
        }
    }

    /* Draws the measured distance; no ends, no line. */
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
