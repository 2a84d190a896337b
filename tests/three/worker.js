// SPDX-License-Identifier: MIT
// A module worker, in which no import map holds: makes the lists of the lights that it is sent.
import {load} from '/lightbin/lightbin.js';

onmessage = async ({data: {options, view, spheres}}) => {
    const lightbin = await load(options), grid = lightbin.binner().bin(lightbin.view(view), {spheres});
    postMessage({simd: lightbin.simd, ranges: grid.ranges.slice(), ids: grid.ids.slice()});
};
