/* Poses: { r: [x, y, z] in mm, q: [x, y, z, w] }, each base_from_body unless a name says otherwise. */
(function (W) {
    'use strict';

    const IDENTITY = { r: [0, 0, 0], q: [0, 0, 0, 1] };

    const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const norm = (a) => Math.sqrt(dot(a, a));

    function cross(a, b) {
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    }

    function rotate(q, v) {
        const twice = cross(q, v).map((x) => 2 * x);
        const again = cross(q, twice);
        return [0, 1, 2].map((i) => v[i] + q[3] * twice[i] + again[i]);
    }

    const conjugate = (q) => [-q[0], -q[1], -q[2], q[3]];

    function multiply(a, b) {
        const v = cross(a, b);
        return [0, 1, 2].map((i) => a[3] * b[i] + b[3] * a[i] + v[i]).concat(a[3] * b[3] - dot(a, b));
    }

    function unit(q) {
        const size = Math.sqrt(dot(q, q) + q[3] * q[3]);
        return q.map((x) => x / size);
    }

    /* Computes base_from_b from base_from_a and a_from_b. */
    function compose(a, b) {
        return { r: add(a.r, rotate(a.q, b.r)), q: multiply(a.q, b.q) };
    }

    function inverse(a) {
        const q = conjugate(a.q);
        return { r: rotate(q, a.r.map((x) => -x)), q };
    }

    /* Turns the shorter way round; the angle comes from a tangent, because the cosine of a small angle says little. */
    function slerp(a, b, share) {
        const sign = dot(a, b) + a[3] * b[3] < 0 ? -1 : 1;
        let apart = 0;
        let along = 0;
        for (let i = 0; i < 4; ++i) {
            apart += (a[i] - sign * b[i]) * (a[i] - sign * b[i]);
            along += (a[i] + sign * b[i]) * (a[i] + sign * b[i]);
        }
        const angle = 2 * Math.atan2(Math.sqrt(apart), Math.sqrt(along));
        const size = Math.sin(angle);
        const from = size > 0 ? Math.sin((1 - share) * angle) / size : 1 - share;
        const to = sign * (size > 0 ? Math.sin(share * angle) / size : share);
        return a.map((x, i) => from * x + to * b[i]);
    }

    function between(a, b, share) {
        return { r: a.r.map((x, i) => x + share * (b.r[i] - x)), q: slerp(a.q, b.q, share) };
    }

    const axis = (q, i) => rotate(q, [0, 1, 2].map((k) => (k === i ? 1 : 0)));

    /* The second frame as seen from the first, in mm and degrees. `angle` is between the two z axes, `turn` the whole
     * rotation. */
    function measure(first, second) {
        const apart = subtract(second.r, first.r);
        const local = rotate(conjugate(first.q), apart);
        const normals = [axis(first.q, 2), axis(second.q, 2)];
        const q = multiply(conjugate(first.q), second.q);
        const degrees = 180 / Math.PI;
        return {
            distance: norm(apart),
            dx: local[0],
            dy: local[1],
            dz: local[2],
            angle: degrees * Math.atan2(norm(cross(normals[0], normals[1])), dot(normals[0], normals[1])),
            turn: degrees * 2 * Math.atan2(norm(q), Math.abs(q[3])),
        };
    }

    W.pose = { IDENTITY, add, subtract, dot, norm, cross, rotate, conjugate, multiply, unit, compose, inverse, slerp, between,
        axis, measure };
}(window.Waferhand));
