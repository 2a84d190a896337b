// SPDX-License-Identifier: MIT
import type {AppBase} from 'playcanvas';
import type {Grid, Lightbin} from './lightbin.js';

export interface ClusteredLightsOptions {
    /** Makes shorter lists, in some three times the time. Default: false. */
    depthTest?: boolean;
}

/**
 * Makes the lists of PlayCanvas' clustered lighting from then on, in each frame that the application draws, and without
 * its limits: any number of lights, and of lights in a cell. All that reads the lights of a cell reads them as before:
 * materials, all cameras and layers, shadows, cookies. `scene.lighting.cells` counts the cells as ever; `maxLights` and
 * `maxLightsPerCell` are not read.
 *
 * With WebGL 2 and WebGPU. One for each application, before its first frame: shaders that were made before would read
 * the lists of PlayCanvas.
 */
export class ClusteredLights {
    constructor(lightbin: Lightbin, app: AppBase, options?: ClusteredLightsOptions);
    /**
     * The lists that were made last: one for each cell, x + cells.x * (z + cells.z * y). Ids are less by one than the
     * indices in the `usedLights` of the WorldClusters.
     */
    readonly grid: Grid;
    /** Frees the module's memory, after the application's own destroy(). */
    dispose(): void;
}
