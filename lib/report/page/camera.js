/* Where the cell is seen from: the whole, from above, from the side, or riding along with a gripper. z is up. */
(function (W) {
    'use strict';

    const THREE = window.THREE;
    const WIDTH_DEG = 32;

    /* From where to look at the middle in each view that stands still. */
    const VIEWS = { whole: [0.62, -0.75, 0.62], top: [0, -0.0005, 1], side: [0, -1, 0.0005] };

    /* How far away the box's corners are all in the picture. */
    function distance(camera, box, back) {
        const middle = box.getCenter(new THREE.Vector3());
        const right = new THREE.Vector3().crossVectors(camera.up, back).normalize();
        const up = new THREE.Vector3().crossVectors(back, right);
        const tall = Math.tan(camera.fov * Math.PI / 360);
        let far = 0;
        for (let i = 0; i < 8; ++i) {
            const corner = new THREE.Vector3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                i & 4 ? box.max.z : box.min.z).sub(middle);
            const aside = Math.max(Math.abs(corner.dot(right)) / (tall * camera.aspect),
                Math.abs(corner.dot(up)) / tall);
            far = Math.max(far, aside + corner.dot(back));
        }
        return 1.06 * far;
    }

    function make(canvas, box, changed) {
        const camera = new THREE.PerspectiveCamera(WIDTH_DEG, 1, 0.02, 40);
        camera.up.set(0, 0, 1);
        const controls = new THREE.OrbitControls(camera, canvas);
        controls.enableKeys = false;
        controls.enableZoom = false;
        controls.addEventListener('change', changed);
        canvas.addEventListener('focus', () => { controls.enableZoom = true; });
        canvas.addEventListener('blur', () => { controls.enableZoom = false; });
        const rig = { camera, controls, view: 'whole', rider: null, moved: false };
        controls.addEventListener('start', () => { rig.moved = true; });
        rig.show = (view, rider) => show(rig, box, view, rider);
        rig.resize = (width, height) => resize(rig, box, width, height);
        rig.ride = () => ride(rig);
        return rig;
    }

    function show(rig, box, view, rider) {
        rig.view = view;
        rig.rider = view === 'gripper' ? rider : null;
        rig.moved = false;
        rig.controls.enabled = view !== 'gripper';
        if (view === 'gripper') {
            ride(rig);
            return;
        }
        const back = new THREE.Vector3(...VIEWS[view]).normalize();
        box.getCenter(rig.controls.target);
        rig.camera.position.copy(rig.controls.target).addScaledVector(back, distance(rig.camera, box, back));
        rig.camera.lookAt(rig.controls.target);
        rig.controls.update();
    }

    /* Behind and above the gripper, looking where it enters. */
    function ride(rig) {
        const pose = rig.rider && rig.rider();
        if (!pose) {
            return;
        }
        const at = (x, y, z) => new THREE.Vector3(...W.pose.add(pose.r, W.pose.rotate(pose.q, [x, y, z])))
            .multiplyScalar(0.001);
        rig.camera.position.copy(at(-760, -260, 420));
        rig.controls.target.copy(at(60, 0, -10));
        rig.camera.lookAt(rig.controls.target);
    }

    function resize(rig, box, width, height) {
        rig.camera.aspect = width / height;
        rig.camera.updateProjectionMatrix();
        if (!rig.moved && rig.view !== 'gripper') {
            show(rig, box, rig.view, null);
        }
    }

    W.camera = { make };
}(window.Waferhand));
