// SPDX-License-Identifier: MIT
// A model under moving point and spot lights, which the pages for three.js' two renderers show.
import * as THREE from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {random, seed} from '/tests/pictures.js';

export class Lit {
    THREE = THREE;
    scene = new THREE.Scene();
    camera = new THREE.PerspectiveCamera(60, 1, 0.1, 200);
    other = new THREE.OrthographicCamera(-12, 12, 8, -8, 0.5, 60);
    lamps = [];

    async furnish() {
        const {scene: model} = await new GLTFLoader().loadAsync('/tests/fixtures/nova.glb');
        model.traverse(object => { if (object.isLight) object.visible = false; });
        const box = new THREE.Box3().setFromObject(model), size = box.getSize(new THREE.Vector3());
        model.scale.setScalar(24 / Math.max(size.x, size.y, size.z));
        box.setFromObject(model);
        model.position.sub(box.getCenter(new THREE.Vector3()));
        const ground = new THREE.Mesh(new THREE.PlaneGeometry(60, 60),
            new THREE.MeshStandardMaterial({roughness: 0.6}));
        ground.rotation.x = -Math.PI / 2;
        ground.position.y = -5;
        ground.receiveShadow = true;
        const balls = new THREE.Group(), sphere = new THREE.SphereGeometry(0.9, 24, 16);
        for (let i = 0; i < 12; ++i) {
            const ball = new THREE.Mesh(sphere, new THREE.MeshPhysicalMaterial(
                {color: new THREE.Color().setHSL(i / 12, 0.6, 0.6), metalness: i % 3 / 2, roughness: 0.2 + i / 16,
                 clearcoat: 0.1 + i / 16, clearcoatRoughness: 0.1}));
            ball.position.setFromCylindricalCoords(9, i * Math.PI / 6, -4);
            ball.castShadow = true;
            balls.add(ball);
        }
        this.model = model;
        this.scene.add(model, ground, balls, new THREE.AmbientLight(0xffffff, 0.05));
        this.camera.position.set(6, 5, 17);
        this.camera.lookAt(0, -2, 0);
        this.other.position.set(0, 20, 10);
        this.other.lookAt(0, 0, 0);
    }

    draw(camera = this.camera) {
        this.renderer.render(this.scene, camera);
        return this.pixels();
    }

    /// A camera of what two eyes see, each in its viewport, as WebXR draws it.
    eyes(...viewports) {
        const both = new THREE.ArrayCamera(viewports.map((viewport, i) => {
            const eye = new THREE.PerspectiveCamera(70 + 10 * i, 1, 0.1, 150);
            eye.position.set(5.6 + i, 5 - i, 16);
            eye.lookAt(2 * i, -2, 0);
            eye.updateMatrixWorld();
            eye.viewport = new THREE.Vector4(...viewport);
            return eye;
        }));
        both.position.set(6, 5, 17);
        both.lookAt(0, -2, 0);
        return both;
    }

    /// Puts `points` and `spots` lights in the place of those that there are.
    lights(points, spots, {range = 4} = {}) {
        seed(1);
        for (const lamp of this.lamps) {
            this.scene.remove(lamp);
            if (lamp.target) this.scene.remove(lamp.target);
            lamp.dispose();
        }
        this.lamps = [];
        for (let i = 0; i < points + spots; ++i) {
            const color = new THREE.Color().setHSL(random(0, 1), 0.9, 0.6), strength = random(2, 8) * range / 4;
            const distance = i % 97 === 96 ? 0 : random(0.5, 1) * range;
            const lamp = i < points ? new THREE.PointLight(color, strength, distance, 2)
                : new THREE.SpotLight(color, 3 * strength, 2 * distance, random(0.2, 1), random(0, 1), random(1, 2));
            if (distance === 0) lamp.intensity *= 0.01;
            lamp.position.set(random(-14, 14), random(-5, 3), random(-14, 14));
            lamp.userData.home = lamp.position.clone();
            if (lamp.target) {
                lamp.target.position.copy(lamp.position).add(new THREE.Vector3(random(-1, 1), -1, random(-1, 1)));
                this.scene.add(lamp.target);
            }
            this.scene.add(lamp);
            this.lamps.push(lamp);
        }
    }

    move(seconds) {
        this.lamps.forEach((lamp, i) => {
            const {home} = lamp.userData;
            lamp.position.set(home.x + Math.sin(seconds + i), home.y, home.z + Math.cos(seconds + i));
            lamp.target?.position.set(lamp.position.x, home.y - 1, lamp.position.z + 0.5);
        });
    }
}
