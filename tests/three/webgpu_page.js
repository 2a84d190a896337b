// SPDX-License-Identifier: MIT
// A model in three.js' WebGPURenderer under moving point and spot lights. By itself the page shows 5,000 of them, with
// #webgl in WebGL 2; webgpu.mjs calls window.stage. An address with #still draws nothing until it is called.
import {load} from 'lightbin';
import {ClusteredLighting} from 'lightbin/three-webgpu';
import * as THREE from 'three/webgpu';
import {ClusteredLighting as OwnClusters} from 'three/addons/lighting/ClusteredLighting.js';
import {DynamicLighting} from 'three/addons/lighting/DynamicLighting.js';
import {Lit} from '/scene.js';
import {difference, pixels_of} from '/tests/pictures.js';

class Stage extends Lit {
    OwnClusters = OwnClusters;
    renderers = {};
    own_lighting = {};
    all_lights = {};

    async start() {
        this.lightbin = await load();
        await this.furnish();
    }

    /// Draws with a backend from now on, 'webgpu', 'webgl' or 'webgpu, reversed depth', by three.js' own lighting.
    async use(backend) {
        if (this.renderers[backend] === undefined) {
            const made = this.renderers[backend] = new THREE.WebGPURenderer({
                forceWebGL: backend === 'webgl', reversedDepthBuffer: /reversed/.test(backend)});
            await made.init();
            if (!made.backend[backend === 'webgl' ? 'isWebGLBackend' : 'isWebGPUBackend'])
                throw new Error(`there is no ${backend}`);
            this.own_lighting[backend] = made.lighting;
            this.all_lights[backend] = new DynamicLighting({maxPointLights: 500, maxSpotLights: 200});
        }
        this.backend = backend;
        this.renderer = this.renderers[backend];
        document.body.replaceChildren(this.renderer.domElement);
        this.resize(320, 200);
        this.own();
    }

    resize(width, height) {
        this.renderer.setSize(width, height);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
    }

    light(lighting) {
        const {lighting: before} = this.renderer;
        if (before instanceof ClusteredLighting) before.dispose();
        this.renderer.lighting = lighting;
    }
    own() { this.light(this.own_lighting[this.backend]); }
    /// Lights by all lights in every fragment, from arrays. There is one DynamicLighting, as three.js gives its shaders
    /// to others, too, with the arrays of the first.
    all() { this.light(this.all_lights[this.backend]); }
    cluster(options) { this.light(new ClusteredLighting(this.lightbin, options)); }

    pixels() { return pixels_of(this.renderer.domElement); }
}

const stage = new Stage();
await stage.start();
if (location.hash !== '#still') {
    await stage.use(location.hash === '#webgl' ? 'webgl' : 'webgpu');
    const fit = () => stage.resize(innerWidth, innerHeight);
    fit();
    addEventListener('resize', fit);
    stage.lights(3500, 1500, {range: 1.5});
    stage.cluster();
    stage.renderer.setAnimationLoop(milliseconds => {
        stage.move(milliseconds / 1000);
        stage.renderer.render(stage.scene, stage.camera);
    });
}
Object.assign(window, {stage, difference});
