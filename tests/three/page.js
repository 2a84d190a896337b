// SPDX-License-Identifier: MIT
// A model in three.js under moving point and spot lights. By itself the page shows 5,000 of them; pictures.mjs calls
// window.stage. An address with #still draws nothing until it is called.
import {load} from 'lightbin';
import {ClusteredLights} from 'lightbin/three';
import * as THREE from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {difference, random, seed} from '/tests/pictures.js';

const renderer = new THREE.WebGLRenderer({preserveDrawingBuffer: true});
document.body.append(renderer.domElement);

class Stage {
    THREE = THREE;
    renderer = renderer;
    scene = new THREE.Scene();
    camera = new THREE.PerspectiveCamera(60, 1, 0.1, 200);
    other = new THREE.OrthographicCamera(-12, 12, 8, -8, 0.5, 60);
    lamps = [];
    clusters_made = 0;

    async start() {
        this.lightbin = await load();
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
        this.resize(320, 200);
    }

    resize(width, height) {
        renderer.setSize(width, height);
        renderer.setViewport(0, 0, width, height);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
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

    cluster(options) {
        if (this.clusters === undefined) ++this.clusters_made;
        this.clusters ??= new ClusteredLights(this.lightbin, options);
        this.scene.onBeforeRender = this.clusters.update;
    }
    own() {
        this.clusters?.dispose();
        this.clusters = undefined;
        this.scene.onBeforeRender = () => {};
    }

    /// Makes the materials loop over all of `count` lights, from the same texture, until they are own() again.
    all(count) {
        const materials = new Set();
        this.scene.traverse(({material}) => material?.isMeshStandardMaterial && materials.add(material));
        for (const material of materials) {
            const lists = material.onBeforeCompile;
            material.onBeforeCompile = function(shader, renderer) {
                lists.call(this, shader, renderer);
                const text = shader.fragmentShader.replace(/\nlightbin_for_each_light\([^{]*\{/,
                    `\nfor (lightbin_cursor lightbinAt = lightbin_cursor(0u, 0u, 0u); lightbinAt.id < ${count}u;
                        lightbinAt.id += 1u) {`);
                if (text === shader.fragmentShader) throw new Error('there is no loop over the lists');
                shader.fragmentShader = text;
            };
            material.customProgramCacheKey = () => `${stage.clusters_made}, ${count} in every fragment`;
            material.needsUpdate = true;
        }
    }

    draw(camera = this.camera) {
        renderer.render(this.scene, camera);
        return this.pixels();
    }

    pixels() {
        const gl = renderer.getContext(), {drawingBufferWidth: width, drawingBufferHeight: height} = gl;
        const pixels = new Uint8Array(4 * width * height);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
        return pixels;
    }
}

const stage = new Stage();
await stage.start();
if (location.hash !== '#still') {
    stage.resize(innerWidth, innerHeight);
    addEventListener('resize', () => stage.resize(innerWidth, innerHeight));
    stage.lights(3500, 1500, {range: 1.5});
    stage.cluster();
    renderer.setAnimationLoop(milliseconds => {
        stage.move(milliseconds / 1000);
        renderer.render(stage.scene, stage.camera);
    });
}
Object.assign(window, {stage, difference});
