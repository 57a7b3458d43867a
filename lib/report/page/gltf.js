/* Reads the document's scene: a glTF 2.0 object with its buffers inside. It reads what the program writes: nodes (matrix or
 * translation, rotation, scale), triangles, base colours. It needs no three.js, so that drawings can use it too. */
(function (W) {
    'use strict';

    const ARRAYS = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array,
        5126: Float32Array };
    const SIZES = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };

    function bytes(uri) {
        const text = atob(uri.slice(uri.indexOf(',') + 1));
        const made = new Uint8Array(text.length);
        for (let i = 0; i < text.length; ++i) {
            made[i] = text.charCodeAt(i);
        }
        return made.buffer;
    }

    /* An accessor's numbers, tightly packed. */
    function numbers(file, i) {
        const accessor = file.accessors[i];
        const view = file.bufferViews[accessor.bufferView];
        const Kind = ARRAYS[accessor.componentType];
        const size = SIZES[accessor.type];
        const from = (view.byteOffset || 0) + (accessor.byteOffset || 0);
        const stride = view.byteStride || size * Kind.BYTES_PER_ELEMENT;
        if (stride === size * Kind.BYTES_PER_ELEMENT) {
            return new Kind(file.data[view.buffer].slice(from, from + accessor.count * stride));
        }
        const made = new Kind(accessor.count * size);
        for (let k = 0; k < accessor.count; ++k) {
            const at = from + k * stride;
            made.set(new Kind(file.data[view.buffer].slice(at, at + size * Kind.BYTES_PER_ELEMENT)), k * size);
        }
        return made;
    }

    /* Encodes colours for screens: glTF's colours are linear. */
    const encoded = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * Math.pow(x, 1 / 2.4) - 0.055);

    function material(file, i) {
        const found = (file.materials || [])[i] || {};
        const surface = found.pbrMetallicRoughness || {};
        const linear = surface.baseColorFactor || [0.7, 0.7, 0.7, 1];
        return { name: found.name || '', colour: linear.slice(0, 3).map(encoded), alpha: linear[3] };
    }

    function part(file, primitive) {
        const positions = numbers(file, primitive.attributes.POSITION);
        const indices = primitive.indices === undefined
            ? Uint32Array.from({ length: positions.length / 3 }, (_, k) => k) : numbers(file, primitive.indices);
        return Object.assign({ positions, indices }, material(file, primitive.material));
    }

    /* Reads primitives of triangles only; a mesh is read once, however many nodes show it. */
    function mesh(file, i) {
        if (!file.parts[i]) {
            file.parts[i] = file.meshes[i].primitives
                .filter((primitive) => primitive.mode === undefined || primitive.mode === 4)
                .map((primitive) => part(file, primitive));
        }
        return file.parts[i];
    }

    const NODE = { name: '', translation: [0, 0, 0], rotation: [0, 0, 0, 1], scale: [1, 1, 1], matrix: null, children: [],
        extras: {} };

    /* `kind` and `index` identify a node, because names need not be unique. */
    function node(file, i) {
        const from = Object.assign({}, NODE, file.nodes[i]);
        const { kind = '', index = 0 } = from.extras;
        return { name: from.name, kind, index, matrix: from.matrix, r: from.translation, q: from.rotation, s: from.scale,
            parts: from.mesh === undefined ? [] : mesh(file, from.mesh),
            children: from.children.map((child) => node(file, child)) };
    }

    /* The scene's root nodes, or null if no scene can be read. */
    function read(scene) {
        if (!scene || !scene.nodes || !scene.scenes) {
            return null;
        }
        try {
            const file = Object.assign({ parts: [] }, scene);
            file.data = (scene.buffers || []).map((buffer) => bytes(buffer.uri));
            return scene.scenes[scene.scene || 0].nodes.map((i) => node(file, i));
        } catch (error) {
            W.fault = 'the scene cannot be read: ' + error.message;
            return null;
        }
    }

    /* The page's own colour for a material that it knows, otherwise the file's. */
    function colour(look) {
        return W.theme.colour('part-' + look.name) || `rgb(${look.colour.map((x) => Math.round(255 * x)).join()})`;
    }

    /* The key of a node; a gripper, a wafer and a link of the document have such a key too. */
    const key = (kind, i) => `${kind} ${i}`;

    W.gltf = { read, colour, key };
}(window.Waferhand));
