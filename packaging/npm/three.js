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

// Of the textures.
const word = [RedIntegerFormat, 'R32UI'];
const formats = {
    slices: word, tiles: [RGIntegerFormat, 'RG32UI'], lists: word, masks: word, lights: [RGBAFormat, 'RGBA32F'],
};

// Of a picture whose only tile lists all lights.
const one_pixel = {projection: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1], width: 1, height: 1,
                   clipDepth: 'minus-one-to-one', reversedZ: false};
const no_pixel = new Uint32Array(4);
const place = new Vector3(), axis = new Vector3(), viewport = new Vector4();

/// The part of its target that three.js draws to by a camera. After a mirror's picture, the renderer reports the whole
/// target, though the viewport is again that of the ArrayCamera's camera. This has none while three.js draws what lies
/// behind glass, to a target of its own.
const viewport_of = ({renderer, several}, camera) =>
    several && camera?.viewport || renderer.getCurrentViewport(viewport);

export class ClusteredLights {
    #lightbin;
    #options;
    #binner;
    #view;
    #pictures = [];  // what materials read: in a picture, in a picture that is drawn within it, and so on
    #depth = 0;      // how many pictures are being drawn
    #camera;         // that of the object that three.js draws now
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
        // three.js draws an ArrayCamera's picture camera by camera, each with all objects in that camera's viewport.
        picture.several = camera.isArrayCamera && camera.cameras.length > 0;
        picture.cameras = picture.several ? [...camera.cameras] : [camera];
        picture.cameras.forEach((each, i) => {
            const lists = picture.lists[i] ??= {
                floats: this.#lightbin.floats(light_floats * lights_per_row), textures: {}};
            lists.renderer = renderer;
            this.#write(lists, points, spots, each);
            this.#make(lists, points.length, spots.length, each, viewport_of(picture, each));
        });
    }

    #make(lists, points, spots, {projectionMatrix: {elements}, reversedDepth, far}, {z, w}) {
        try {
            this.#bin(lists, points, spots, {
                projection: elements, width: Math.trunc(z), height: Math.trunc(w),
                clipDepth: reversedDepth ? 'zero-to-one' : 'minus-one-to-one',
                // three.js looks down -z, also where an oblique near plane changes the sign of an orthographic z row.
                reversedZ: elements[10] > 0,
            }, far);
        } catch (error) {
            const {array} = lists.floats, count = points + spots;
            for (let i = 0; i < count; ++i) array[light_floats * i + 3] = Infinity;
            this.#bin(lists, count, 0, one_pixel);
            this.#warn(error);
        }
    }

    dispose() {
        while (this.#depth > 0) this.#end();
        for (const {floats, slices, textures} of this.#pictures.flatMap(({lists}) => lists))
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
        const picture = this.#pictures[this.#depth++] ??= {lists: []};
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
        const picture = this.#pictures[Math.max(this.#depth - 1, 0)];
        const {grid, textures} = picture.lists[Math.max(picture.cameras.indexOf(this.#camera), 0)];
        if (name === 'grid') return this.#depth > 0 ? grid : no_pixel;
        if (name !== 'viewport') return textures[name];
        // Where the viewport begins, in pixels, of which WebGL drops fractions; and how many pixels of the lists one of
        // its pixels has: not 1 if the lists have one pixel, or while three.js draws what lies behind glass, which it
        // does to a smaller target.
        const {x, y, z, w} = viewport_of(picture, this.#camera);
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
    #bin(lists, points, spots, projection, far) {
        this.#view.update(projection);
        this.#slice(lists, far);
        const {array} = lists.floats, stride = light_floats;
        const given = [this.#view, {
            spheres: {array, stride, count: points},
            spots: {array: array.subarray(stride * points), stride, count: spots, axis: 8, cosine: 11},
        }, {slices: lists.slices}];
        if (this.#options.masks) {
            this.masks = this.#binner.masks(...given);
            this.#upload(lists, 'masks', this.masks.texels('words', words_per_row));
        } else {
            this.#upload_lists(lists, this.grid = this.#binner.bin(...given));
        }
        lists.grid = this.#view.gridConstants().subarray(0, 4);
        const data = lists.floats.array;  // read anew, as the module's memory may have grown
        const width = 4 * lights_per_row, height = data.length / (light_floats * lights_per_row);
        this.#upload(lists, 'lights', {data, width, height});
    }

    #upload_lists(lists, grid) {
        const tiles = grid.texels('ranges', grid.tilesX), ids = grid.texels('ids', words_per_row);
        if (Math.max(tiles.height, ids.height) > lists.renderer.capabilities?.maxTextureSize)
            throw new Error('the clusters or the lists have more rows than a texture of this device');
        this.#upload(lists, 'tiles', tiles);
        this.#upload(lists, 'lists', ids);
    }

    /// Makes the slices again if the view has other depths. Those of an oblique near plane mostly have no end.
    #slice(lists, far = Infinity) {
        const {nearDepth, farDepth, orthographic} = this.#view.info, {slices: count, firstSlice} = this.#options;
        const near = Math.max(nearDepth, 0.001), last = Math.max(Math.min(farDepth, far, near * 1e5), near * 2);
        const first = Math.max(Math.min(firstSlice ?? Math.sqrt(near * last) / 4, last / 2), near);
        const range = orthographic ? {count, begin: nearDepth, end: farDepth} : {count, first, last};
        const key = JSON.stringify(range);
        if (key === lists.range) return;
        const slices = orthographic ? this.#lightbin.linearSlices(range) : this.#lightbin.exponentialSlices(range);
        lists.slices?.dispose();
        Object.assign(lists, {slices, range: key});
        const data = slices.shaderWords();
        this.#upload(lists, 'slices', {data, width: data.length, height: 1});
    }

    /// Uploads now, as `data` may be the module's memory, to a texture that is made again if its size has changed.
    #upload({renderer, textures}, name, {data, width, height}) {
        const [format, internalFormat] = formats[name];
        let texture = textures[name];
        if (texture?.image.width !== width || texture.image.height !== height) {
            texture?.dispose();
            texture = textures[name] = new DataTexture(null, width, height, format,
                internalFormat === 'RGBA32F' ? FloatType : UnsignedIntType);
            texture.internalFormat = internalFormat;
            texture.minFilter = texture.magFilter = NearestFilter;
        }
        texture.image.data = data;
        texture.needsUpdate = true;
        renderer.initTexture(texture);
    }

    /// Makes a material of three.js read the lists, after what else the program does to its shader.
    #patch(material) {
        if (Array.isArray(material)) return material.forEach(each => this.#patch(each));
        if (!is_lit(material) || material[patched_by] !== undefined) return;
        const {onBeforeCompile, onBeforeRender, customProgramCacheKey} = material, lights = this;
        const text = this.#options.masks ? texts.masks : texts.lists;
        material.onBeforeCompile = function(shader, renderer) {
            onBeforeCompile.call(this, shader, renderer);
            Object.assign(shader.uniforms, lights.#uniforms);
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
            return `${lights.#key} ${onBeforeCompile} ${customProgramCacheKey.call(this)}`;
        };
        material.onBeforeRender = function(renderer, scene, camera, ...others) {
            onBeforeRender.call(this, renderer, scene, camera, ...others);
            lights.#camera = camera;
        };
        material[patched_by] = () => Object.assign(material, {onBeforeCompile, onBeforeRender, customProgramCacheKey});
        material.needsUpdate = true;
        this.#materials.add(material);
    }
}
