// SPDX-License-Identifier: MIT
// Clustered lights for three.js' WebGLRenderer: the point and spot lights of a scene, in any number, in its own
// materials.
// three.d.ts describes what is exported.
import {
    DataTexture, FloatType, NearestFilter, RedIntegerFormat, RGBAFormat, RGIntegerFormat, ShaderChunk, UnsignedIntType,
    Vector3, Vector4,
} from 'three';
import {text} from './three_text.js';

// A light has 16 floats, four texels of a texture of this width:
// view-space x, y, z, range for the lists | red, green, blue, decay | direction x, y, z, cone's cosine | penumbra's
// cosine, three.js' distance (0 without an end), 1 for spots
const light_floats = 16, lights_per_row = 256, ids_per_row = 2048;

const declarations = `${text}
uniform highp sampler2D lightbin_lights;
vec4 lightbin_texel( uint light, uint texel ) {
    return texelFetch( lightbin_lights, ivec2( light % ${lights_per_row}u * 4u + texel,
        light / ${lights_per_row}u ), 0 );
}
`;

// What three.js does for its own lights, in the same order.
const loop = `
#ifdef RE_Direct
lightbin_for_each_light( lightbinAt, uvec2( gl_FragCoord.xy ), vViewPosition.z ) {
    vec4 lightbinPlace = lightbin_texel( lightbinAt.id, 0u ), lightbinColor = lightbin_texel( lightbinAt.id, 1u );
    vec4 lightbinCone = lightbin_texel( lightbinAt.id, 2u ), lightbinMore = lightbin_texel( lightbinAt.id, 3u );
    vec3 lightbinTo = lightbinPlace.xyz - geometryPosition;
    directLight.direction = normalize( lightbinTo );
    directLight.color = lightbinColor.rgb;
    if ( lightbinMore.z != 0.0 )
        directLight.color *= getSpotAttenuation( lightbinCone.w, lightbinMore.x, - dot( directLight.direction,
            lightbinCone.xyz ) );
    directLight.color *= getDistanceAttenuation( length( lightbinTo ), lightbinMore.y, lightbinColor.a );
    directLight.visible = directLight.color != vec3( 0.0 );
    if ( directLight.visible )
        RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material,
            reflectedLight );
}
#endif
`;

const own_layers = Symbol('the mask of a light whose layers are empty for three.js');
const taken_in = Symbol('the number of the update that last took the light');
const patched_by = Symbol('the ClusteredLights that a material reads');

let made = 0;  // how many ClusteredLights there were

const is_lit = material => material.isMeshStandardMaterial || material.isMeshPhongMaterial
    || material.isMeshLambertMaterial || material.isMeshToonMaterial;

