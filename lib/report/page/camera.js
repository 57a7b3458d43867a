/* The views of the cell: the whole, from above, from the side, or riding along with a gripper. z is up. */
(function (W) {
    'use strict';

    const THREE = window.THREE;
    const WIDTH_DEG = 32;
    const FLAT_DEG = 7; /* a narrow angle: from above and from the side parallel lines stay nearly parallel */
    const AIR = 1.13; /* room, so that buttons and the legend cover nothing */

    /* The direction from the middle to the eye, in each view that stands still. */
    const VIEWS = { whole: [0.62, -0.75, 0.62], top: [0, -0.0005, 1], side: [0, -1, 0.0005] };

    const AWAY = -50; /* m: wafers whose carrier is away, and those that were taken out, wait far below the cell */

    /* The corners of all meshes' boxes; the picture has to contain them. */
    function corners(scene) {
        const found = [];
        scene.updateMatrixWorld(true);
        scene.traverse((object) => {
            if (object.isMesh) {
                object.geometry.computeBoundingBox();
                const { min, max } = object.geometry.boundingBox;
                for (let i = 0; i < 8; ++i) {
                    found.push(new THREE.Vector3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z)
                        .applyMatrix4(object.matrixWorld));
                }
            }
        });
        return found.filter((corner) => corner.z > AWAY);
    }

    /* The distance from which, looking along `back` at `middle`, every corner is in the picture, and a better middle of the
     * picture. */
    function fit(camera, points, middle, back) {
        const right = new THREE.Vector3().crossVectors(camera.up, back).normalize();
        const up = new THREE.Vector3().crossVectors(back, right);
        const tall = Math.tan(camera.fov * Math.PI / 360);
        const wide = tall * camera.aspect;
        const local = points.map((point) => {
            const from = point.clone().sub(middle);
            return [from.dot(right), from.dot(up), from.dot(back)];
        });
        const most = (f) => Math.max(...local.map(f));
        const sides = [most(([x, , z]) => x / wide + z), most(([x, , z]) => -x / wide + z),
            most(([, y, z]) => y / tall + z), most(([, y, z]) => -y / tall + z)];
        middle.addScaledVector(right, wide * (sides[0] - sides[1]) / 2);
        middle.addScaledVector(up, tall * (sides[2] - sides[3]) / 2);
        return Math.max(sides[0] + sides[1], sides[2] + sides[3]) / 2;
    }

    function make(canvas, points, changed) {
        const camera = new THREE.PerspectiveCamera(WIDTH_DEG, 1, 0.02, 40);
        camera.up.set(0, 0, 1);
        const controls = new THREE.OrbitControls(camera, canvas);
        controls.enableKeys = false;
        controls.enableZoom = false;
        controls.addEventListener('change', changed);
        W.listen(canvas, 'focus', () => { controls.enableZoom = true; });
        W.listen(canvas, 'blur', () => { controls.enableZoom = false; });
        W.atEnd(() => controls.dispose());
        const rig = { camera, controls, view: 'whole', rider: null, moved: false };
        controls.addEventListener('start', () => { rig.moved = true; });
        rig.show = (view, rider) => show(rig, points, view, rider);
        rig.place = (from, target) => {
            rig.moved = true;
            camera.position.fromArray(from);
            controls.target.fromArray(target);
            controls.update();
        };
        rig.resize = (width, height) => resize(rig, points, width, height);
        rig.ride = () => {
            ride(rig);
            clip(rig);
        };
        return rig;
    }

    function widen(camera, degrees) {
        camera.fov = degrees;
        camera.updateProjectionMatrix();
    }

    /* Moves the near plane as far away as possible, because depths have few digits. */
    function clip(rig) {
        const { camera, controls } = rig;
        const near = Math.max(0.02, camera.position.distanceTo(controls.target) - 3);
        if (Math.abs(near - camera.near) > 1e-3) {
            camera.near = near;
            camera.updateProjectionMatrix();
        }
    }

    function show(rig, points, view, rider) {
        rig.view = view;
        rig.rider = view === 'gripper' ? rider : null;
        rig.moved = false;
        rig.controls.enabled = view !== 'gripper';
        if (view === 'gripper') {
            widen(rig.camera, WIDTH_DEG);
            ride(rig);
            return;
        }
        const back = new THREE.Vector3(...VIEWS[view]).normalize();
        widen(rig.camera, view === 'whole' ? WIDTH_DEG : FLAT_DEG);
        const middle = rig.controls.target.set(0, 0, 0);
        const far = fit(rig.camera, points, middle, back);
        rig.camera.position.copy(middle).addScaledVector(back, AIR * far);
        rig.camera.lookAt(rig.controls.target);
        rig.controls.update();
    }

    /* Places the eye behind and above the gripper, looking in the direction in which it enters. */
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

    function resize(rig, points, width, height) {
        rig.camera.aspect = width / height;
        rig.camera.updateProjectionMatrix();
        if (!rig.moved && rig.view !== 'gripper') {
            show(rig, points, rig.view, null);
        }
    }

    W.camera = { make, corners };
}(window.Waferhand));
