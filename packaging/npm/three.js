// SPDX-License-Identifier: MIT
// Clustered lights for three.js' WebGLRenderer: the point and spot lights of a scene, in any number, in its own
// materials.
// three.d.ts describes what is exported.
import {
    DataTexture, FloatType, Layers, NearestFilter, RedIntegerFormat, RGBAFormat, RGIntegerFormat, ShaderChunk,
    UnsignedIntType, Vector4,
} from 'three';
import {light_floats, lights_per_row, ListMaker} from './three_lights.js';
import * as texts from './three_text.js';

const words_per_row = 2048;

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

const no_pixel = new Uint32Array(4);
const viewport = new Vector4();

/// The part of its target that three.js draws to by a camera. After a mirror's picture, the renderer reports the whole
/// target, though the viewport is again that of the ArrayCamera's camera. This has none while three.js draws what lies
/// behind glass, to a target of its own.
const viewport_of = ({renderer, several}, camera) =>
    several && camera?.viewport || renderer.getCurrentViewport(viewport);

export class ClusteredLights {
    #maker;
    #masks;
    #pictures = [];  // what materials read: in a picture, in a picture that is drawn within it, and so on
    #depth = 0;      // how many pictures are being drawn
    #camera;         // that of the object that three.js draws now
    #materials = new Set();
    #key = `lightbin ${++made}`;
    #uniforms = {};

    constructor(lightbin, options = {}) {
        this.#maker = new ListMaker(lightbin, options, {});
        this.#masks = options.masks;
        this.update = this.update.bind(this);
        for (const name of ['grid', 'viewport', ...Object.keys(formats)])
            this.#uniforms[`lightbin_${name}`] = Object.defineProperty({}, 'value', {get: () => this.#read(name)});
    }

    update(renderer, scene, camera) {
        if (this.#maker === undefined) return;  // after dispose()
        if (renderer.isWebGPURenderer) throw new Error('WebGPURenderer takes lightbin/three-webgpu in place of this');
        const picture = this.#begin(renderer, scene), points = [], spots = [];
        this.#patch(scene.overrideMaterial);
        this.#collect(scene, camera, points, spots);
        // three.js draws an ArrayCamera's picture camera by camera, each with all objects in that camera's viewport.
        picture.several = camera.isArrayCamera && camera.cameras.length > 0;
        picture.cameras = picture.several ? [...camera.cameras] : [camera];
        picture.cameras.forEach((each, i) => {
            const lists = picture.lists[i] ??= {textures: {}}, {z, w} = viewport_of(picture, each);
            lists.renderer = renderer;
            this.#maker.make(lists, points, spots, each, Math.trunc(z), Math.trunc(w),
                made => this.#upload(lists, made));
        });
    }

    dispose() {
        while (this.#depth > 0) this.#end();
        for (const {floats, slices, textures} of this.#pictures.flatMap(({lists}) => lists))
            for (const made of [floats, slices, ...Object.values(textures)]) made?.dispose();
        this.#pictures = [];
        this.#maker?.dispose();
        this.#maker = undefined;
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

    #upload(lists, made) {
        if (this.#masks) {
            this.masks = made;
            this.#write(lists, 'masks', made.texels('words', words_per_row));
        } else {
            this.grid = made;
            const tiles = made.texels('ranges', made.tilesX), ids = made.texels('ids', words_per_row);
            if (Math.max(tiles.height, ids.height) > lists.renderer.capabilities?.maxTextureSize)
                throw new Error('the clusters or the lists have more rows than a texture of this device');
            this.#write(lists, 'tiles', tiles);
            this.#write(lists, 'lists', ids);
        }
        if (lists.uploaded !== lists.slices) {
            const data = lists.slices.shaderWords();
            this.#write(lists, 'slices', {data, width: data.length, height: 1});
            lists.uploaded = lists.slices;
        }
        lists.grid = this.#maker.gridConstants;
        const data = lists.floats.array;
        this.#write(lists, 'lights', {data, width: 4 * lights_per_row,
                                      height: data.length / (light_floats * lights_per_row)});
    }

    /// Uploads now, as `data` may be the module's memory, to a texture that is made again if its size has changed.
    #write({renderer, textures}, name, {data, width, height}) {
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
        const text = this.#masks ? texts.masks : texts.lists;
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
