// SPDX-License-Identifier: MIT
// Applications of PlayCanvas beside each other, which draw the same scene under the same moving lights. By itself the
// page shows 5,000 lights with PlayCanvas' own clusters and with lightbin's lists; pictures.mjs makes stages of its own.
// An address with #still draws nothing until then.
import {load} from 'lightbin';
import {ClusteredLights} from 'lightbin/playcanvas';
import * as pc from 'playcanvas';
import {difference, pixels_of, random, seed} from '/tests/pictures.js';

const lightbin = await load();

/// One application. Its `kind` is 'own' (PlayCanvas' clusters), 'lists' (lightbin's), or 'all': every light in every
/// fragment, from the same texture of lights as 'lists'.
class Stage {
    lamps = [];
    milliseconds = [];  // that lists took in each frame, with all that is done for them alone

    constructor(kind) { this.kind = kind; }

    async start({width = 320, height = 200, deviceType = 'webgl2', model = true, depthTest} = {}) {
        const figure = document.body.appendChild(document.createElement('figure'));
        const canvas = figure.appendChild(document.createElement('canvas'));
        this.caption = figure.appendChild(document.createElement('figcaption'));
        const graphicsDevice = await pc.createGraphicsDevice(canvas, {deviceTypes: [deviceType], antialias: false});
        if (graphicsDevice.deviceType !== deviceType) throw new Error(`there is no ${deviceType}`);
        const app = this.app = new pc.Application(canvas, {graphicsDevice});
        app.autoRender = false;
        app.setCanvasFillMode(pc.FILLMODE_NONE, width, height);
        this.resize(width, height);
        if (this.kind !== 'own') this.clusters = new ClusteredLights(lightbin, app, {depthTest});
        if (this.kind === 'all') this.loopOverAll();
        const {lighting} = app.scene, allocator = app.renderer.worldClustersAllocator, {upload} = allocator;
        lighting.maxLights = 8190;  // as many as PlayCanvas has rows for, with the software renderer's textures
        lighting.shadowsEnabled = false;
        app.scene.ambientLight = new pc.Color(0.02, 0.02, 0.02);
        allocator.upload = (...given) => {
            const begin = performance.now();
            upload.apply(allocator, given);
            this.milliseconds.push(performance.now() - begin);
        };
        app.start();

        this.camera = this.eye({fov: 60, farClip: 300});
        this.camera.setPosition(8, 10, 26);
        this.camera.lookAt(0, -4, 0);
        this.material = this.surface({gloss: 0.6, metalness: 0.1});
        this.add('plane', [0, -5, 0], [80, 1, 80]);
        for (let i = 0; i < 12; ++i) {
            const angle = i * Math.PI / 6;
            this.add('sphere', [9 * Math.sin(angle), -4, 9 * Math.cos(angle)], [1.8, 1.8, 1.8], this.surface({
                diffuse: new pc.Color(0.5 + Math.sin(i) / 2, 0.6, 0.5 + Math.cos(i) / 2), gloss: i / 12,
                metalness: i % 3 / 2, clearCoat: i % 2 / 2}));
        }
        if (model) await this.loadModel();
        return this;
    }

    surface(properties) {
        const material = Object.assign(new pc.StandardMaterial(), {useMetalness: true, ...properties});
        material.update();
        return material;
    }

    entity(component, options) {
        const entity = new pc.Entity('', this.app);
        entity.addComponent(component, options);
        this.app.root.addChild(entity);
        return entity;
    }

    eye(options) { return this.entity('camera', {nearClip: 0.5, clearColor: pc.Color.BLACK, ...options}); }

    add(type, position, scale, material = this.material, layers = [pc.LAYERID_WORLD]) {
        const entity = this.entity('render', {type, material, layers});
        entity.setPosition(...position);
        entity.setLocalScale(...scale);
        return entity;
    }

