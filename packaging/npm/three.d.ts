// SPDX-License-Identifier: MIT
import type {Camera, Object3D, WebGLRenderer} from 'three';
import type {Grid, Lightbin, Masks} from './lightbin.js';

export interface ClusteredLightsOptions {
    /** Make masks with z-bins in place of lists, for up to about a thousand lights in view: they take less time to
     * make, and one texture whose size is the same for up to 1,024 lights. More lights make it larger. Default: false. */
    masks?: boolean;
    /** The side of a square tile in pixels. Default: 32. */
    tileSize?: number;
    /** The number of depth slices. Default: 24, with masks 128. */
    slices?: number;
    /** The view depth at which the first slice ends. Default: between the camera's near and far planes. */
    firstSlice?: number;
    /** Default: true, which makes shorter lists in more time. Masks have none. */
    depthTest?: boolean;
    /**
     * Lights without an end (`distance` 0) are drawn as three.js draws them with the distance at which their strongest
     * channel has fallen to the cutoff: (color * intensity / cutoff) ** (1 / decay). In lux, for intensities in
     * candela. Default: 0, which leaves them without an end, and in every list.
     */
    cutoff?: number;
}

/**
 * Lights three.js' own materials (MeshStandardMaterial, MeshPhysicalMaterial, and Phong, Lambert and Toon) by the point
 * and spot lights of a scene, in any number. Lights that cast shadows or have a map stay three.js' own.
 *
 * While a picture is drawn, `layers.test()` of the lights that are taken returns false, so that three.js passes them
 * by. A material reads the lists of the ClusteredLights that first met it. Where a program sets the material's
 * `onBeforeCompile` or `onBeforeRender`, it does so before that.
 */
export class ClusteredLights {
    constructor(lightbin: Lightbin, options?: ClusteredLightsOptions);
    /**
     * Begins a picture: makes the lists of a camera, or of each camera of an ArrayCamera, and uploads them. Matrices
     * must be current: `scene.onBeforeRender = lights.update` is a call at the right time, for each picture. The
     * picture ends when three.js calls `scene.onAfterRender`, which is wrapped until then, and at the latest with the
     * task. Pictures within pictures have lists of their own.
     *
     * Where it can't make lists, it makes one list of all lights, and console.warn() says why, once for each cause.
     */
    readonly update: (renderer: WebGLRenderer, scene: Object3D, camera: Camera) => void;
    /** The lists of the last update, or those of the last camera if this is an ArrayCamera. Where they are one list of
     * all lights, they are those of a viewport of one pixel. */
    readonly grid: Grid;
    /** With the option `masks`, what the last update made in place of `grid`. */
    readonly masks: Masks;
    /** Frees all memory and textures, and leaves lights and materials to three.js. update() then does nothing. */
    dispose(): void;
}
