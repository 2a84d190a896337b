// SPDX-License-Identifier: MIT
// Clustered lights for Babylon.js: a ClusteredLightContainer whose shaders read lightbin's masks.
// babylon.d.ts describes what is exported.
import {Constants} from '@babylonjs/core/Engines/constants.js';
import {ShaderStore} from '@babylonjs/core/Engines/shaderStore.js';
import {ClusteredLightContainer} from '@babylonjs/core/Lights/Clustered/clusteredLightContainer.js';
import {Light} from '@babylonjs/core/Lights/light.js';
import {RawTexture} from '@babylonjs/core/Materials/Textures/rawTexture.js';
import {Matrix} from '@babylonjs/core/Maths/math.vector.js';
import '@babylonjs/core/Shaders/ShadersInclude/lightFragmentDeclaration.js';
import '@babylonjs/core/Shaders/ShadersInclude/lightsFragmentFunctions.js';
import '@babylonjs/core/Shaders/ShadersInclude/lightUboDeclaration.js';
import '@babylonjs/core/Shaders/ShadersInclude/pbrClusteredLightingFunctions.js';
import '@babylonjs/core/ShadersWGSL/ShadersInclude/clusteredLightingCompute.js';
import '@babylonjs/core/ShadersWGSL/ShadersInclude/clusteredLightingFunctions.js';
import '@babylonjs/core/ShadersWGSL/ShadersInclude/lightUboDeclaration.js';
import '@babylonjs/core/ShadersWGSL/ShadersInclude/pbrClusteredLightingFunctions.js';
import {all_lights, update_slices, warner} from './adapters.js';
import * as texts from './babylon_text.js';

// A light has 20 floats, Babylon's own: position, exponent | diffuse, range | specular, radius | direction, cosine |
// range, 1 / range ** 2, scale and offset of the cone's angle.
const light_floats = 20, lights_per_row = 64;

/// lightbin's text, with the names of what light {X} has: Babylon puts its number there. The first lines, up to an
/// empty one, declare other names. Every material asks for textures of the names shadowTexture{X} and depthTexture{X},
/// and the container has no shadows.
const text_of = (text, grid) => text.slice(text.indexOf('\n\n')).replaceAll('lightbin_masks', 'shadowTexture{X}')
    .replaceAll('lightbin_slices', 'depthTexture{X}').replaceAll(/lightbin_grid(_block\.grid)?/g, grid);

