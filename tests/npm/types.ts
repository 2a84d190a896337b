// SPDX-License-Identifier: MIT
// What lightbin.d.ts allows and refuses; compiled, never run.
import {load} from 'lightbin';

export async function use(gl: WebGL2RenderingContext) {
    const lightbin = await load({simd: false});
    const view = lightbin.view({projection: new Float32Array(16), width: 1, height: 2, clipDepth: 'zero-to-one'});
    view.update({tileSize: 8});
    const binner = lightbin.binner({slicing: 'clusters', depthTest: true});
    const lamps = lightbin.floats(16), slices = lightbin.exponentialSlices({count: 3, first: 1, last: 2});
    const spheres = {array: lamps, stride: 16, centre: 0, radius: [1, 2, 3]};
    const grid = binner.bin(view, {viewMatrix: [1], spheres, boxes: {centre: null}}, {slices});
    gl.bufferData(gl.ARRAY_BUFFER, grid.ids, gl.STREAM_DRAW);
    gl.bufferData(gl.ARRAY_BUFFER, binner.masks(view, {spheres}).words, gl.STREAM_DRAW);
    const [x, y, depth] = view.project([1, 2, 3]), {data, width} = grid.texels('ids', 64);
    gl.bufferData(gl.ARRAY_BUFFER, grid.append(grid).ids, x + y + slices.at(depth) + width);
    gl.bufferData(gl.ARRAY_BUFFER, data, view.unproject([x, y, depth])[2] + view.depths(0, 1)[1]);
    console.log(await lightbin.dump(grid, view, {spheres}, {slices}));
    console.log(await lightbin.viewText(view), view.windowDepth([0, 0, depth]), lightbin.lightRange(1, 2));
    // @ts-expect-error
    grid.texels('words', 64);
    // @ts-expect-error
    grid.append([grid]);
    const {text, bindings} = await lightbin.shader({language: 'essl-300', slots: {lists: {binding: 1}}});
    gl.bufferData(gl.ARRAY_BUFFER, view.shaderEdges(), gl.STREAM_DRAW);
    binner.bin(view, {spheres}, {bounds: {max: [1]}});
    await lightbin.cullShader({language: 'wgsl', pass: 'fill', slots: {lists: {binding: 1}}});
    // @ts-expect-error
    await lightbin.cullShader({language: 'wgsl', pass: 'draw'});
    const room = {lights: 1, entries: 2, slices};
    const {passes} = await lightbin.planCull(view, {language: 'wgsl', slicing: 'clusters'}, room);
    for (const {pass} of passes) await lightbin.cullShader({language: 'wgsl', pass, slicing: 'clusters'});
    // @ts-expect-error
    await lightbin.cullShader({language: 'wgsl', kind: 'tube'});
    // @ts-expect-error
    lightbin.view({projection: [1], width: 1, height: 2, clipDepth: 'webgpu'});
    // @ts-expect-error
    lightbin.view({width: 1, height: 2});
    // @ts-expect-error
    binner.bin(view, {spheres: {array: lamps, color: 3}});
    // @ts-expect-error
    grid.tilesX = 3;
    return text + bindings[0].webgpuFormat;
}
