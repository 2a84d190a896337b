// SPDX-License-Identifier: MIT
// Clustered lights for three.js' WebGPURenderer: the point and spot lights of a scene, in any number, in its own
// materials, by three.js' public nodes alone.
// three_webgpu.d.ts describes what is exported.
import {
    DataTexture, FloatType, Lighting, LightsNode, Matrix4, NodeUpdateType, NodeUtils, PointLight, RedIntegerFormat,
    RGBAFormat, RGIntegerFormat, SpotLight, UnsignedIntType, Vector4,
} from 'three/webgpu';
import {
    cameraViewMatrix, getDistanceAttenuation, If, ivec2, log2, Loop, positionView, renderGroup, screenCoordinate,
    smoothstep, texture, uint, uniform, uvec2, vec3, vec4,
} from 'three/tsl';
import {ListMaker, lights_per_row, option_names} from './three_lights.js';

// Of the textures, each with its number of channels.
const formats = {
    tiles: [2, Uint32Array, RGIntegerFormat, UnsignedIntType],
    lists: [1, Uint32Array, RedIntegerFormat, UnsignedIntType],
    lights: [4, Float32Array, RGBAFormat, FloatType],
};
const texels_per_row = 4 * lights_per_row;

const viewport = new Vector4(), in_world = new Matrix4();

// Light types that derive from these have nodes of their own.
const is_taken = light => (light.constructor === PointLight || light.constructor === SpotLight) && !light.castShadow
    && !light.map && !light.colorNode;

/// Whether it draws for several cameras, each with a view space of its own. Lights are then in world space.
const has_eyes = camera => camera.isArrayCamera && camera.cameras.length > 0;

function data_texture(name, height) {
    const [channels, Numbers, ...format] = formats[name];
    return new DataTexture(new Numbers(channels * texels_per_row * height), texels_per_row, height, ...format);
}

/// Texel number `at` of a texture.
const texel = (node, at) => node.load(ivec2(at.mod(uint(texels_per_row)), at.div(uint(texels_per_row))));

class ClusteredLightsNode extends LightsNode {
    #lighting;
    #others = [];
    #textures = {};
    // Where an object stays the same, three.js does not look at its textures anew, nor at uniforms but of this group.
    #grid = uniform(new Vector4()).setGroup(renderGroup);    // the viewport's corner, columns and rows of tiles
    #slices = uniform(new Vector4()).setGroup(renderGroup);  // of a depth: x * log2(depth) + y * depth + z, 0 to w
    #side = uniform(0).setGroup(renderGroup);                // of a tile, in pixels

    static get type() { return 'LightbinLightsNode'; }

    constructor(lighting) {
        super();
        this.#lighting = lighting;
        this.updateBeforeType = NodeUpdateType.RENDER;
        for (const name in formats) this.#textures[name] = texture(data_texture(name, 1));
    }