const rows = [/(vec2u?)\((\d),index\)/g, `$1(index%${lights_per_row}*5+$2,index/${lights_per_row})`];
const loop_end = [/\}\s*batchOffset\+=CLUSTLIGHT_BATCH;\}/, '}'];
// PBR's physical falloff has no end. Here the range windows it, and the 1 % that it leaves at the side of a cone is the
// new 0.
const physical = '#ifdef USEPHYSICALLIGHTFALLOFF';
const falloff = [
    [/preInfo\.attenuation=computeDistanceLightFalloff\([^;]*;/, `$&
${physical}
preInfo.attenuation*=pow(max(1.0-pow(preInfo.lightDistanceSquared*light.vLightFalloff.y,2.0),0.0),2.0);
#endif
`],
    [/(preInfo\.attenuation\*=)(computeDirectionalLightFalloff\([^;]*\));/, `
${physical}
$1max($2-0.01,0.0)/0.99;
#else
$1$2;
#endif
`],
];

// What Babylon's shaders do, and what they do here, in each language and file. Shaders are kept by their defines, so
// the texts here are those for a define that Babylon's own container does not have.
const own_batch = 1;
const glsl_loop = [/ivec2 tilePosition=[^]*?(ClusteredLight light=getClusteredLight\(lightDataTexture,)[^;]*;/,
    'lightbin_for_each_light(lightbinAt,lightbin_pixel(),vViewDepth) {$1int(lightbinAt.id));'];
const glsl_names = ['uniform highp sampler2D tileMaskTexture{X};', `
#define LIGHTBIN_MASKS
#define tileMaskTexture{X} lightDataTexture{X}
uniform highp usampler2D shadowTexture{X};
uniform highp usampler2D depthTexture{X};
${text_of(texts.glsl, 'uvec4(light{X}.vLightData)')}
uvec2 lightbin_pixel() {return uvec2(gl_FragCoord.xy-light{X}.vSliceData);}
`];
const wgsl_loop = [/let tilePosition=[^]*?(let light=getClusteredLight\(lightDataTexture,)[^;]*;/,
    'var lightbinAt=lightbin_begin(lightbin_pixel(),fragmentInputs.vViewDepth);'
        + 'while lightbin_next(&lightbinAt) {$1lightbinAt.id);'];
const wgsl_names = ['var<storage,read> tileMaskBuffer{X}: array<u32>;', `
#define LIGHTBIN_MASKS
var shadowTexture{X}: texture_2d<u32>;
var depthTexture{X}: texture_2d<u32>;
${text_of(texts.wgsl, 'vec4u(light{X}.vLightData)')}
fn lightbin_pixel()->vec2u {return vec2u(fragmentInputs.position.xy-light{X}.vSliceData);}
`];
const changes = [
    [ShaderStore.IncludesShadersStore, {
        lightUboDeclaration: [glsl_names],
        lightFragmentDeclaration: [glsl_names],
        clusteredLightingFunctions: [rows],
        lightsFragmentFunctions: [glsl_loop, loop_end],
        pbrClusteredLightingFunctions: [glsl_loop, loop_end, ...falloff],
    }],
    [ShaderStore.IncludesShadersStoreWGSL, {
        lightUboDeclaration: [wgsl_names],
        clusteredLightingFunctions: [rows],
        clusteredLightingCompute: [wgsl_loop, loop_end],
        pbrClusteredLightingFunctions: [wgsl_loop, loop_end, ...falloff],
    }],
];

let change_shaders = () => {
    const changed = changes.flatMap(([store, files]) => Object.entries(files).map(([file, list]) =>
        [store, file, list.reduce((before, [what, by]) => {
            const after = before.replace(what, by);
            if (after === before)
                throw new Error(`this version of Babylon.js has other shaders: ${file} has no ${what}`);
            return after;
        }, store[file])]));
    for (const [store, file, text] of changed) {
        const condition = file.endsWith('Declaration') ? `CLUSTLIGHT_BATCH==${own_batch}` : 'defined(LIGHTBIN_MASKS)';
        store[file] = `#if ${condition}\n${text}\n#else\n${store[file]}\n#endif\n`;
    }
    change_shaders = () => {};
};

export class ClusteredLights extends ClusteredLightContainer {
    #lightbin;
    #binner;
    #view;
    #floats;
    #passes = [];  // of a frame, each with textures of its own, as WebGPU draws them all after the last upload
    #used = 0;     // how many there were in this frame
    #frame;
    #render;       // Babylon's number of the last pass
    #observer;
    #warn = warner("draws with all lights where it can't make masks");

    constructor(lightbin, name, lights, scene) {
        change_shaders();
        if (scene.lights.some(light => light instanceof ClusteredLightContainer))
            throw new Error('this scene has a ClusteredLightContainer');
        super(name, lights, scene);
        this.#lightbin = lightbin;
        this.#binner = lightbin.binner({slicing: 'z-bins'});
        this.#view = lightbin.view({...all_lights, width: 1, height: 1, tileSize: 32});
        this.#floats = lightbin.floats(light_floats * lights_per_row);
        this.#observer = scene.onBeforeRenderingGroupObservable.add(() => this.#update());
        this._tileMaskTexture.refreshRate = 0;
    }

    // What Babylon does for masks of its own.
    _updateBatches(camera) { return this._tileMaskTexture ?? super._updateBatches(camera); }
    _updateLightData() {}

    prepareLightSpecificDefines(defines, index) {
        super.prepareLightSpecificDefines(defines, index);
        defines.CLUSTLIGHT_BATCH = own_batch;
    }

    transferToEffect(effect, index) {
        const {grid, corner} = this.#passes[this.#used - 1];
        this._uniformBuffer.updateFloat4('vLightData', ...grid, index);
        this._uniformBuffer.updateFloat2('vSliceData', ...corner, index);
        return this;
    }

    transferTexturesToEffect(effect, index) {
        const {lights, masks, slices} = this.#passes[this.#used - 1].textures;
        effect.setTexture(`lightDataTexture${index}`, lights);
        effect.setTexture(`shadowTexture${index}`, masks);
        effect.setTexture(`depthTexture${index}`, slices);
        return this;
    }

    dispose(...given) {
        this._scene.onBeforeRenderingGroupObservable.remove(this.#observer);
        for (const {slices, textures} of this.#passes)
            for (const made of [slices, ...Object.values(textures)]) made?.dispose();
        for (const made of [this.#binner, this.#view, this.#floats]) made.dispose();
        super.dispose(...given);
    }

    /// Makes and uploads the masks of what Babylon draws now, before its first group of objects. Later, an upload would
    /// disturb the textures that it has bound.
    #update() {
        const scene = this._scene, engine = scene.getEngine(), frame = scene.getFrameId(), render = scene.getRenderId();
        if (this.#frame === frame && this.#render === render) return;
        if (this.#frame !== frame || !engine.isWebGPU) this.#used = 0;
        this.#frame = frame;
        this.#render = render;
        const pass = this.#passes[this.#used++] ??= {textures: {}}, {x, y, width, height} = engine.currentViewport;
        const columns = engine.getRenderWidth(), rows = engine.getRenderHeight();
        const lights = this.lights.filter(light => light.isEnabled() && !light.isDisposed());
        const origin = scene.floatingOriginOffset, count = lights.length, stride = light_floats;
        this.#write(lights, origin);
        const array = this.#floats;
        const size = {width: Math.trunc(width * columns), height: Math.trunc(height * rows)};
        try {
            this.#mask(pass, {
                ...size, projection: scene.getProjectionMatrix().m, reversedZ: engine.useReverseDepthBuffer,
                clipDepth: engine.isNDCHalfZRange ? 'zero-to-one' : 'minus-one-to-one',
            }, {
                viewMatrix: Matrix.Translation(origin.x, origin.y, origin.z).multiply(scene.getViewMatrix()).m,
                spots: {array, stride, count, centre: 0, radius: 16, axis: 12, cosine: 15},
            });
        } catch (error) {
            const radius = new Float32Array(count).fill(Infinity);
            this.#mask(pass, {...size, ...all_lights}, {spheres: {array, stride, count, centre: 0, radius}});
            this.#warn(error);
        }
        pass.grid = this.#view.gridConstants().subarray(0, 4);
        pass.corner = [Math.trunc(x * columns), Math.trunc(y * rows)];
        const data = array.array, texels = 5 * lights_per_row;
        this.#upload(pass, 'lights', {data, width: texels, height: data.length / (4 * texels)});
        this.#upload(pass, 'masks', this.masks.texels('words', 2048));
    }

    #mask(pass, view, lights) {
        this.#view.update(view);
        if (update_slices(this.#lightbin, pass, this.#view, {count: 128, least: 1e-30})) {
            const data = pass.slices.shaderWords();
            this.#upload(pass, 'slices', {data, width: data.length, height: 1});
        }
        this.masks = this.#binner.masks(this.#view, lights, {slices: pass.slices});
    }

    #write(lights, origin) {
        const rows = 2 ** Math.ceil(Math.log2(Math.max(lights.length / lights_per_row, 1)));
        if (rows * lights_per_row * light_floats > this.#floats.length)
            this.#floats.resize(rows * lights_per_row * light_floats);
        const {array} = this.#floats;
        lights.forEach((light, i) => {
            const moved = light.computeTransformedInformation(), intensity = light.getScaledIntensity();
            const {x, y, z} = moved ? light.transformedPosition : light.position, {diffuse, specular} = light;
            const range = Math.min(light.range, this.maxRange), at = light_floats * i;
            array.set([
                x - origin.x, y - origin.y, z - origin.z, 0,
                diffuse.r * intensity, diffuse.g * intensity, diffuse.b * intensity, range,
                specular.r * intensity, specular.g * intensity, specular.b * intensity, light.radius,
                0, 0, 0, -1, range, 1 / range ** 2, 0, 0], at);
            // The shader takes spots wider than half of all directions for points.
            if (light.getTypeID() !== Light.LIGHTTYPEID_SPOTLIGHT || light._cosHalfAngle < 0) return;
            const {exponent, _cosHalfAngle, _lightAngleScale, _lightAngleOffset} = light;
            array[at + 3] = exponent;
            (moved ? light.transformedDirection : light.direction).normalizeToNew().toArray(array, at + 12);
            array[at + 15] = _cosHalfAngle;
            array[at + 18] = _lightAngleScale;
            array[at + 19] = _lightAngleOffset;
        });
    }

    /// Uploads to a texture that is made again if its size has changed.
    #upload({textures}, name, {data, width, height}) {
        const size = textures[name]?.getSize();
        if (size?.width === width && size.height === height) return textures[name].update(data);
        textures[name]?.dispose();
        const [format, type] = name === 'lights' ? [Constants.TEXTUREFORMAT_RGBA, Constants.TEXTURETYPE_FLOAT]
            : [Constants.TEXTUREFORMAT_RED_INTEGER, Constants.TEXTURETYPE_UNSIGNED_INTEGER];
        textures[name] = new RawTexture(data, width, height, format, this._scene, false, false,
                                        Constants.TEXTURE_NEAREST_SAMPLINGMODE, type);
    }
}
