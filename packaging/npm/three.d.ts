// SPDX-License-Identifier: MIT
import type {Camera, Object3D, WebGLRenderer} from 'three';
import type {Grid, Lightbin} from './lightbin.js';

export interface ClusteredLightsOptions {
    /** The side of a square tile in pixels. Default: 32. */
    tileSize?: number;
    /** The number of depth slices. Default: 24. */
    slices?: number;
    /** The view depth at which the first slice ends. Default: between the camera's near and far planes. */
    firstSlice?: number;
    /** Default: 'box', which makes shorter lists in more time. */
    depthTest?: 'no-depth-test' | 'box';
    footprint?: 'rectangle' | 'silhouette';
}

/**
 * Lights three.js' own materials (MeshStandardMaterial, MeshPhysicalMaterial, and Phong, Lambert and Toon) by the point
 * and spot lights of a scene, in any number. Lights that cast shadows or have a map stay three.js' own.
 *
 * Lights that are taken have empty layers, so that three.js passes them by; setting a light's layers works as usual.
 * A material reads the lists of the ClusteredLights that first met it. Where a program sets `onBeforeCompile`, it does
 * so before that.
 */
export class ClusteredLights {
    constructor(lightbin: Lightbin, options?: ClusteredLightsOptions);
    /**
     * Makes the lists of a camera and uploads them, for the next picture that is drawn of it. Matrices must be current:
     * `scene.onBeforeRender = lights.update` is a call at the right time, once for each camera.
     */
    readonly update: (renderer: WebGLRenderer, scene: Object3D, camera: Camera) => void;
    /** The lists of the last update. */
    readonly grid: Grid;
    /** Frees all memory and textures, and leaves lights and materials as they were. */
    dispose(): void;
}
