// SPDX-License-Identifier: MIT
// What the adapters for three.js' two renderers share: they make the lists of a scene's lights in a camera's picture.
import {Vector3, WebGPUCoordinateSystem} from 'three';
import {all_lights, update_slices, warner} from './adapters.js';

// A light has 16 floats, four texels of a texture:
// view-space x, y, z, range for the lists | red, green, blue, decay | direction x, y, z, cone's cosine | penumbra's
// cosine, three.js' distance (0 without an end), 1 for spots
export const light_floats = 16, lights_per_row = 256;

export const option_names = ['masks', 'tileSize', 'slices', 'firstSlice', 'depthTest', 'cutoff'];

// A picture whose only tile lists all lights.
const one_pixel = {...all_lights, width: 1, height: 1};
const place = new Vector3(), axis = new Vector3();

export class ListMaker {
    #lightbin;
    #options;
    #margin;
    #binner;
    #view;
    #warn = warner("draws with all lights where it can't make lists");

    /// known   the names of the options that there are
    /// margin  of the slices
    constructor(lightbin, options, {known = option_names, origin = 'lower-left', margin = 0}) {
        for (const key in options)
            if (!known.includes(key)) throw new Error(`options: there is no '${key}', but ${known.join(', ')}`);
        const {masks = false, tileSize = 32, slices = masks ? 128 : 24, firstSlice, depthTest = !masks, cutoff = 0}
            = options;
        if (masks && depthTest) throw new Error('options.depthTest: masks have no depth test');
        if (!(cutoff >= 0 && cutoff < Infinity)) throw new Error(`options.cutoff: ${cutoff} is not 0 or more`);
        this.#lightbin = lightbin;
        this.#options = {masks, slices, firstSlice, cutoff};
        this.#margin = margin;
        this.#binner = lightbin.binner({slicing: masks ? 'z-bins' : 'clusters', depthTest});
        this.#view = lightbin.view({...one_pixel, tileSize, origin});
        lightbin.linearSlices({count: slices, begin: 0, end: 1}).dispose();  // refuses a wrong number
    }

    get gridConstants() { return this.#view.gridConstants().subarray(0, 4); }

    /// Makes the lists, or masks, of a camera's picture, and calls upload() with them: with one list of all lights if
    /// it can't, or if upload() throws.
    /// lists  an object that holds what is made for a picture: `floats` with the points and the spots that follow them,
    ///        `slices`, and the `range` that these divide
    make(lists, points, spots, camera, width, height, upload) {
        const {matrixWorldInverse, projectionMatrix: {elements}, coordinateSystem, reversedDepth, far} = camera;
        this.#write(lists, [...points, ...spots], matrixWorldInverse);
        try {
            upload(this.#bin(lists, points.length, spots.length, {
                projection: elements, width, height,
                clipDepth: reversedDepth || coordinateSystem === WebGPUCoordinateSystem ? 'zero-to-one'
                    : 'minus-one-to-one',
                // three.js looks down -z, also where an oblique near plane changes the sign of an orthographic z row.
                reversedZ: elements[10] > 0,
            }, far));
        } catch (error) {
            this.makeOne(lists, [...points, ...spots], matrixWorldInverse, upload);
            this.#warn(error);
        }
    }

    /// Makes one list of all lights, in the space of a matrix.
    makeOne(lists, lights, matrix, upload) {
        this.#write(lists, lights, matrix);
        const {array} = lists.floats;
        for (let i = 0; i < lights.length; ++i) array[light_floats * i + 3] = Infinity;
        upload(this.#bin(lists, lights.length, 0, one_pixel));
    }

    dispose() {
        this.#binner.dispose();
        this.#view.dispose();
    }

    #write(lists, lights, matrixWorldInverse) {
        const row = lights_per_row * light_floats, rows = Math.ceil(lights.length / lights_per_row);
        lists.floats ??= this.#lightbin.floats(row);
        if (rows * row > lists.floats.length) lists.floats.resize(2 * rows * row);
        const {array} = lists.floats;
        lights.forEach((light, i) => {
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

    #bin(lists, points, spots, projection, far) {
        this.#view.update(projection);
        const {slices: count, firstSlice} = this.#options;
        update_slices(this.#lightbin, lists, this.#view, {count, least: 0.001, far, firstSlice, margin: this.#margin});
        const {array} = lists.floats, stride = light_floats;
        const given = [this.#view, {
            spheres: {array, stride, count: points},
            spots: {array: array.subarray(stride * points), stride, count: spots, axis: 8, cosine: 11},
        }, {slices: lists.slices}];
        return this.#options.masks ? this.#binner.masks(...given) : this.#binner.bin(...given);
    }
}
