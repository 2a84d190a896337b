// SPDX-License-Identifier: MIT
// Scenes of Babylon.js beside each other, under the same moving lights. By itself the page shows 2,900 lights with
// Babylon's own container and with lightbin's; pictures.mjs makes stages of its own. An address with #still draws
// nothing until then.
import {FreeCamera} from '@babylonjs/core/Cameras/freeCamera.js';
import {Constants} from '@babylonjs/core/Engines/constants.js';
import {Engine} from '@babylonjs/core/Engines/engine.js';
import {ShaderStore} from '@babylonjs/core/Engines/shaderStore.js';
import {WebGPUEngine} from '@babylonjs/core/Engines/webgpuEngine.js';
import {ClusteredLightContainer} from '@babylonjs/core/Lights/Clustered/clusteredLightContainer.js';
import {HemisphericLight} from '@babylonjs/core/Lights/hemisphericLight.js';
import {PointLight} from '@babylonjs/core/Lights/pointLight.js';
import {SpotLight} from '@babylonjs/core/Lights/spotLight.js';
import {PBRMaterial} from '@babylonjs/core/Materials/PBR/pbrMaterial.js';
import {Effect} from '@babylonjs/core/Materials/effect.js';
import {ShaderMaterial} from '@babylonjs/core/Materials/shaderMaterial.js';
import {StandardMaterial} from '@babylonjs/core/Materials/standardMaterial.js';
import {RawTexture} from '@babylonjs/core/Materials/Textures/rawTexture.js';
import {RenderTargetTexture} from '@babylonjs/core/Materials/Textures/renderTargetTexture.js';
import {Color3, Color4} from '@babylonjs/core/Maths/math.color.js';
import {Matrix, Vector3} from '@babylonjs/core/Maths/math.vector.js';
import {Viewport} from '@babylonjs/core/Maths/math.viewport.js';
import {CreateGround} from '@babylonjs/core/Meshes/Builders/groundBuilder.js';
import {CreateSphere} from '@babylonjs/core/Meshes/Builders/sphereBuilder.js';
import {Scene} from '@babylonjs/core/scene.js';
import {load} from 'lightbin';
import {ClusteredLights} from 'lightbin/babylon';
import {difference, pixels_of, random, seed} from '/tests/pictures.js';

const lightbin = await load();

/// lightbin's container, with shaders that loop over all its lights.
class AllLights extends ClusteredLights {
    prepareLightSpecificDefines(defines, index) {
        super.prepareLightSpecificDefines(defines, index);
        defines.LIGHTBIN_ALL = this.lights.filter(light => light.isEnabled()).length;
    }
}

