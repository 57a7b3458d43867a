/* The scene's parts as convex bodies in mm of base, and their outlines from above and from the side. Drawings are made of
 * these. A mesh of several bodies that do not touch is split. */
(function (W) {
    'use strict';

    const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

    /* Multiplies matrices; their columns follow one another, as in glTF. */
    function product(a, b) {
        return IDENTITY.map((_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[(i & 3) + 4 * k] * b[k + (i & 12)], 0));
    }

    function local(node) {
        if (node.matrix) {
            return node.matrix;
        }
        const columns = [0, 1, 2].map((i) => W.pose.axis(node.q, i).map((x) => x * node.s[i]));
        return [...columns[0], 0, ...columns[1], 0, ...columns[2], 0, ...node.r.map((x) => 1000 * x), 1];
    }

    const apply = (m, x, y, z) => [0, 1, 2].map((i) => m[i] * x + m[i + 4] * y + m[i + 8] * z + m[i + 12]);

    function find(parents, i) {
        let root = i;
        while (parents[root] !== root) {
            parents[root] = parents[parents[root]];
            root = parents[root];
        }
        return root;
    }

    /* Numbers a part's vertices; vertices at one place share a number. */
    function places(part) {
        const seen = new Map();
        const p = part.positions;
        return Array.from({ length: p.length / 3 }, (_, i) => {
            const key = [0, 1, 2].map((k) => Math.round(p[3 * i + k] * 1e6)).join();
            if (!seen.has(key)) {
                seen.set(key, i);
            }
            return seen.get(key);
        });
    }

    const vertex = (part, i) => [0, 1, 2].map((k) => 1000 * part.positions[3 * i + k]);

    /* No corner of a convex body lies before any of its faces by more than this share of its size; a wafer's notch is small
     * enough. */
    const DENT = 0.03;

    function isConvex(points, triangles) {
        const reach = Math.max(...points.map((p) => W.pose.norm(W.pose.subtract(p, points[0]))));
        return triangles.every(([a, b, c]) => {
            const normal = W.pose.cross(W.pose.subtract(b, a), W.pose.subtract(c, a));
            const size = W.pose.norm(normal);
            return size === 0 || points.every((p) => W.pose.dot(normal, W.pose.subtract(p, a)) / size < DENT * reach);
        });
    }

    /* A part's bodies, mm: the points that triangles connect, and the triangles themselves if a hull would hide dents. */
    function bodies(part) {
        if (part.bodies) {
            return part.bodies;
        }
        const place = places(part);
        const parents = place.map((_, i) => i);
        const corners = [];
        for (let i = 0; i < part.indices.length; i += 3) {
            corners.push([0, 1, 2].map((k) => place[part.indices[i + k]]));
            const [a, b, c] = corners[corners.length - 1];
            parents[find(parents, b)] = find(parents, a);
            parents[find(parents, c)] = find(parents, a);
        }
        const groups = new Map();
        const group = (i) => {
            const root = find(parents, i);
            groups.set(root, groups.get(root) || { points: [], triangles: [] });
            return groups.get(root);
        };
        new Set(place).forEach((i) => group(i).points.push(vertex(part, i)));
        corners.forEach((three) => group(three[0]).triangles.push(three.map((i) => vertex(part, i))));
        part.bodies = Array.from(groups.values(), ({ points, triangles }) => (isConvex(points, triangles) ? { points }
            : { points: [].concat(...triangles), dented: true }));
        return part.bodies;
    }

    /* Goes through the tree; a node in `movers` begins anew, because its own pose is set later. A body's owner is the nearest
     * node above it that has a kind. */
    function collect(node, above, { mover, owner }, movers, found) {
        const own = movers[W.gltf.key(node.kind, node.index)];
        const below = { mover: own || mover, owner: node.kind ? node : owner };
        const matrix = own ? IDENTITY : product(above, local(node));
        node.parts.forEach((part) => bodies(part).forEach(({ points, dented }) => found.push({
            mover: below.mover, owner: below.owner, part, dented, points: points.map((p) => apply(matrix, ...p)),
        })));
        node.children.forEach((child) => collect(child, matrix, below, movers, found));
    }

    /* Turns y up into z up for bodies that stand still. */
    const Z_UP = [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1];

    function make(roots, movers) {
        const found = [];
        roots.forEach((root) => collect(root, Z_UP, { mover: null, owner: null }, movers, found));
        return found;
    }

    const turn = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);

    function chain(points) {
        const made = [];
        points.forEach((p) => {
            while (made.length > 1 && turn(made[made.length - 2], made[made.length - 1], p) <= 0) {
                made.pop();
            }
            made.push(p);
        });
        made.pop();
        return made;
    }

    /* The outline of points in the plane. */
    function outline(points) {
        const sorted = points.slice().sort((a, b) => a[0] - b[0] || a[1] - b[1]);
        return chain(sorted).concat(chain(sorted.reverse()));
    }

    /* The shapes to fill for a body whose points are seen there: its outline, or each of its triangles that faces the
     * viewer. */
    function shapes(body, points) {
        if (!body.dented) {
            return [outline(points)];
        }
        const found = [];
        for (let i = 0; i < points.length; i += 3) {
            const three = points.slice(i, i + 3);
            if (turn(...three) < 0) {
                found.push(three);
            }
        }
        return found;
    }

    W.hulls = { make, shapes };
}(window.Waferhand));