export class ClusteredLights {
    #lightbin;
    #options;
    #binner;
    #view;
    #slices;
    #slices_of = '';
    #floats;
    #taken = [];
    #materials = new Set();
    #updates = 0;
    #key = `lightbin ${++made}`;
    #viewport = new Vector4();
    #place = new Vector3();
    #target = new Vector3();
    #uniforms = {
        lightbin_grid: {value: new Uint32Array(4)}, lightbin_corner: {value: new Int32Array(2)},
        lightbin_tiles: {value: null}, lightbin_lists: {value: null}, lightbin_slices: {value: null},
        lightbin_lights: {value: null},
    };

    constructor(lightbin, {tileSize = 32, slices = 24, firstSlice, depthTest = 'box', footprint = 'rectangle',
                           ...others} = {}) {
        for (const key in others)
            throw new Error(`options: there is no '${key}', but tileSize, slices, firstSlice, depthTest, footprint`);
        this.#lightbin = lightbin;
        this.#options = {tileSize, slices, firstSlice};
        this.#binner = lightbin.binner({slicing: 'clusters', depthTest, footprint});
        this.#floats = lightbin.floats(light_floats * lights_per_row);
        this.update = this.update.bind(this);
    }

    update(renderer, scene, camera) {
        ++this.#updates;
        const points = [], spots = [], before = this.#taken;
        this.#taken = [];
        this.#collect(scene, camera.layers.mask, points, spots);
        for (const light of before) if (light[taken_in] !== this.#updates) this.#giveBack(light);

        const count = points.length + spots.length, rows = Math.max(Math.ceil(count / lights_per_row), 1);
        if (rows * lights_per_row * light_floats > this.#floats.length)
            this.#floats.resize(2 * rows * lights_per_row * light_floats);
        const {elements} = camera.matrixWorldInverse;
        points.forEach((light, i) => this.#write(light, i, camera));
        spots.forEach((light, i) => this.#write(light, points.length + i, camera, elements));

        renderer.getCurrentViewport(this.#viewport);
        const {x, y, z: width, w: height} = this.#viewport;
        const projection = {projection: camera.projectionMatrix.elements, width, height,
                            clipDepth: camera.reversedDepth ? 'zero-to-one' : 'minus-one-to-one',
                            reversedZ: camera.reversedDepth === true};
        if (this.#view === undefined)
            this.#view = this.#lightbin.view({...projection, tileSize: this.#options.tileSize});
        else
            this.#view.update(projection);
        this.#slice(renderer);

        const {array} = this.#floats, end = light_floats * points.length;
        const grid = this.grid = this.#binner.bin(this.#view, {
            spheres: {array, stride: light_floats, count: points.length},
            spots: {array: array.subarray(end), stride: light_floats, count: spots.length, axis: 8, cosine: 11},
        }, {slices: this.#slices});

        const uniforms = this.#uniforms, {tilesX, tilesY} = grid;
        const constants = this.#view.shaderGrid(x, y);
        uniforms.lightbin_grid.value = constants.subarray(0, 4);
        uniforms.lightbin_corner.value = new Int32Array(constants.buffer, 16, 2);
        // The whole rows of the texture are uploaded. What lies behind the ids in the module's memory is never read.
        const id_rows = 2 ** Math.ceil(Math.log2(Math.max(grid.ids.length / ids_per_row, 1)));
        this.#upload(renderer, uniforms.lightbin_tiles, grid.ranges, Math.max(tilesX, 1),
            Math.max(tilesY * grid.slices, 1),
                     RGIntegerFormat, 'RG32UI', 2);
        this.#upload(renderer, uniforms.lightbin_lists, grid.ids, ids_per_row, id_rows, RedIntegerFormat, 'R32UI', 1);
        this.#upload(renderer, uniforms.lightbin_lights, this.#floats.array, 4 * lights_per_row,
                     this.#floats.length / (light_floats * lights_per_row), RGBAFormat, 'RGBA32F', 4);
    }

    dispose() {
        this.#taken.forEach(light => this.#giveBack(light));
        this.#taken = [];
        for (const {value} of Object.values(this.#uniforms)) value?.dispose?.();
        for (const made of [this.#binner, this.#view, this.#slices, this.#floats]) made?.dispose();
        for (const material of this.#materials) {
            material[patched_by]();
            delete material[patched_by];
            material.needsUpdate = true;
        }
        this.#materials.clear();
    }

    /// Finds the lights that are to be seen and take no part in three.js' own lighting, and the materials to patch.
    #collect(object, layers, points, spots) {
        if (!object.visible) return;
        if (object.isLight) {
            const is_point = object.isPointLight === true;
            if (is_point || object.isSpotLight) {
                if (object.castShadow || object.map) {
                    if (object[own_layers] !== undefined) this.#giveBack(object);
                } else {
                    // The mask is empty unless the program has set it since.
                    if (object.layers.mask !== 0) object[own_layers] = object.layers.mask;
                    object.layers.mask = 0;
                    object[taken_in] = this.#updates;
                    this.#taken.push(object);
                    if ((object[own_layers] & layers) !== 0) (is_point ? points : spots).push(object);
                }
            }
        } else if (object.material !== undefined) {
            if (Array.isArray(object.material))
                object.material.forEach(material => this.#patch(material));
            else
                this.#patch(object.material);
        }
        for (const child of object.children) this.#collect(child, layers, points, spots);
    }

    #giveBack(light) {
        if (light.layers.mask === 0 && light[own_layers] !== undefined) light.layers.mask = light[own_layers];
        delete light[own_layers];
        delete light[taken_in];
    }

    #write(light, i, camera, view) {
        const {array} = this.#floats, at = light_floats * i, {color, intensity, distance} = light;
        const place = this.#place.setFromMatrixPosition(light.matrixWorld);
        if (view !== undefined) {
            const axis = this.#target.setFromMatrixPosition(light.target.matrixWorld).sub(place)
                .transformDirection(camera.matrixWorldInverse);
            array[at + 8] = axis.x;
            array[at + 9] = axis.y;
            array[at + 10] = axis.z;
            array[at + 11] = Math.cos(light.angle);
            array[at + 12] = Math.cos(light.angle * (1 - light.penumbra));
        }
        place.applyMatrix4(camera.matrixWorldInverse);
        array[at] = place.x;
        array[at + 1] = place.y;
        array[at + 2] = place.z;
        array[at + 3] = distance > 0 ? distance : Infinity;
        array[at + 4] = color.r * intensity;
        array[at + 5] = color.g * intensity;
        array[at + 6] = color.b * intensity;
        array[at + 7] = light.decay;
        array[at + 13] = distance;
        array[at + 14] = view !== undefined ? 1 : 0;
    }

    /// Makes the slices again if the camera's planes have changed.
    #slice(renderer) {
        const {nearDepth, farDepth, orthographic} = this.#view.info, {slices: count, firstSlice} = this.#options;
        const key = `${nearDepth} ${farDepth} ${orthographic}`;
        if (key === this.#slices_of) return;
        const last = Math.min(farDepth, Math.max(nearDepth, 0.001) * 1e5);
        const first = Math.min(firstSlice ?? Math.sqrt(nearDepth * last) / 4, last / 2);
        const slices = orthographic ? this.#lightbin.linearSlices({count, begin: nearDepth, end: farDepth})
            : this.#lightbin.exponentialSlices({count, first: Math.max(first, nearDepth), last});
        this.#slices?.dispose();
        this.#slices = slices;
        this.#slices_of = key;
        const words = slices.shaderWords();
        this.#upload(renderer, this.#uniforms.lightbin_slices, words, words.length, 1, RedIntegerFormat, 'R32UI', 1);
    }

    /// Uploads now, while `data` is the module's memory, to a texture that is made again if its size has changed.
    #upload(renderer, uniform, data, width, height, format, internalFormat, channels) {
        let texture = uniform.value;
        if (texture === null || texture.image.width !== width || texture.image.height !== height) {
            texture?.dispose();
            texture = uniform.value = new DataTexture(null, width, height, format,
                internalFormat === 'RGBA32F' ? FloatType : UnsignedIntType);
            texture.internalFormat = internalFormat;
            texture.minFilter = texture.magFilter = NearestFilter;
        }
        const length = width * height * channels;
        if (data.length !== length) {
            const whole = data.byteOffset + 4 * length <= data.buffer.byteLength;
            const own = whole ? undefined : new data.constructor(length);
            own?.set(data);
            data = own ?? new data.constructor(data.buffer, data.byteOffset, length);
        }
        texture.image.data = data;
        texture.needsUpdate = true;
        renderer.initTexture(texture);
    }

    /// Makes a material of three.js read the lists, after what else the program does to its shader.
    #patch(material) {
        if (material[patched_by] !== undefined || !is_lit(material)) return;
        const {onBeforeCompile, customProgramCacheKey} = material, uniforms = this.#uniforms, key = this.#key;
        material.onBeforeCompile = function(shader, renderer) {
            onBeforeCompile.call(this, shader, renderer);
            Object.assign(shader.uniforms, uniforms);
            const lit = ShaderChunk.lights_fragment_begin.replace(/#if \([^\n]*NUM_DIR_LIGHTS > 0 \|\|[^\n]*\n/,
                '#if 1\n')
                .replace(/#if \( NUM_SUN_LIGHTS > 0 \) && defined|#if \( NUM_DIR_LIGHTS > 0 \) && defined/,
                    match => loop + match);
            shader.fragmentShader = shader.fragmentShader
                .replace('#include <lights_pars_begin>', `#include <lights_pars_begin>\n${declarations}`)
                .replace('#include <lights_fragment_begin>', lit);
        };
        // three.js calls onBeforeCompile only for keys that the material did not have before.
        material.customProgramCacheKey = function() {
            return `${key} ${onBeforeCompile} ${customProgramCacheKey.call(this)}`;
        };
        material[patched_by] = () => Object.assign(material, {onBeforeCompile, customProgramCacheKey});
        material.needsUpdate = true;
        this.#materials.add(material);
    }
}
