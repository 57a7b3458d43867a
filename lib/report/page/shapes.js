/* The scene's nodes as objects of three.js, and the small objects that we add: triads and marks. */
(function (W) {
    'use strict';

    const THREE = window.THREE;
    const AXES = ['x', 'y', 'z'];

    function geometry(part) {
        if (!part.geometry) {
            const made = new THREE.BufferGeometry();
            made.setAttribute('position', new THREE.BufferAttribute(part.positions, 3));
            made.setIndex(new THREE.BufferAttribute(part.indices, 1));
            const flat = made.toNonIndexed();
            flat.computeVertexNormals();
            part.geometry = flat;
            part.edges = new THREE.EdgesGeometry(made, 30);
        }
        return part;
    }

    /* A plane that cuts a closed body shows its back sides; they are drawn in one colour, hatched, as the cut. */
    const CUT = { colour: { value: new THREE.Color(0x888888) }, shown: { value: 0 } };
    const HATCH = `
        if (cutShown > 0.5 && !gl_FrontFacing) {
            gl_FragColor.rgb = mod(gl_FragCoord.x + gl_FragCoord.y, 7.0) < 1.4 ? 0.72 * cutColour : cutColour;
        }`;

    function hatch(shader) {
        shader.uniforms.cutColour = CUT.colour;
        shader.uniforms.cutShown = CUT.shown;
        shader.fragmentShader = 'uniform vec3 cutColour;\nuniform float cutShown;\n'
            + shader.fragmentShader.replace('#include <fog_fragment>', HATCH + '\n#include <fog_fragment>');
    }

    function surface(part) {
        const clear = part.alpha < 1;
        const made = new THREE.MeshLambertMaterial({ transparent: clear, opacity: part.alpha, depthWrite: !clear,
            side: THREE.DoubleSide, shadowSide: THREE.BackSide, clippingPlanes: [], clipShadows: true,
            polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
        if (!clear) {
            made.onBeforeCompile = hatch;
        }
        return made;
    }

    /* Draws a part with its edges, as technical drawings do. */
    function solid(part) {
        const { geometry: flat, edges } = geometry(part);
        const group = new THREE.Group();
        const mesh = new THREE.Mesh(flat, surface(part));
        const lines = new THREE.LineSegments(edges, new THREE.LineBasicMaterial({ transparent: true }));
        lines.userData.edges = part.alpha;
        mesh.userData.part = part;
        group.add(mesh, lines);
        return group;
    }

    function place(object, node) {
        if (node.matrix) {
            object.applyMatrix(new THREE.Matrix4().fromArray(node.matrix));
            return;
        }
        object.position.fromArray(node.r);
        object.quaternion.fromArray(node.q);
        object.scale.fromArray(node.s);
    }

    /* Makes the whole tree; `named` collects objects by their nodes' keys. */
    function tree(node, named) {
        const group = new THREE.Group();
        place(group, node);
        node.parts.forEach((part) => group.add(solid(part)));
        node.children.forEach((child) => group.add(tree(child, named)));
        if (node.kind) {
            group.userData.node = node;
            named[W.gltf.key(node.kind, node.index)] = group;
        }
        return group;
    }

    /* Draws three bars along a frame's axes, `size` in metres. */
    function triad(size) {
        const group = new THREE.Group();
        AXES.forEach((axis, i) => {
            const sides = [0.02, 0.02, 0.02].map((thin, k) => (k === i ? size : thin * size * 1.5));
            const bar = new THREE.Mesh(new THREE.BoxBufferGeometry(...sides), new THREE.MeshBasicMaterial());
            bar.position.setComponent(i, size / 2);
            bar.userData.axis = axis;
            group.add(bar);
        });
        group.userData.triad = true;
        return group;
    }

    /* A mark where something happened; it shows through everything in front of it. */
    function mark(size) {
        const shape = new THREE.OctahedronBufferGeometry(size);
        const look = new THREE.MeshBasicMaterial({ depthTest: false, transparent: true });
        return new THREE.Mesh(shape, look);
    }

    /* A line between two points, which are set later. */
    function line() {
        const made = new THREE.BufferGeometry();
        made.setAttribute('position', new THREE.BufferAttribute(new Float32Array(6), 3));
        const look = new THREE.LineBasicMaterial({ depthTest: false, transparent: true });
        const object = new THREE.Line(made, look);
        object.renderOrder = 12;
        object.frustumCulled = false;
        return object;
    }

    /* A path of up to `most` points, with dots; it shows through everything in front of it. */
    function path(most) {
        const buffer = () => {
            const made = new THREE.BufferGeometry();
            ['position', 'color'].forEach((name) => made.setAttribute(name,
                new THREE.BufferAttribute(new Float32Array(3 * most), 3)));
            return made;
        };
        const look = { vertexColors: THREE.VertexColors, depthTest: false, transparent: true };
        const lines = new THREE.Line(buffer(), new THREE.LineBasicMaterial(look));
        const dots = new THREE.Points(buffer(),
            new THREE.PointsMaterial(Object.assign({ size: 5, sizeAttenuation: false }, look)));
        const group = new THREE.Group();
        [lines, dots].forEach((each) => Object.assign(each, { frustumCulled: false, renderOrder: 9 }));
        group.add(lines, dots);
        return group;
    }

    function fill(object, points, colourOf) {
        const { position, color } = object.geometry.attributes;
        points.forEach((point, i) => {
            const { r, g, b } = colourOf(point);
            position.setXYZ(i, ...point.r.map((x) => 0.001 * x));
            color.setXYZ(i, r, g, b);
        });
        [position, color].forEach((each) => { each.needsUpdate = true; });
        object.geometry.setDrawRange(0, points.length);
    }

    /* Shows points { r (mm), age (0 to 1), dot }: an older point is nearer to the ground's colour. */
    function lay(made, points, colour, ground) {
        const [from, to] = [new THREE.Color(colour), new THREE.Color(ground)];
        const colourOf = (point) => from.clone().lerp(to, 0.85 * point.age);
        fill(made.children[0], points, colourOf);
        fill(made.children[1], points.filter((point) => point.dot), colourOf);
    }

    W.shapes = { tree, triad, mark, line, path, lay, CUT, AXES };
}(window.Waferhand));
