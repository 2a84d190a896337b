// SPDX-License-Identifier: MIT
// Clustered lights for three.js' WebGLRenderer: the point and spot lights of a scene, in any number, in its own
// materials.
// three.d.ts describes what is exported.
import {
    DataTexture, FloatType, Layers, NearestFilter, RedIntegerFormat, RGBAFormat, RGIntegerFormat, ShaderChunk,
    UnsignedIntType, Vector3, Vector4,
} from 'three';
import * as texts from './three_text.js';

// A light has 16 floats, four texels of a texture of this width:
// view-space x, y, z, range for the lists | red, green, blue, decay | direction x, y, z, cone's cosine | penumbra's
// cosine, three.js' distance (0 without an end), 1 for spots
const light_floats = 16, lights_per_row = 256, words_per_row = 2048;

const declarations = `
uniform highp sampler2D lightbin_lights;
uniform highp vec4 lightbin_viewport;
vec4 lightbin_texel( uint light, uint texel ) {
    return texelFetch( lightbin_lights, ivec2( light % ${lights_per_row}u * 4u + texel,
        light / ${lights_per_row}u ), 0 );
}
`;

// What three.js does for its own lights, in the same order.
const loop = `
#ifdef RE_Direct
lightbin_for_each_light( lightbinAt, uvec2( ( gl_FragCoord.xy - lightbin_viewport.xy ) * lightbin_viewport.zw ),
    vViewPosition.z ) {
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

const hidden_by = Symbol('the ClusteredLights that hides a light from three.js');
const patched_by = Symbol('the ClusteredLights that a material reads');

let made = 0;  // how many ClusteredLights there were

const is_taken = light => (light.isPointLight || light.isSpotLight) && !light.castShadow && !light.map;
const is_lit = material => material?.isMeshStandardMaterial || material?.isMeshPhongMaterial
    || material?.isMeshLambertMaterial || material?.isMeshToonMaterial;

// Of the textures, each with its number of channels.
const word = [RedIntegerFormat, 'R32UI', 1];
const formats = {
    slices: word, tiles: [RGIntegerFormat, 'RG32UI', 2], lists: word, masks: word, lights: [RGBAFormat, 'RGBA32F', 4],
};
/// The rows of a texture that has room for so many words. There are few numbers, so that it is seldom made again.
const rows_of = words => 2 ** Math.ceil(Math.log2(Math.max(words / words_per_row, 1)));

// Of a picture whose only tile lists all lights.
const one_pixel = {projection: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1], width: 1, height: 1,
                   clipDepth: 'minus-one-to-one', reversedZ: false};
const no_pixel = new Uint32Array(4);
const place = new Vector3(), axis = new Vector3(), viewport = new Vector4();

export class ClusteredLights {
    #lightbin;
    #options;
    #binner;
    #view;
    #pictures = [];  // what materials read: in a picture, in a picture that is drawn within it, and so on
    #depth = 0;      // how many pictures are being drawn
    #materials = new Set();
    #warnings = new Set();
    #key = `lightbin ${++made}`;
    #uniforms = {};

    constructor(lightbin, {masks = false, tileSize = 32, slices = masks ? 128 : 24, firstSlice, depthTest = !masks,
                           cutoff = 0, ...others} = {}) {
        for (const key in others)
            throw new Error(`options: there is no '${key}', but masks, tileSize, slices, firstSlice, depthTest,`
                + ' cutoff');
        if (masks && depthTest) throw new Error('options.depthTest: masks have no depth test');
        if (!(cutoff >= 0 && cutoff < Infinity)) throw new Error(`options.cutoff: ${cutoff} is not 0 or more`);
        this.#lightbin = lightbin;
        this.#options = {masks, slices, firstSlice, cutoff};
        this.#binner = lightbin.binner({slicing: masks ? 'z-bins' : 'clusters', depthTest});
        this.#view = lightbin.view({...one_pixel, tileSize});
        lightbin.linearSlices({count: slices, begin: 0, end: 1}).dispose();  // refuses a wrong number
        this.update = this.update.bind(this);
        for (const name of ['grid', 'viewport', ...Object.keys(formats)])
            this.#uniforms[`lightbin_${name}`] = Object.defineProperty({}, 'value', {get: () => this.#read(name)});
    }

    update(renderer, scene, camera) {
        if (this.#binner === undefined) return;  // after dispose()
        const picture = this.#begin(renderer, scene), points = [], spots = [];
        this.#patch(scene.overrideMaterial);
        this.#collect(scene, camera, points, spots);
        this.#write(picture, points, spots, camera);
        renderer.getCurrentViewport(viewport);
        try {
            if (camera.isArrayCamera) throw new Error('an ArrayCamera, as WebXR has, draws several pictures at once');
            this.#bin(picture, points.length, spots.length, {
                projection: camera.projectionMatrix.elements, width: Math.trunc(viewport.z),
                height: Math.trunc(viewport.w), clipDepth: camera.reversedDepth ? 'zero-to-one' : 'minus-one-to-one',
                reversedZ: camera.reversedDepth === true});
        } catch (error) {
            const {array} = picture.floats, count = points.length + spots.length;
            for (let i = 0; i < count; ++i) array[light_floats * i + 3] = Infinity;
            this.#bin(picture, count, 0, one_pixel);
            this.#warn(error);
        }
    }

    dispose() {
        while (this.#depth > 0) this.#end();
        for (const {floats, slices, textures} of this.#pictures)
            for (const made of [floats, slices, ...Object.values(textures)]) made?.dispose();
        this.#pictures = [];
        this.#binner?.dispose();
        this.#binner = undefined;
        this.#view.dispose();
        for (const material of this.#materials) {
            material[patched_by]();
            delete material[patched_by];
            material.needsUpdate = true;
        }
        this.#materials.clear();
    }

    /// Begins a picture, perhaps within another one. It ends when three.js calls scene.onAfterRender, or with the task
    /// if an exception has kept three.js from that.
    #begin(renderer, scene) {
        if (this.#depth === 0) queueMicrotask(() => { while (this.#depth > 0) this.#end(); });
        const outer = this.#pictures.slice(0, this.#depth), {onAfterRender} = scene;
        const picture = this.#pictures[this.#depth] ??= {
            floats: this.#lightbin.floats(light_floats * lights_per_row), textures: {}};
        ++this.#depth;
        Object.assign(picture, {renderer, scene, giveBack: undefined});
        if (scene.isScene && !outer.some(picture => picture.scene === scene)) {
            picture.giveBack = () => { scene.onAfterRender = onAfterRender; };
            scene.onAfterRender = (...given) => {
                this.#end();
                onAfterRender.apply(scene, given);
            };
        }
        return picture;
    }

    #end() { this.#pictures[--this.#depth].giveBack?.(); }

    /// The value of a uniform for what three.js draws now.
    #read(name) {
        const {renderer, grid, textures} = this.#pictures[Math.max(this.#depth - 1, 0)];
        if (name === 'grid') return this.#depth > 0 ? grid : no_pixel;
        if (name !== 'viewport') return textures[name];
        // Where the viewport begins, in pixels, of which WebGL drops fractions; and how many pixels of the lists one of
        // its pixels has: not 1 if the lists have one pixel, or while three.js draws what lies behind glass, which it
        // does to a smaller target.
        const {x, y, z, w} = renderer.getCurrentViewport(viewport);
        return viewport.set(Math.trunc(x), Math.trunc(y), grid[2] / Math.trunc(z), grid[3] / Math.trunc(w));
    }

    #warn({code, message}) {
        if (this.#warnings.has(code ?? message)) return;
        this.#warnings.add(code ?? message);
        console.warn(`lightbin draws with all lights where it can't make lists: ${message}`);
    }

    /// Finds the lights that the camera sees, hides them from three.js, and patches the materials.
    #collect(object, camera, points, spots) {
        if (!object.visible) return;
        // Shows one of the children, as three.js does later.
        if (object.isLOD && object.autoUpdate && object.layers.test(camera.layers)) object.update(camera);
        this.#patch(object.material);
        if (is_taken(object)) {
            this.#hide(object);
            if ((object.layers.mask & camera.layers.mask) !== 0) (object.isPointLight ? points : spots).push(object);
        }
        for (const child of object.children) this.#collect(child, camera, points, spots);
    }

    /// Makes a light's layers say that no camera sees it, while pictures are drawn. clone() and toJSON() copy the mask
    /// of the layers alone, so that copies are lights like any other.
    #hide(light) {
        const {layers} = light;
        if (layers[hidden_by] === this) return;
        layers[hidden_by] = this;
        layers.test = other => !(this.#depth > 0 && is_taken(light)) && Layers.prototype.test.call(layers, other);
    }

    #write({floats}, points, spots, {matrixWorldInverse}) {
        const rows = Math.ceil((points.length + spots.length) / lights_per_row);
        if (rows * lights_per_row * light_floats > floats.length)
            floats.resize(2 * rows * lights_per_row * light_floats);
        const {array} = floats;
        [...points, ...spots].forEach((light, i) => {
            const at = light_floats * i, {color, intensity, decay} = light, range = this.#range(light);
            place.setFromMatrixPosition(light.matrixWorld);
            if (light.isSpotLight) {
                axis.setFromMatrixPosition(light.target.matrixWorld).sub(place).transformDirection(matrixWorldInverse)
                    .toArray(array, at + 8);
                array[at + 11] = Math.cos(light.angle);
                array[at + 12] = Math.cos(light.angle * (1 - light.penumbra));
            }
            place.applyMatrix4(matrixWorldInverse).toArray(array, at);
            array[at + 3] = range;
            array[at + 4] = color.r * intensity;
            array[at + 5] = color.g * intensity;
            array[at + 6] = color.b * intensity;
            array[at + 7] = decay;
            array[at + 13] = range === Infinity ? 0 : range;
            array[at + 14] = light.isSpotLight ? 1 : 0;
        });
    }

    /// Where a light ends. One without an end has fallen to the cutoff there: color * intensity / range ** decay.
    #range({color: {r, g, b}, intensity, distance, decay}) {
        const {cutoff} = this.#options;
        if (distance > 0) return distance;
        if (cutoff === 0 || !(decay > 0)) return Infinity;
        return this.#lightbin.lightRange(Math.abs(Math.max(r, g, b) * intensity), cutoff) ** (2 / decay);
    }

    /// Makes the lists of point lights and of the spots that follow them, and uploads all that materials read.
    #bin(picture, points, spots, projection) {
        this.#view.update(projection);
        this.#slice(picture);
        const {array} = picture.floats, stride = light_floats;
        const given = [this.#view, {
            spheres: {array, stride, count: points},
            spots: {array: array.subarray(stride * points), stride, count: spots, axis: 8, cosine: 11},
        }, {slices: picture.slices}];
        if (this.#options.masks) this.#upload_masks(picture, this.masks = this.#binner.masks(...given));
        else this.#upload_lists(picture, this.grid = this.#binner.bin(...given));
        picture.grid = this.#view.gridConstants().subarray(0, 4);
        const floats = picture.floats.array;  // read anew, as the module's memory may have grown
        this.#upload(picture, 'lights', floats, 4 * lights_per_row, floats.length / (light_floats * lights_per_row));
    }

    #upload_masks(picture, {words, tilesX, tilesY}) {
        // The room for 1,024 lights, so that the texture stays the same for all numbers up to that.
        const room = 1 + 32 * (tilesX + tilesY + 33) + 2 * this.#options.slices;
        this.#upload(picture, 'masks', words, words_per_row, rows_of(Math.max(words.length, room)));
    }

    #upload_lists(picture, grid) {
        const tile_rows = Math.max(grid.tilesY * grid.slices, 1), id_rows = rows_of(grid.ids.length);
        if (Math.max(tile_rows, id_rows) > picture.renderer.capabilities?.maxTextureSize)
            throw new Error('the clusters or the lists have more rows than a texture of this device');
        this.#upload(picture, 'tiles', grid.ranges, Math.max(grid.tilesX, 1), tile_rows);
        this.#upload(picture, 'lists', grid.ids, words_per_row, id_rows);
    }

    /// Makes a picture's slices again if the camera's planes are others.
    #slice(picture) {
        const {nearDepth, farDepth, orthographic} = this.#view.info, {slices: count, firstSlice} = this.#options;
        const planes = `${nearDepth} ${farDepth} ${orthographic}`;
        if (planes === picture.planes) return;
        const last = Math.min(farDepth, Math.max(nearDepth, 0.001) * 1e5);
        const first = Math.min(firstSlice ?? Math.sqrt(nearDepth * last) / 4, last / 2);
        const slices = orthographic ? this.#lightbin.linearSlices({count, begin: nearDepth, end: farDepth})
            : this.#lightbin.exponentialSlices({count, first: Math.max(first, nearDepth), last});
        picture.slices?.dispose();
        Object.assign(picture, {slices, planes});
        const words = slices.shaderWords();
        this.#upload(picture, 'slices', words, words.length, 1);
    }

    /// Uploads now, while `data` is the module's memory, to a texture that is made again if its size has changed. Whole
    /// rows are uploaded: what lies behind the ids in the module's memory is never read.
    #upload({renderer, textures}, name, data, width, height) {
        const [format, internalFormat, channels] = formats[name];
        let texture = textures[name];
        if (texture?.image.width !== width || texture.image.height !== height) {
            texture?.dispose();
            texture = textures[name] = new DataTexture(null, width, height, format,
                internalFormat === 'RGBA32F' ? FloatType : UnsignedIntType);
            texture.internalFormat = internalFormat;
            texture.minFilter = texture.magFilter = NearestFilter;
        }
        const {buffer, byteOffset, constructor: Numbers} = data, length = width * height * channels;
        texture.image.data = byteOffset + 4 * length <= buffer.byteLength ? new Numbers(buffer, byteOffset, length)
            : Numbers.from({length}, (_, i) => data[i]);
        texture.needsUpdate = true;
        renderer.initTexture(texture);
    }

    /// Makes a material of three.js read the lists, after what else the program does to its shader.
    #patch(material) {
        if (Array.isArray(material)) return material.forEach(each => this.#patch(each));
        if (!is_lit(material) || material[patched_by] !== undefined) return;
        const {onBeforeCompile, customProgramCacheKey} = material, uniforms = this.#uniforms, key = this.#key;
        const text = this.#options.masks ? texts.masks : texts.lists;
        material.onBeforeCompile = function(shader, renderer) {
            onBeforeCompile.call(this, shader, renderer);
            Object.assign(shader.uniforms, uniforms);
            const lit = ShaderChunk.lights_fragment_begin.replace(/#if \([^\n]*NUM_DIR_LIGHTS > 0 \|\|[^\n]*\n/,
                '#if 1\n')
                .replace(/#if \( NUM_SUN_LIGHTS > 0 \) && defined|#if \( NUM_DIR_LIGHTS > 0 \) && defined/,
                    match => loop + match);
            shader.fragmentShader = shader.fragmentShader
                .replace('#include <lights_pars_begin>', `#include <lights_pars_begin>\n${text}${declarations}`)
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
