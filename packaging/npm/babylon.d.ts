// SPDX-License-Identifier: MIT
import {ClusteredLightContainer} from '@babylonjs/core/Lights/Clustered/clusteredLightContainer.js';
import type {Light} from '@babylonjs/core/Lights/light.js';
import type {Scene} from '@babylonjs/core/scene.js';
import type {Lightbin, Masks} from './lightbin.js';

/**
 * A ClusteredLightContainer whose lights are found by lightbin's masks: for any camera, scale and number of lights.
 * `addLight()`, `removeLight()`, `lights` and `maxRange` are Babylon's own. Its numbers of tiles and slices are not
 * read.
 *
 * A scene has one, and no other ClusteredLightContainer. An exception says so, or that this version of Babylon.js has
 * other shaders.
 */
export class ClusteredLights extends ClusteredLightContainer {
    constructor(lightbin: Lightbin, name: string, lights: Light[], scene: Scene);
    /** What the last picture's lights made: how many there are, which are bad input, and the masks. Ids count the
     * lights that are enabled, in the order of `lights`. */
    readonly masks: Masks;
}
