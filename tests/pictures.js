// SPDX-License-Identifier: MIT
// What the pages of tests/three, tests/playcanvas and tests/babylon share: numbers, and how two pictures differ.

let state = 1;

/// Begins the random numbers anew.
export function seed(number) { state = number; }

export function random(low, high) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return low + (high - low) * state / 2 ** 32;
}

/// What a canvas shows, in the task that has drawn it.
export function pixels_of(canvas) {
    const {width, height} = canvas;
    const context = new OffscreenCanvas(width, height).getContext('2d', {willReadFrequently: true});
    context.drawImage(canvas, 0, 0);
    return context.getImageData(0, 0, width, height).data;
}

/// The greatest difference of a byte, how many pixels differ, how bright the first picture is, and whether their sizes
/// differ.
export function difference(a, b) {
    let most = 0, pixels = 0, sum = 0;
    for (let i = 0; i < a.length; i += 4) {
        const apart = Math.max(...[0, 1, 2, 3].map(c => Math.abs(a[i + c] - b[i + c])));
        most = Math.max(most, apart);
        pixels += apart !== 0 ? 1 : 0;
        sum += a[i] + a[i + 1] + a[i + 2];
    }
    return {most, pixels, mean: sum / (a.length * 3 / 4), length: a.length - b.length};
}
