/* Marks hits, near misses and the like where they happen. A mark is always small, and it is large and named near its time. */
(function (W) {
    'use strict';

    const NEAR_S = 0.4;
    const colourName = (mark) => W.events.colour(mark.kind);

    /* The marks that have a place, in order of time. */
    const placed = (doc) => doc.marks.filter((mark) => Array.isArray(mark.at)).sort((a, b) => a.t - b.t);

    const isNear = (mark, t) => Math.abs(mark.t - t) <= NEAR_S;

    const text = (mark) => mark.text || W.words(mark.kind);

    /* The marks in a scene of three.js. */
    function make(scene, doc, label) {
        const add = (mark) => {
            const shape = W.shapes.mark(0.012);
            shape.position.fromArray(mark.at).multiplyScalar(0.001);
            shape.renderOrder = colourName(mark) === 'bad' ? 11 : 10;
            scene.add(shape);
            return { mark, shape, label: label('mark ' + colourName(mark), text(mark)) };
        };
        const shown = placed(doc).map(add);
        return {
            shown,
            /* Adds the new marks of a document that has grown. */
            grow() {
                shown.push(...placed(doc).slice(shown.length).map(add));
                this.paint();
            },
            update(t) {
                shown.forEach((each) => {
                    const near = isNear(each.mark, t);
                    each.shape.scale.setScalar(near ? 1.8 : 0.8);
                    each.shape.material.opacity = near ? 1 : 0.55;
                    each.label.hidden = !near;
                });
            },
            paint() {
                shown.forEach((each) => each.shape.material.color.set(W.theme.colour(colourName(each.mark))));
            },
        };
    }

    W.marks = { make, placed, isNear, text, colourName };
}(window.Waferhand));