    customCacheKey() { return NodeUtils.hash(this.id, this.#lighting.version(), super.customCacheKey()); }
    get hasLights() { return true; }
    getBuiltinLights() { return this.#others; }

    setLights(lights) {
        this.#others = lights.filter(light => !is_taken(light));
        this.#lighting.make(lights.filter(is_taken));
        return super.setLights(lights);
    }

    updateBefore() {
        const {textures, grid, divided, side} = this.#lighting.picture();
        if (grid === undefined) return;  // renderer.compileAsync() draws nothing
        for (const name in formats) this.#textures[name].value = textures[name];
        this.#grid.value.copy(grid);
        this.#slices.value.copy(divided);
        this.#side.value = side;
    }

    setupLights(builder, nodes) {
        const {reflectedLight, positionView: position = positionView} = builder.context;
        const {tiles, lists, lights} = this.#textures, grid = this.#grid, slices = this.#slices;
        // These are declared here, as the loop adds to them.
        reflectedLight.directDiffuse.toStack();
        reflectedLight.directSpecular.toStack();
        super.setupLights(builder, nodes);
        const tile = uvec2(screenCoordinate.sub(grid.xy).div(this.#side).clamp(0, grid.zw.sub(1)));
        const depth = position.z.negate();
        const slice = uint(slices.x.mul(log2(depth)).add(slices.y.mul(depth)).add(slices.z).clamp(0, slices.w));
        const cell = slice.mul(uint(grid.w)).add(tile.y).mul(uint(grid.z)).add(tile.x);
        const list = texel(tiles, cell).xy.toVar();
        const to_view = (vector, w) => has_eyes(builder.camera) ? cameraViewMatrix.mul(vec4(vector, w)).xyz : vector;
        Loop({start: list.x, end: list.x.add(list.y), type: 'uint'}, ({i}) => {
            const id = texel(lists, i).x.toVar();
            const [place, color, cone, more] = [0, 1, 2, 3].map(k =>
                texel(lights, id.mul(uint(4)).add(uint(k))).toVar());
            const to = to_view(place.xyz, 1).sub(position).toVar(), lightDirection = to.normalize().toVar();
            const inCone = smoothstep(cone.w, more.x, lightDirection.dot(to_view(cone.xyz, 0)).negate());
            const lightColor = color.rgb.mul(more.z.equal(0).select(1, inCone)).mul(getDistanceAttenuation({
                lightDistance: to.length(), cutoffDistance: more.y, decayExponent: color.a})).toVar();
            If(lightColor.notEqual(vec3(0)).any(), () => {
                builder.lightsNode.setupDirectLight(builder, this, {lightDirection, lightColor});
            });
        });
    }
}

export class ClusteredLighting extends Lighting {
    #maker;
    #pictures = [];  // what materials read: in a picture, in a picture that is drawn within it, and so on
    #depth = 0;      // how many pictures are being drawn
    #version = 0;    // how often a texture was made
    #plain = new Lighting();

    constructor(lightbin, options = {}) {
        super();
        // The shader's formula of a slice rounds differently than the boundaries.
        this.#maker = new ListMaker(lightbin, options, {
            known: option_names.slice(1), origin: 'upper-left', margin: 2 ** -14});
    }

    createNode(lights = []) {
        return new ClusteredLightsNode({
            make: taken => this.#make(taken), picture: () => this.#picture(), version: () => this.#version,
        }).setLights(lights);
    }

    /// A Group that is drawn as if it were a scene has no onBeforeRender.
    getNode(scene) { return scene.isScene ? super.getNode(scene) : this.#plain.getNode(scene); }

    beginRender(scene) {
        ++this.#depth;
        const picture = this.#picture(), {onBeforeRender} = scene;
        // three.js calls this when matrices are current, and then setLights().
        if (scene.isScene)
            scene.onBeforeRender = (renderer, same, camera, ...others) => {
                scene.onBeforeRender = onBeforeRender;
                onBeforeRender.call(scene, renderer, same, camera, ...others);
                Object.assign(picture, {renderer, camera});
            };
        super.beginRender(scene);
    }

    finishRender(scene) {
        super.finishRender(scene);
        --this.#depth;
    }

    dispose() {
        super.dispose();
        for (const {floats, slices, textures} of this.#pictures)
            for (const made of [floats, slices, ...Object.values(textures)]) made?.dispose();
        this.#pictures = [];
        this.#maker.dispose();
    }

    #picture() {
        const at = Math.max(this.#depth - 1, 0);
        while (this.#pictures.length <= at) this.#pictures.push({textures: {}});
        return this.#pictures[at];
    }

    /// Makes the lists of the picture that begins.
    #make(lights) {
        const picture = this.#picture(), {renderer, camera} = picture;
        if (camera === undefined) return;
        picture.camera = undefined;
        const target = renderer.getRenderTarget();
        if (target !== null) viewport.copy(target.viewport);
        else renderer.getViewport(viewport).multiplyScalar(renderer.getPixelRatio());
        const {x, y, z, w} = viewport.floor();
        const upload = grid => {
            this.grid = grid;
            this.#upload(picture, 'tiles', grid.ranges);
            this.#upload(picture, 'lists', grid.ids);
            this.#upload(picture, 'lights', picture.floats.array);
        };
        if (has_eyes(camera))
            this.#maker.makeOne(picture, lights, in_world, upload);
        else
            this.#maker.make(picture, lights.filter(({isPointLight}) => isPointLight),
                lights.filter(({isSpotLight}) => isSpotLight), camera, z, w, upload);
        const {count, first, last, begin, end} = picture.range, per_octave = (count - 1) / Math.log2(last / first);
        const divided = begin === undefined ? [per_octave, 0, 1 - per_octave * Math.log2(first), count - 1]
            : [0, count / (end - begin), -begin * count / (end - begin), count - 1];
        Object.assign(picture, {
            divided: new Vector4(...divided), side: this.#maker.gridConstants[0],
            grid: new Vector4(x, y, this.grid.tilesX, this.grid.tilesY),
        });
    }

    /// A texture that is too small is made anew, and with it all that reads it: by another version.
    #upload({renderer, textures}, name, data) {
        const rows = Math.ceil(data.length / (formats[name][0] * texels_per_row));
        if (!(textures[name]?.image.height >= rows)) {
            textures[name]?.dispose();
            textures[name] = data_texture(name, 2 ** Math.ceil(Math.log2(Math.max(rows, 1))));
            ++this.#version;
        }
        textures[name].image.data.set(data);
        textures[name].needsUpdate = true;
        renderer.initTexture(textures[name]);
    }
}