    async loadModel() {
        const asset = new pc.Asset('nova', 'container', {url: '/tests/fixtures/nova.glb'});
        this.app.assets.add(asset);
        const loaded = new Promise((resolve, reject) => {
            asset.ready(resolve);
            asset.once('error', reject);
        });
        this.app.assets.load(asset);
        await loaded;
        const model = asset.resource.instantiateRenderEntity(), box = new pc.BoundingBox();
        for (const light of model.findComponents('light')) light.enabled = false;
        model.findComponents('render').flatMap(({meshInstances}) => meshInstances)
            .forEach(({aabb}, i) => i === 0 ? box.copy(aabb) : box.add(aabb));
        const scale = 12 / Math.max(box.halfExtents.x, box.halfExtents.y, box.halfExtents.z);
        model.setLocalScale(scale, scale, scale);
        model.setPosition(box.center.clone().mulScalar(-scale));
        this.app.root.addChild(model);
    }

    /// Makes the shader loop over all lights in the order of their numbers.
    loopOverAll() {
        for (const language of [pc.SHADERLANGUAGE_GLSL, pc.SHADERLANGUAGE_WGSL]) {
            const chunks = pc.ShaderChunks.get(this.app.graphicsDevice, language);
            const is_glsl = language === pc.SHADERLANGUAGE_GLSL, text = chunks.get('clusteredLightPS');
            const count = is_glsl ? 'uint(numClusteredLights)' : 'u32(uniform.numClusteredLights)';
            const all = text.replace(/= lightbin_begin;[^;]*;/, `= 0u; lightbin_at + 1u < ${count};`)
                .replace('lightbin_word(lightbin_at)', 'lightbin_at');
            if (all === text) throw new Error('there is no loop over the lists');
            chunks.set('clusteredLightPS', all);
        }
    }

    resize(width, height) { this.app.setCanvasResolution(pc.RESOLUTION_FIXED, width, height); }

    /// Puts `points` and then `spots` lights in the place of those that there are, over a square of 2 `extent` a side.
    lights(points, spots, {range = 4, extent = 14, strength = 1} = {}) {
        seed(1);
        for (const lamp of this.lamps) lamp.destroy();
        this.lamps = [];
        for (let i = 0; i < points + spots; ++i) {
            const outer = random(15, 60), is_spot = i >= points;
            const lamp = this.entity('light', {
                type: is_spot ? 'spot' : 'omni', range: random(0.5, 1) * range * (is_spot ? 2 : 1),
                color: new pc.Color(random(0.2, 1), random(0.2, 1), random(0.2, 1)),
                intensity: strength * random(0.5, 1.5), outerConeAngle: outer, innerConeAngle: outer * random(0.2, 0.9),
                falloffMode: i % 3 === 0 ? pc.LIGHTFALLOFF_INVERSESQUARED : pc.LIGHTFALLOFF_LINEAR,
            });
            lamp.home = new pc.Vec3(random(-extent, extent), random(-4.5, 1), random(-extent, extent));
            lamp.setPosition(lamp.home);
            lamp.setEulerAngles(random(-60, 60), 0, random(-60, 60));
            this.lamps.push(lamp);
        }
        return this;
    }

    move(seconds) {
        this.lamps.forEach((lamp, i) => {
            const {x, y, z} = lamp.home;
            lamp.setPosition(x + Math.sin(seconds + i), y, z + Math.cos(seconds + i));
        });
        return this;
    }

    render() {
        this.app.update(0);
        this.app.render();
    }

    draw() {
        this.render();
        return pixels_of(this.app.graphicsDevice.canvas);
    }

    /// The WorldClusters of the layers that were drawn.
    get drawn() { return [...new Set(this.app.renderer.worldClustersAllocator._allocated)]; }

    destroy() {
        this.app.destroy();
        this.clusters?.dispose();
    }
}

const median = list => list.toSorted((a, b) => a - b)[list.length >> 1];

Object.assign(window, {pc, Stage, ClusteredLights, lightbin, difference, median});
if (location.hash !== '#still') {
    const stages = [new Stage('own'), new Stage('lists')], names = {own: "PlayCanvas' own clusters", lists: 'lightbin'};
    for (const stage of stages) {
        await stage.start({width: Math.floor(innerWidth / 2) - 8, height: Math.floor(0.8 * innerHeight)});
        stage.lights(3500, 1500, {range: 1.5});
    }
    const frame = milliseconds => {
        for (const stage of stages) {
            stage.move(milliseconds / 1000).render();
            if (stage.milliseconds.length < 60) continue;
            const lists = median(stage.milliseconds.splice(0)).toFixed(2);
            stage.caption.textContent = `${names[stage.kind]}: ${lists} ms`;
        }
        requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
}
