// SPDX-License-Identifier: MIT
// A model in three.js under moving point and spot lights. By itself the page shows 5,000 of them; pictures.mjs calls
// window.stage. An address with #still draws nothing until it is called.
import {load} from 'lightbin';
import {ClusteredLights} from 'lightbin/three';
import * as THREE from 'three';
import {Lit} from '/scene.js';
import {difference} from '/tests/pictures.js';

const renderer = new THREE.WebGLRenderer({preserveDrawingBuffer: true});
document.body.append(renderer.domElement);

class Stage extends Lit {
    renderer = renderer;
    clusters_made = 0;

    async start() {
        this.lightbin = await load();
        await this.furnish();
        this.resize(320, 200);
    }

    resize(width, height) {
        renderer.setSize(width, height);
        renderer.setViewport(0, 0, width, height);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
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
