/* Light that shows depth: a sky, a sun with soft shadows, and a ground that receives them. Shadows are drawn again only when
 * something moves, not when the camera does. */
(function (W) {
    'use strict';

    const THREE = window.THREE;
    const MAP = 1024; /* texels along a side of the shadow's map */
    const SUN = [-0.55, -0.75, 1.5];
    /* Offsets, in texels, at which the map is read beside a point. three.js itself reads at one place or at seventeen; in
     * software GL seventeen take as long as everything else together. */
    const TAPS = [[0, 0], [0.9, 0.4], [-0.4, 0.9], [-0.9, -0.4], [0.4, -0.9]];
    const HARD = 'shadow = texture2DCompare( shadowMap, shadowCoord.xy, shadowCoord.z );';

    function soften() {
        const tap = ([x, y]) => `texture2DCompare( shadowMap, shadowCoord.xy + vec2( ${x.toFixed(1)}, ${
            y.toFixed(1)} ) * shadowRadius / shadowMapSize, shadowCoord.z )`;
        THREE.ShaderChunk.shadowmap_pars_fragment = THREE.ShaderChunk.shadowmap_pars_fragment
            .replace(HARD, `shadow = ( ${TAPS.map(tap).join(' + ')} ) / ${TAPS.length.toFixed(1)};`);
    }

    function sun(middle, reach) {
        const made = new THREE.DirectionalLight(0xffffff, 0.62);
        made.position.copy(middle).addScaledVector(new THREE.Vector3(...SUN).normalize(), 2 * reach);
        made.target.position.copy(middle);
        made.castShadow = true;
        made.shadow.mapSize.set(MAP, MAP);
        made.shadow.radius = 1.6;
        made.shadow.bias = -0.0012;
        Object.assign(made.shadow.camera, { left: -reach, right: reach, bottom: -reach, top: reach, near: 0.1 * reach,
            far: 4 * reach });
        return made;
    }

    /* The ground receives shadows and nothing else. */
    function ground(middle, reach, z) {
        const made = new THREE.Mesh(new THREE.PlaneBufferGeometry(4 * reach, 4 * reach),
            new THREE.ShadowMaterial({ opacity: 0.2, depthWrite: false }));
        made.position.set(middle.x, middle.y, z);
        made.receiveShadow = true;
        return made;
    }

    /* Adds the light to a scene whose corners enclose all that is in it. */
    function add(view) {
        const box = new THREE.Box3().setFromPoints(view.corners);
        const middle = box.getCenter(new THREE.Vector3());
        const reach = box.getSize(new THREE.Vector3()).length() / 2;
        const shining = sun(middle, reach);
        view.gl.shadowMap.enabled = true;
        view.gl.shadowMap.type = THREE.BasicShadowMap;
        view.gl.shadowMap.autoUpdate = false;
        view.ground = ground(middle, reach, box.min.z - 0.003);
        view.sun = shining;
        view.scene.add(new THREE.HemisphereLight(0xffffff, 0x7b838c, 0.62), shining, shining.target, view.ground);
    }

    /* Parts that are not transparent cast shadows; all parts receive them. */
    function mark(scene) {
        scene.traverse((child) => {
            if (child.userData.part) {
                child.castShadow = child.userData.part.alpha === 1;
                child.receiveShadow = true;
            }
        });
    }

    /* Switches shadows on or off; without them the sun shines through everything. */
    function set(view, on) {
        view.sun.castShadow = on;
        view.ground.visible = on;
        stale(view);
    }

    function stale(view) {
        view.gl.shadowMap.needsUpdate = true;
    }

    if (THREE) {
        soften();
    }

    W.light = { add, mark, set, stale };
}(window.Waferhand));
