// SPDX-License-Identifier: MIT
import {Lighting} from 'three/webgpu';
import type {Grid, Lightbin} from './lightbin.js';
import type {ClusteredLightsOptions} from './three.js';

/**
 * Lights the materials of three.js' WebGPURenderer, with WebGPU and with WebGL 2, by the point and spot lights of a
 * scene, in any number: `renderer.lighting = new ClusteredLighting(await load())`. Lights that cast shadows or have a
 * map or a colorNode, and those of classes that derive from PointLight and SpotLight, stay three.js' own.
 *
 * Each picture has lists of its own, pictures within pictures, too. Where it can't make lists, it makes one list of all
 * lights, and console.warn() says why, once for each cause. An ArrayCamera's picture has one list of all lights.
 *
 * While a picture begins, `scene.onBeforeRender` is wrapped. A renderer needs a ClusteredLighting of its own.
 */
export class ClusteredLighting extends Lighting {
    constructor(lightbin: Lightbin, options?: Omit<ClusteredLightsOptions, 'masks'>);
    /** The lists of the last picture. Where they are one list of all lights, they are those of a viewport of one
     * pixel. */
    readonly grid: Grid;
    /** Frees all memory and textures. Give the renderer another `lighting` before its next picture. */
    dispose(): void;
}