/// Gives the shaders that loop.
function loopOverAll() {
    const loops = [
        [ShaderStore.IncludesShadersStore, /(lightbin_for_each_light\([^{]*)\{([^;]*)lightbinAt\.id/g,
         'for (uint lightbinAt=0u; lightbinAt<uint(LIGHTBIN_ALL); ++lightbinAt)'],
        [ShaderStore.IncludesShadersStoreWGSL, /(var lightbinAt=.*while [^{]*)\{([^;]*)lightbinAt\.id/g,
         'for (var lightbinAt=0u; lightbinAt<LIGHTBIN_ALL; lightbinAt++)'],
    ];
    for (const [store, what, loop] of loops) {
        let changed = 0;
        for (const name in store) {
            const text = store[name].replace(what, (match, lists, light) =>
                `\n#ifdef LIGHTBIN_ALL\n${loop} {${light}lightbinAt\n#else\n${match}\n#endif\n`);
            changed += text !== store[name] ? 1 : 0;
            store[name] = text;
        }
        if (changed !== 2) throw new Error(`there are ${changed} loops over the masks`);
    }
}
let loops = false;

/// One scene on a canvas of its own. Its `kind` is 'own' (Babylon's container), 'lists' (lightbin's), or 'all':
/// lightbin's with every light in every fragment.
class Stage {
    lamps = [];

    constructor(kind) { this.kind = kind; }

    /// scale         of the scene and its lights
    /// orthographic  whether the camera is
    /// pbr           'standard', 'gltf' or 'physical': materials with that falloff in place of StandardMaterial
    async start({width = 320, height = 200, scale = 1, orthographic = false, rightHanded = false, pbr, webgpu = false,
                 largeWorld = 0, reversedDepth = false, disableUniformBuffers = false} = {}) {
        const figure = document.body.appendChild(document.createElement('figure'));
        const canvas = figure.appendChild(document.createElement('canvas'));
        this.caption = figure.appendChild(document.createElement('figcaption'));
        Object.assign(canvas, {width, height});
        const options = {disableUniformBuffers, useLargeWorldRendering: largeWorld > 0};
        this.engine = webgpu ? new WebGPUEngine(canvas, options) : new Engine(canvas, false, options);
        if (webgpu) await this.engine.initAsync();
        this.engine.useReverseDepthBuffer = reversedDepth;
        const scene = this.scene = new Scene(this.engine);
        this.scale = scale;
        this.origin = new Vector3(largeWorld, 0, largeWorld);
        scene.useRightHandedSystem = rightHanded;
        scene.clearColor = new Color4(0, 0, 0, 1);
        new HemisphericLight('sky', Vector3.Up(), scene).intensity = 0.03;
        this.camera = this.eye([8, 10, 26], [0, -4, 0], {orthographic, aspect: width / height});
        this.surface = i => {
            const material = pbr ? new PBRMaterial('', scene) : new StandardMaterial('', scene);
            const colour = new Color3(0.6 + Math.sin(i) / 3, 0.7, 0.6 + Math.cos(i) / 3);
            if (pbr) Object.assign(material, {albedoColor: colour, metallic: i % 3 / 2, roughness: 0.3 + i / 20,
                usePhysicalLightFalloff: pbr === 'physical', useGLTFLightFalloff: pbr === 'gltf'});
            else Object.assign(material, {diffuseColor: colour, specularPower: 8 + 4 * i});
            if (pbr) material.clearCoat.isEnabled = i % 4 === 1;
            return material;
        };
        const ground = CreateGround('', {width: 80 * scale, height: 80 * scale}, scene);
        ground.position = this.place(0, -5, 0);
        ground.material = this.surface(0);
        this.meshes = [ground];
        for (let i = 0; i < 12; ++i) {
            const ball = CreateSphere('', {diameter: 1.8 * scale}, scene), angle = i * Math.PI / 6;
            ball.position = this.place(9 * Math.sin(angle), -4, 9 * Math.cos(angle));
            ball.material = this.surface(i);
            this.meshes.push(ball);
        }
        const Container = {own: ClusteredLightContainer, lists: ClusteredLights, all: AllLights}[this.kind];
        if (Container === ClusteredLightContainer) this.container = new Container('lamps', [], scene);
        else this.container = new Container(lightbin, 'lamps', [], scene);
        if (this.kind === 'all' && !loops) {
            loopOverAll();
            loops = true;
        }
        return this;
    }

    place(x, y, z) { return new Vector3(x, y, z).scaleInPlace(this.scale).addInPlace(this.origin); }

    eye(from, to, {orthographic, aspect = 1.6}) {
        const {scale} = this, camera = new FreeCamera('', this.place(...from), this.scene);
        Object.assign(camera, {minZ: 0.1 * scale, maxZ: 200 * scale});
        camera.setTarget(this.place(...to));
        if (orthographic) Object.assign(camera, {
            mode: 1, orthoTop: 9 * scale, orthoBottom: -9 * scale, orthoLeft: -9 * aspect * scale,
            orthoRight: 9 * aspect * scale});
        return camera;
    }

    resize(width, height) { this.engine.setSize(width, height); }

    /// Puts `points` and `spots` lights, mixed, in the place of those that there are. `wide` says whether some shine in
    /// more than half of all directions, which in Babylon's own container have no end in StandardMaterial.
    lights(points, spots, {range = 4, extent = 14, strength = 1, wide = false} = {}) {
        seed(1);
        for (const lamp of this.lamps) this.remove(lamp);
        const {scene, scale} = this, total = points + spots;
        this.lamps = Array.from({length: total}, (_, i) => {
            const at = this.place(random(-extent, extent), random(-4.5, 0), random(-extent, extent));
            const axis = new Vector3(random(-1, 1), random(-1, -0.3), random(-1, 1));
            const angle = random(0.5, 2) + (wide && i % 10 === 9 ? 2.7 : 0), exponent = random(0, 3);
            const is_spot = Math.floor((i + 1) * spots / total) > Math.floor(i * spots / total);
            const lamp = is_spot ? new SpotLight('', at, axis, angle, exponent, scene, true)
                : new PointLight('', at, scene, true);
            if (is_spot) lamp.innerAngle = angle * random(0.2, 0.9);
            lamp.home = at;
            lamp.range = random(0.5, 1) * range * (is_spot ? 1.5 : 1) * scale;
            lamp.diffuse = new Color3(random(0.2, 1), random(0.2, 1), random(0.2, 1));
            lamp.specular = lamp.diffuse;
            lamp.intensity = strength * random(0.5, 1.5);
            this.container.addLight(lamp);
            return lamp;
        });
        return this.changed();
    }

    /// Tells the materials of another number of lights, which AllLights has in its shaders.
    changed() {
        this.container._markMeshesAsLightDirty();
        return this;
    }

    remove(lamp) {
        this.container.removeLight(lamp);
        lamp.dispose();
    }

    move(seconds) {
        this.lamps.forEach((lamp, i) => {
            lamp.position = lamp.home.add(new Vector3(Math.sin(seconds + i), 0, Math.cos(seconds + i))
                .scaleInPlace(this.scale));
        });
        return this;
    }

    render() {
        this.engine.beginFrame();
        this.scene.render();
        this.engine.endFrame();
    }

    async draw() {
        await this.scene.whenReadyAsync();
        this.render();
        return pixels_of(this.engine.getRenderingCanvas());
    }

    /// Another picture of the scene, by another camera to a texture.
    async drawTarget(camera, width, height) {
        const target = new RenderTargetTexture('', {width, height}, this.scene);
        Object.assign(target, {activeCamera: camera, renderList: this.meshes});
        this.scene.customRenderTargets.push(target);
        await this.draw();
        const pixels = await target.readPixels();
        this.scene.customRenderTargets.pop();
        target.dispose();
        return pixels;
    }

    destroy() {
        this.scene.dispose();
        this.engine.dispose();
        this.caption.parentNode.remove();
    }
}

/// What the program of docs/babylon.md uses.
const names = {Constants, Effect, Matrix, RawTexture, ShaderMaterial, lightbin};

Object.assign(window, {Stage, ClusteredLights, ShaderStore, Viewport, names, lightbin, difference});
if (location.hash !== '#still') {
    const stages = [new Stage('own'), new Stage('lists')], captions = {own: "Babylon's own", lists: 'lightbin'};
    for (const stage of stages) {
        await stage.start({width: Math.floor(innerWidth / 2) - 8, height: Math.floor(0.8 * innerHeight)});
        stage.lights(2000, 900, {range: 1.5});
        stage.caption.textContent = captions[stage.kind];
    }
    const frame = milliseconds => {
        for (const stage of stages) stage.move(milliseconds / 1000).render();
        requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
}
