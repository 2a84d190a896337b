// SPDX-License-Identifier: MIT
// node tests/npm/module.mjs PACKAGE LISTS: tests the npm package in the folder PACKAGE: it makes the same bytes as this
// machine's library, whose lists `native` wrote to the file LISTS, in both modules; what it refuses is a sentence; it
// frees what it allocates; and it is small.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import {test} from 'node:test';
import {pathToFileURL} from 'node:url';
import {Worker} from 'node:worker_threads';
import zlib from 'node:zlib';

const [folder, lists] = process.argv.slice(2).map(name => path.resolve(name));
const entry = pathToFileURL(path.join(folder, 'node.js'));
const {LightbinError, hasSimd, load} = await import(entry);
const modules = await Promise.all([load({simd: false}), load({simd: true})]);

// An OpenGL perspective matrix of 90 degrees, and a view whose pixels are square.
const perspective = (near, far) =>
    [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -(far + near) / (far - near), -1, 0, 0, -2 * far * near / (far - near), 0];
const square = {projection: perspective(0.5, 200), width: 320, height: 320, tileSize: 16};
const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

let state = 1;
const random = (low, high) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return low + (high - low) * state / 2 ** 32;
};
const random_spheres = count => Float32Array.from({length: 4 * count},
    (_, i) => i % 4 === 3 ? random(0.1, 4) : i % 4 === 2 ? random(-60, 2) : random(-40, 40));

const lists_of = grid => Array.from({length: grid.ranges.length / 2}, (_, i) =>
    [...grid.ids.subarray(grid.ranges[2 * i], grid.ranges[2 * i] + grid.ranges[2 * i + 1])]);
/// A test of both modules. The body returns what is to be disposed of; after that nothing is allocated.
const test_both = (name, body) => test(name, async () => {
    for (const lightbin of modules) {
        for (const made of await body(lightbin)) made.dispose();
        assert.equal(lightbin.allocations, 0);
    }
});

const bytes_of = array => Buffer.from(array.buffer, array.byteOffset, array.byteLength);

test_both('lists far from the origin are those at the origin', async lightbin => {
    const view = lightbin.view(square), binner = lightbin.binner(), viewMatrix = identity.with(12, 1e30);
    const round = number => Math.round(8 * number) / 8;  // what can be added to these eyes without rounding
    const radius = Float32Array.from({length: 200}, () => random(0.1, 4));
    const near = Float64Array.from({length: 600}, (_, i) => round(i % 3 === 2 ? random(-60, 2) : random(-40, 40)));
    const halfAxes = Float32Array.from({length: 1800}, () => random(-2, 2));
    const memory = lightbin.floats(3600);  // doubles in the module's memory are read in place
    for (const kinds of [centre => ({spheres: {centre, radius}}),
                         centre => ({boxes: {boxCentre: centre, halfAxes}}),
                         centre => ({boxes: {boxCentre: centre, halfAxes, centre, radius}})]) {
        const lights = {viewMatrix: identity, ...kinds(Float32Array.from(near))};
        const lists = lists_of(binner.bin(view, lights));
        assert.ok(lists.flat().length > 400, String(lists.flat().length));
        for (const distance of [0, 1e5, 1e7, 1e9, 2 ** 40]) {
            const eye = [distance, -3.25, distance / 2], far = near.map((number, i) => number + eye[i % 3]);
            const own = new Float64Array(memory.array.buffer, memory.array.byteOffset, far.length);
            own.set(far);
            for (const centre of [far, own])
                assert.deepEqual(lists_of(binner.bin(view, {viewMatrix, eye, ...kinds(centre)})), lists);
        }
    }
    return [view, binner, memory];
});

test_both('both modules make the bytes of this machine\'s library', async lightbin => {
    const file = fs.readFileSync(lists);
    let at = 0;
    const block = (Type = Uint8Array) => {
        const length = file.readUInt32LE(at), bytes = Uint8Array.from(file.subarray(at + 4, at + 4 + length));
        at += 4 + length;
        return new Type(bytes.buffer);
    };
    const same = (array, what) => assert.ok(bytes_of(block()).equals(bytes_of(array)), what);
    const projection = block(Float64Array), camera = block(Float64Array);
    const [spheres, spots, boxes, min, max] = Array.from({length: 5}, () => block(Float32Array));
    const view = lightbin.view({projection, width: 500, height: 290, tileSize: 24, origin: 'upper-left',
                                clipDepth: 'zero-to-one'});
    const slices = lightbin.exponentialSlices({count: 17, first: 1.5, last: 120}), {boundaries} = slices;
    same(boundaries, 'boundaries');
    const given = lightbin.slicesFromBoundaries({boundaries: [...boundaries]});
    assert.deepEqual([given.count, given.boundaries], [17, boundaries]);

    // Spots and boxes are in the module's memory, spheres and bounds are not.
    const cones = lightbin.floats(spots.length), rooms = lightbin.floats(boxes.length);
    cones.array.set(spots);
    rooms.array.set(boxes);
    let grids = 0;
    for (let number = 0; number < 24; ++number) {
        const world = number % 2 === 1, depthTest = number % 8 >= 4;
        const slicing = ['no-slicing', 'clusters', 'z-bins'][Math.floor(number / 8)];
        const options = {ids: number % 4 < 2 ? 'u32' : 'u16', depthTest, slicing};
        const inputs = {...slicing !== 'no-slicing' && {slices},
                        ...depthTest && slicing !== 'clusters' && {bounds: {min, max}}};
        const lights = {spheres: {array: spheres},
                        ...world && {viewMatrix: camera, spots: {array: cones, stride: 12}, boxes: {array: rooms}}};
        const binner = lightbin.binner(options), grid = binner.bin(view, lights, inputs);
        const what = JSON.stringify({simd: lightbin.simd, world, ...options});
        same(Uint32Array.of(grid.lights, grid.rejected, grid.culled, grid.slices), what);
        for (const key of ['ranges', 'ids', 'order', 'bins']) same(grid[key], `${what}: ${key}`);
        assert.ok(grid.ids.length > 0 && grid.ids.BYTES_PER_ELEMENT === grid.idBytes);
        const encoded = grid.encode({encoding: 'sentinel', capacity: 1});
        same(encoded.data, `encoded, ${what}`);
        same(Uint32Array.of(encoded.tilesCut, encoded.entriesCut, encoded.capacityNeeded), `cut, ${what}`);
        // What changes while the text is made changes nothing.
        const own = {...lights, spheres: {array: spheres.slice()}}, dumped = lightbin.dump(grid, view, own, inputs);
        own.spheres.array.fill(0);
        binner.bin(view, {}, inputs);
        assert.equal(await dumped, Buffer.from(block()).toString(), what);
        if (!depthTest && slicing !== 'clusters') {
            const masks = binner.masks(view, lights, inputs), {rejected, culled, firstSpot, firstBox, maskWords} = masks;
            same(Uint32Array.of(masks.lights, rejected, culled, firstSpot, firstBox, maskWords), `masks, ${what}`);
            for (const key of ['words', 'ids', 'bins']) same(masks[key], `masks, ${what}: ${key}`);
            assert.equal(await lightbin.dump(masks, view, lights, inputs), Buffer.from(block()).toString(), what);
        }
        binner.dispose();
        ++grids;
    }
    assert.equal(grids, 24);

    const image = view.project([-4, 2.5, -10]);
    same(Float64Array.from(image), 'image point');
    same(Float64Array.from(view.unproject(new Float64Array(image))), 'view point');
    same(Float32Array.from(view.depths(0.25, 0.5)), 'view depths');
    same(Float32Array.of(view.windowDepth(image)), 'window depth');
    for (const depth of [-3, 1.5, 20, Infinity]) same(Int32Array.of(slices.at(depth)), `slice at ${depth}`);
    same(Float32Array.of(lightbin.lightRange(100, 0.01)), 'lights');
    same(view.gridConstants(5, 7), 'grid constants');
    const turned = lightbin.view({...square, tileSize: 0, columns: 16, rows: 9}), counted = turned.info;
    assert.deepEqual([counted.tileSize, counted.tilesX, counted.tilesY, counted.turned], [0, 16, 9, 0]);
    const [a, b, c, d, e, f, ...others] = square.projection;
    turned.update({projection: [b, a, c, d, f, e, ...others]});
    const {tilesX, tilesY} = turned.info;
    assert.deepEqual([tilesX, tilesY, turned.info.turned], [9, 16, 1]);
    turned.dispose();
    same(view.viewConstants(1.5), 'view constants');
    same(slices.shaderWords(), 'words of slices');
    assert.equal(await lightbin.viewText(view), Buffer.from(block()).toString());
    same(view.shaderEdges(), 'edges');
    same(slices.shaderSlabs(), 'slabs');
    same(view.reduceConstants(3, 5), 'constants of a reduction');
    const text = () => Buffer.from(block()).toString();
    for (const options of [{language: 'wgsl'}, {language: 'essl-300', fragment: true}])
        assert.equal((await lightbin.reduceShader({...options, skipBackground: true})).text, text());
    const wide = lightbin.exponentialSlices({count: 17, first: 1.5, last: 120, margin: 0.02});
    for (const slicing of ['no-slicing', 'clusters']) {
        const worldSpace = slicing !== 'clusters';
        const options = {language: 'wgsl', kind: worldSpace ? 'spot' : 'mixed', stride: 12, radius: 3, axis: 4,
                         cosine: 7, boxCentre: 8, halfAxes: 11, taper: 20, spotStride: 13, boxStride: 21,
                         spots: worldSpace ? 0 : 40, boxes: worldSpace ? 0 : 30, worldSpace, depthTest: true, slicing};
        const {bytes, constants, passes, maskPasses} = await lightbin.planCull(view, options, {lights: 150, entries: 9000,
            ...slicing !== 'no-slicing' && {slices: wide}, ...worldSpace && {viewMatrix: camera}});
        const {scratch, tiles, lists, masks} = bytes;
        same(BigUint64Array.from([scratch, tiles, lists, masks], BigInt), `sizes, ${slicing}`);
        same(constants, `constants, ${slicing}`);
        assert.equal(passes.length, 5);
        assert.deepEqual(maskPasses[0], passes[0]);
        for (const {pass, x, y} of [...passes, ...maskPasses.slice(1)]) {
            same(Uint32Array.of(x, y), `groups of ${pass}, ${slicing}`);
            assert.equal((await lightbin.cullShader({...options, pass})).text, text());
        }
    }
    for (const [lights, suit] of [[1024, true], [1025, false]]) {
        const plan = await lightbin.planCull(view, {language: 'wgsl'}, {lights, entries: 1});
        assert.equal(plan.masksSuit, suit);
    }
    assert.equal(at, file.length);
    return [view, slices, given, wide, cones, rooms];
});

test_both('masks end with the lists that take their place, and with their binner', async lightbin => {
    const view = lightbin.view(square), lights = {spheres: {array: random_spheres(150)}};
    const slices = lightbin.exponentialSlices({count: 9, first: 2, last: 50}), made = [view, slices];
    for (const slicing of ['no-slicing', 'z-bins']) {
        const binner = lightbin.binner({slicing}), inputs = slicing === 'z-bins' ? {slices} : {};
        const grid = binner.bin(view, lights, inputs), masks = binner.masks(view, lights, inputs);
        assert.equal(grid.ids.length, 0);  // the lists ended with the next call
        const words = [...masks.words], ids = [...masks.ids];
        const same = () => assert.deepEqual([[...masks.words], [...masks.ids]], [words, ids]);
        assert.ok(ids.length > 0);
        assert.equal(masks.words, masks.words);  // not made again while the memory stands
        const old = masks.words, large = lightbin.floats(old.buffer.byteLength / 4);
        assert.equal(old.length, 0);
        same();
        large.dispose();
        const live = lightbin.allocations;
        assert.equal(binner.masks(view, lights, inputs), masks);
        assert.equal(lightbin.allocations, live);
        assert.throws(() => binner.masks(null, lights, inputs), {code: 'null-argument', message: /^view: /});
        assert.deepEqual([masks.words.length, masks.ids.length, masks.lights], [0, 0, 0]);
        binner.masks(view, lights, inputs);
        same();
        const {text} = await lightbin.shader({language: 'essl-300', storage: 'texture-2d', slicing, masks: true});
        assert.match(text, /usampler2D lightbin_masks/);
        binner.dispose();
        assert.equal(masks.words.length, 0);
    }
    for (const options of [{depthTest: true}, {slicing: 'clusters'}]) {
        made.push(lightbin.binner(options));
        assert.throws(() => made.at(-1).masks(view, lights), {code: 'no-such-slicing-shader', message: /masks are of/});
    }
    return made;
});

test_both('lights as arrays, interleaved, in the module\'s memory, at any place: the same lists', lightbin => {
    const count = 100, spheres = random_spheres(count);
    const view = lightbin.view(square), binner = lightbin.binner();
    const expected = lists_of(binner.bin(view, {spheres: {array: spheres}}));
    const centre = Float32Array.from({length: 3 * count}, (_, i) => spheres[4 * Math.floor(i / 3) + i % 3]);
    const radius = Float32Array.from({length: count}, (_, i) => spheres[4 * i + 3]);
    const wide = lightbin.floats(9 * count), tight = lightbin.floats(3 * count);
    for (let i = 0; i < count; ++i) {
        wide.array.set(spheres.subarray(4 * i, 4 * i + 3), 9 * i + 5);
        wide.array[9 * i + 2] = radius[i];
    }
    tight.array.set(centre);
    for (const given of [
        {array: spheres, count}, {array: [...spheres]}, {centre, radius}, {centre: [...centre], radius, count},
        {array: wide, stride: 9, centre: 5, radius: 2}, {array: wide.array, stride: 9, centre: 5, radius: 2},
        {centre: tight, radius}, {array: spheres, centre: tight},
    ]) assert.deepEqual(lists_of(binner.bin(view, {spheres: given})), expected);
    for (const array of [spheres, [[]], BigInt64Array.of(1n)])  // which are not read
        assert.deepEqual(lists_of(binner.bin(view, {viewMatrix: identity, spheres: {array, count: 0}})).flat(), []);
    const longer = [...spheres, 0, undefined];  // what count leaves out is not read
    assert.deepEqual(lists_of(binner.bin(view, {spheres: {array: longer, count}})), expected);

    // A light that only stands behind the others' kinds: ids number the kinds through.
    const all = {array: [0, 0, -5, Infinity, 0, 0, -1, -1]};
    const grid = binner.bin(view, {spheres: {array: spheres}, spots: all, boxes: {centre: null, radius: null,
        boxCentre: [0, 0, -5], halfAxes: [50, 0, 0, 0, 50, 0, 0, 0, 50], count: 1}});
    assert.deepEqual(lists_of(grid).map(list => list.slice(-2)), expected.map(() => [count, count + 1]));
    assert.deepEqual([grid.firstSpot, grid.firstBox], [count, count + 1]);
    return [view, binner, wide, tight];
});

test('memory grows, and what is read anew is right', async () => {
    for (const simd of [false, true]) {
        const lightbin = await load({simd}), view = lightbin.view(square), binner = lightbin.binner();
        const spheres = random_spheres(100), lamps = lightbin.floats(400);
        lamps.array.set(spheres);
        const grid = binner.bin(view, {spheres: {array: lamps}});
        const old = grid.ids, before = lists_of(grid), array = lamps.array;
        assert.equal(grid.ids, old);  // not made again while the memory stands
        const large = lightbin.floats(5e6);
        assert.equal(large.array.length, 5e6);
        assert.ok(large.array.every(float => float === 0));
        assert.equal(old.length, 0);
        assert.equal(array.length, 0);
        assert.deepEqual(lists_of(grid), before);
        assert.deepEqual(lamps.array, spheres);
        lamps.resize(800);
        assert.deepEqual(lamps.array.subarray(0, 400), spheres);
        assert.ok(lamps.array.subarray(400).every(float => float === 0));
        // What is in this memory but no floats is copied, also where the memory grows for that.
        const doubles = new Float64Array(large.array.buffer, large.array.byteOffset + 7 & ~7, 400);
        doubles.set(spheres);
        const spots = new Float32Array(8e6);
        const both = lists_of(binner.bin(view, {spheres: {array: doubles}, spots: {array: spots}}));
        assert.equal(doubles.length, 0);
        assert.deepEqual(both, before);
        // The binner's own memory makes it grow.
        const many = random_spheres(200000), now = binner.bin(view, {spheres: {array: many}});
        assert.equal(now, grid);
        assert.equal(now.lights, 200000);
        assert.ok(now.ids.length > 200000);
        for (const made of [view, binner, large, lamps]) made.dispose();
        assert.equal(grid.ids.length, 0);
        assert.equal(lightbin.allocations, 0);
    }
});

test('what is wrong is a sentence, the next call is right, and nothing stays allocated', async () => {
    for (const lightbin of modules) {
        const view = lightbin.view(square), binner = lightbin.binner(), spheres = random_spheres(20);
        const slices = lightbin.linearSlices({count: 4, begin: 1, end: 100});
        const sliced = lightbin.binner({slicing: 'clusters'}), tested = lightbin.binner({depthTest: true});
        const gone = lightbin.view(square);
        gone.dispose();
        gone.dispose();
        const ended = lightbin.floats(8), old_slices = lightbin.linearSlices({count: 4, begin: 1, end: 100});
        for (const made of [ended, ended, old_slices, old_slices]) made.dispose();
        const detached = new Float32Array(80);
        structuredClone(detached.buffer, {transfer: [detached.buffer]});
        const expected = lists_of(binner.bin(view, {spheres: {array: spheres}}));
        const other = await load(), foreign = other.floats(80), strange = other.view(square),
            lights = {spheres: {array: spheres}};
        const huge = lightbin.view({...square, width: 32768, height: 32768, tileSize: 1});
        const live = lightbin.allocations;
        foreign.array.set(spheres);
        assert.deepEqual(lists_of(binner.bin(view, {spheres: {array: foreign}})), expected);  // it is copied
        const viewed = more => () => lightbin.view({...square, ...more});
        const binned = spheres => () => binner.bin(view, {spheres});
        const bounded = bounds => () => tested.bin(view, lights, {bounds});
        const values = [
            [viewed({width: 1.5}), /^options.width: 1.5 is no whole number/],
            [viewed({width: '320'}), /^options.width: 320 is no whole number/],
            [viewed({width: 2 ** 31}), /^options.width: 2147483648 is no whole/],
            [viewed({height: undefined}), /^options.height is missing/],
            [viewed({projection: undefined}), /^options.projection must be an array/],
            [viewed({projection: identity.map(String)}), /^options.projection: element 0 is no number$/],
            [viewed({tilesize: 8}), /^options: there is no 'tilesize', but width, height, tileSize/],
            [viewed({clipDepth: 'webgpu'}), /'webgpu' is none of minus-one-to-one, zero-to-one$/],
            [() => lightbin.view(new Uint8Array(2 ** 28)), /^options must be an object of width/],
            [() => view.update({width: undefined}), /^options.width is missing/],
            [() => view.depths('0', 1), /^lower: 0 is no number$/],
            [() => view.project([1, 2n, 3]), /^point: element 1 is no number$/],
            [() => view.project([1, 2]), /^point must be an array of 3/],
            [() => view.viewConstants(Symbol('2')), /^tolerance: /],
            [() => view.gridConstants(0.5), /^cornerX: 0.5 is no whole number/],
            [() => lightbin.binner({slicing: 'toString'}), /is none of no-slicing, clusters, z-bins$/],
            [() => lightbin.binner({slicing: Symbol('clusters')}), /'Symbol\(clusters\)' is none of/],
            [() => lightbin.binner({depthTest: 'box'}), /^options.depthTest: box is no whole number/],
            [() => lightbin.binner({isa: 'scalar'}), /^options: there is no 'isa', but ids, depthTest, /],
            [() => lightbin.exponentialSlices(), /^options must be an object of count, first/],
            [() => lightbin.exponentialSlices({count: 4, last: 2}), /^first: undefined is no number$/],
            [() => lightbin.exponentialSlices({margn: 0}), /^options: there is no 'margn', but count, first, last/],
            [() => lightbin.linearSlices({near: 1}), /^options: there is no 'near', but count, begin, end, margin$/],
            [() => lightbin.linearSlices({count: 4, begin: 1, end: 2, margin: null}), /^margin: null/],
            [() => lightbin.linearSlices({count: 2.5, begin: 1, end: 2}), /^count: 2.5 is no whole number/],
            [() => lightbin.slicesFromBoundaries([1, 2]), /^options must be an object of boundaries/],
            [() => lightbin.slicesFromBoundaries({}), /^boundaries must be an array/],
            [() => lightbin.slicesFromBoundaries({boundaries: [1, [2]]}), /^boundaries: element 1 is no number$/],
            [() => slices.at(1n), /^depth: 1 is no number$/],
            [() => lightbin.lightRange(1), /^cutoff: undefined is no number$/],
            [() => lightbin.lightRange(1n, 2), /^intensity: 1 is no number$/],
            [() => lightbin.floats(1.5), /^length: /],
            [() => binner.bin(new Proxy(view, {}), lights), /^view was not made by this module$/],
            [() => binner.bin(strange, lights), /^view was not made by this module$/],
            [() => binner.bin(view), /^lights must be an object of viewMatrix, layout, eye, spheres/],
            [() => binner.bin(view, {balls: {}}), /there is no 'balls'/],
            [() => binner.bin(view, lights, {slice: slices}), /there is no 'slice'/],
            [() => sliced.bin(view, lights, {slices: view}), /^inputs.slices was not made/],
            [bounded({min: 5}), /^inputs.bounds.min must be an array/],
            [bounded({max: new Array(400)}), /^inputs.bounds.max: element 0 is no number$/],
            [binned([]), /^lights.spheres must be an object of count, array/],
            [binned(foreign), /^lights.spheres must be an object of/],
            [binned({array: spheres, color: 1}), /^lights.spheres: there is no 'color'/],
            [binned({count: 2 ** 32}), /^lights.spheres.count: 4294967296 is no whole number from 0 to 4294967295$/],
            ...[[[0, 0, -5, 2]], [{x: 0, y: 0, z: -5, w: 2}], Array(4).fill([0, 0, -5, 2]), ['0', '0', '-5', '2'],
                BigInt64Array.of(0n, 0n, -5n, 2n), Object.assign([], {length: 2 ** 30 + 1}),
            ].map(array => [binned({array}), /^lights.spheres.array: element 0 is no number$/]),
            [binned({array: [0, 0, -5, 2, 0, undefined, -5, 2]}), /^lights.spheres.array: element 5 is no number$/],
            [binned({centre: [[0, 0, -5]], radius: [2]}), /^lights.spheres.centre: element 0 is no number$/],
            [binned({array: spheres.subarray(1)}),
                /^lights.spheres.array: the array has 79 floats, and 19 lights have 76; if .* give count$/],
            [() => binner.bin(view, {spots: {array: foreign, stride: 9}}),
                /^lights.spots.array: the array has 80 floats, and 8 lights have 72;/],
            [binned({centre: [0, 0, -5], radius: [2, 3]}),
                /^lights.spheres.radius: the array has 2 floats, and 1 lights have 1;/],
            [binned({array: spheres, stride: 0}), /^lights.spheres.stride: 0 is no number of floats$/],
            [binned({array: spheres, centre: -1}), /^lights.spheres.centre must be/],
            [binned({array: spheres.buffer}), /^lights.spheres.array must be an array of floats$/],
            [binned({array: 80, count: 1}), /^lights.spheres.array must be/],
            [binned({array: detached}), /can't be copied.*read it anew/],
            ...[{array: spheres}, {centre: [0, 0, -5], radius: [2]}].map(spheres => [
                () => binner.bin(view, {viewMatrix: identity, eye: [0, 0, 0], spheres}),
                /^lights.spheres.centre: with an eye it must be a Float64Array of three numbers a light$/]),
            [() => binner.bin(view, {...lights, eye: [0, 0]}), /^lights.eye must be an array of 3/],
            [() => binner.bin(view, lights).encode({encoding: 'sentinel', capacity: -1}),
                /^format.capacity: -1 is no whole number from 0 to 4294967295$/],
        ];
        const others = [
            ['tile-size-out-of-range', viewed({tileSize: -1}), /^the tile size must be at least 1 pixel, and is -1;/],
            ['tile-size-out-of-range', () => view.update({tileSize: -3}), /-3/],
            ['tile-count-out-of-range', viewed({columns: 3}), /and one is 0$/],
            ['viewport-out-of-range', viewed({width: 50000}), /50000/],
            ['matrix-not-finite', viewed({projection: identity.map(() => NaN)}), /./],
            ['view-matrix-not-affine', () => binner.bin(view, {...lights, viewMatrix: square.projection}), /./],
            ['eye-not-finite', () => binner.bin(view, {viewMatrix: identity, eye: [0, NaN, 0]}), /^the eye, in world/],
            ['null-argument', () => binner.bin(view, {eye: [0, 0, 0]}), /^lights.view_matrix: /],
            ['no-slices', () => lightbin.linearSlices({count: 0, begin: 1, end: 2}), /./],
            ['slices-do-not-ascend', () => lightbin.slicesFromBoundaries({boundaries: [3, 2]}), /./],
            ['not-read', () => binner.bin(view, lights, {slices}), /^inputs.slices: /],
            ['no-slices-given', () => sliced.bin(view, lights), /^inputs.slices: /],
            ['no-bounds-given', () => tested.bin(view, lights), /^inputs.bounds: /],
            ['z-bounds-too-small', bounded({min: new Float32Array(3)}), /./],
            ['z-bounds-too-small', bounded({min: null, max: [3]}), /./],
            ['capacity-unknown', () => binner.bin(view, lights).encode({encoding: 'sentinel'}), /./],
            ['stride-too-small', binned({array: spheres, stride: 2}), /^lights.spheres.centre: /],
            ['stride-too-small', binned({array: spheres, radius: 4}),
                /^lights.spheres.radius: a light has 4 floats, and these end at 5$/],
            ['buffer-too-small', binned({array: spheres, count: 21}), /^lights.spheres.centre: the array has 80/],
            ['buffer-too-small', binned({array: detached, count: 1}), /read it anew/],
            ['null-argument', () => binner.bin(null, lights), /^view: /],
            ['null-argument', () => binner.bin(gone, lights), /^view: /],
            ['null-argument', () => gone.update(square), /^view: it was disposed of$/],
            ['null-argument', () => gone.windowDepth([1, 2, 3]), /^view: /],
            ['null-argument', () => gone.unproject([1, 2, 3]), /^view: /],
            ['null-argument', () => ended.resize(4), /^floats: it was disposed of$/],
            ['null-argument', binned({array: ended}), /^floats: it was disposed of$/],
            ['null-argument', binned({centre: spheres, count: 2}), /^lights.spheres.radius: /],
            ['null-argument', () => old_slices.at(3), /^slices: it was disposed of$/],
            ['null-argument', () => sliced.bin(view, lights, {slices: old_slices}), /^slices: it was disposed of$/],
            ['out-of-memory', () => lightbin.floats(2 ** 29), /^there is not enough memory$/],
            ['out-of-memory', () => lightbin.floats(2 ** 40), /^there is not enough memory$/],
            ['out-of-memory', () => binner.bin(huge, lights), /^there is not enough memory$/],
            // Bytes, which nothing writes to: 1 GB that the machine does not have to have.
            ['out-of-memory', () => binner.bin(view, {spheres: {array: new Uint8Array(2 ** 30)}}), /./],
        ];
        for (const [code, ask, message] of [...values.map(mistake => ['not-a-value', ...mistake]), ...others]) {
            assert.throws(ask, {name: 'LightbinError', code, message});
            assert.deepEqual(lists_of(binner.bin(view, lights)), expected, `after ${code}, ${message}`);
        }
        // Memory that a call took before it ran out stays with its binner.
        assert.ok(lightbin.allocations <= live + 2, `${lightbin.allocations} blocks, ${live} before`);
        for (const made of [view, huge, slices, binner, sliced, tested]) made.dispose();
        assert.equal(lightbin.allocations, 0);
        assert.throws(() => binner.bin(view, lights), {code: 'null-argument', message: /^binner: /});
        assert.throws(() => view.gridConstants(), {code: 'null-argument'});
        await assert.rejects(lightbin.shader({language: 'basic'}), {code: 'not-a-value',
            message: /'basic' is none of glsl-430/});
        await assert.rejects(lightbin.shader({language: 'essl-300'}), {code: 'no-storage-buffers'});
        for (const prefix of ['1x', null, 'a\0b', 'a'.repeat(130000)])
            await assert.rejects(lightbin.shader({language: 'wgsl', prefix}), {code: 'not-a-prefix'});
        await assert.rejects(lightbin.dump({}, view, {}), {code: 'not-a-value', message: /^dump: this is no grid and no masks/});
        assert.throws(() => { foreign.length = 100; }, TypeError);
        for (const [options, message] of [
            [undefined, /^options must be an object of language/],
            [{}, /^options.language: 'null' is none of glsl-430/],
            [{tilesize: 8}, /there is no 'tilesize'/], [{tiles: {binding: 1}}, /there is no 'tiles'/],
            [{slots: {tile: {}}}, /^options.slots: there is no 'tile', but tiles, lists/],
            [{slots: {tiles: 3}}, /^options.tiles must be an object of binding, set/],
        ]) {
            const given = options && (message.source.includes('language') ? options : {language: 'wgsl', ...options});
            await assert.rejects(lightbin.shader(given), {code: 'not-a-value', message});
        }
        assert.equal(lightbin.allocations, 0);
    }
    await assert.rejects(load({wasm: new Uint8Array(8)}), WebAssembly.CompileError);
    await assert.rejects(load({smid: false}), {code: 'not-a-value', message: /there is no 'smid', but simd, wasm/});
});

test('each option and value that a sentence offers is in lightbin.d.ts, and each one there is offered', async () => {
    const text = fs.readFileSync(path.join(folder, 'lightbin.d.ts'), 'utf8').replaceAll(/\/\*.*?\*\//gs, '');
    const [lightbin] = modules, view = lightbin.view(square), binner = lightbin.binner();
    const grid = binner.bin(view, {}), nonsense = {nonsense: 1}, language = 'wgsl', viewMatrix = identity;
    const unions = Object.fromEntries([...text.matchAll(/^(?:export )?type (\w+) = ([^;]*);/gms)]
        .map(([, name, union]) => [name, union]));
    let values = 0;
    for (const [name, ask] of Object.entries({
        ViewOptions: more => lightbin.view({...square, ...more}), BinnerOptions: more => lightbin.binner(more),
        Lights: more => binner.bin(view, {viewMatrix, ...more}), Inputs: more => binner.bin(view, {}, more),
        ZBounds: more => binner.bin(view, {}, {bounds: more}), ListFormat: more => grid.encode(more),
        SnippetOptions: more => lightbin.shader({language, ...more}), LoadOptions: more => load(more),
        ReduceOptions: more => lightbin.reduceShader({language, ...more}),
        CullOptions: more => lightbin.cullShader({language, ...more}),
        CullCapacity: more => lightbin.planCull(view, {language}, {lights: 1, entries: 1, viewMatrix, ...more}),
    })) {
        const message = async more => (await Promise.resolve(more).then(ask).catch(error => error)).message;
        const offered = new Set((await message(nonsense))?.match(/there is no 'nonsense', but (.*)/)?.[1].split(', '));
        const [, body] = text.match(new RegExp(`interface ${name} \\{(.*?)\\n\\}`, 's'));
        const typed = [...body.matchAll(/^    (\w+)\??: ([^;]*);/gms)];
        assert.deepEqual([...offered].sort(), typed.map(([, member]) => member).sort(), name);
        for (const [, member, type] of typed) {
            const union = unions[type] ?? type;
            if (!/^'[^(]*'$/.test(union)) continue;
            const sentence = await message({[member]: 'nonsense'});
            const [, listed] = sentence.match(/'nonsense' is none of (.*)$/)
                ?? assert.fail(`${name}.${member}: ${sentence}`);
            assert.deepEqual(listed.split(', ').sort(), union.match(/[^'|\s]+/g).sort(), `${name}.${member}`);
            ++values;
        }
    }
    assert.equal(values, 19);
    view.dispose();
    binner.dispose();
});

test('what a view was given is copied', async () => {
    const [lightbin] = modules, floats = lightbin.floats(16), options = {language: 'wgsl'};
    floats.array.set(square.projection);
    const view = lightbin.view({...square, projection: floats.array});
    const expected = lightbin.view({...square, projection: [...floats.array]});
    floats.array.fill(NaN);
    for (const tileSize of [16, 8]) {
        for (const made of [view, expected]) made.update({tileSize});
        assert.deepEqual(view.info, expected.info);
        const [plan, wanted] = await Promise.all([view, expected].map(made =>
            lightbin.planCull(made, options, {lights: 9, entries: 9})));
        assert.deepEqual(plan, wanted);
    }
    for (const made of [view, expected, floats]) made.dispose();
    assert.equal(lightbin.allocations, 0);
});

test_both('texels are whole rows, whose number seldom changes', lightbin => {
    const view = lightbin.view(square), binner = lightbin.binner({ids: 'u16', slicing: 'z-bins'});
    const slices = lightbin.exponentialSlices({count: 24, first: 1, last: 60}), array = random_spheres(500);
    const checked = (made, name, width, channels, height) => {
        const from = made[name], texels = made.texels(name, width);
        assert.deepEqual([texels.width, texels.height], [width, height], name);
        assert.equal(texels.data.length, channels * width * height);
        assert.deepEqual(texels.data.subarray(0, from.length), from, name);  // of one type
        assert.equal(made.texels(name, width).data, texels.data);
    };
    for (const count of [500, 300, 0]) {
        const grid = binner.bin(view, {spheres: {array, count}}, {slices}), {ids, order} = grid;
        const power = length => 2 ** Math.ceil(Math.log2(Math.max(length / 64, 1)));
        assert.ok(count === 0 || ids.length > 640);
        checked(grid, 'ranges', grid.tilesX, 2, grid.tilesY);
        checked(grid, 'ranges', 3, 2, Math.ceil(grid.tilesX * grid.tilesY / 3));
        checked(grid, 'ids', 64, 1, power(ids.length));
        checked(grid, 'order', 64, 1, power(order.length));
        checked(grid, 'bins', 5, 2, 8);
        assert.throws(() => grid.texels('words', 64), {code: 'not-a-value', message: /^name: masks have no/});
        const masks = binner.masks(view, {spheres: {array, count}}, {slices});
        checked(masks, 'words', 64, 1, power(masks.words.length));
    }
    for (const width of [-1, 0.5, NaN, undefined])
        assert.throws(() => binner.bin(view, {}, {slices}).texels('ids', width), {message: /^width: /});
    for (const name of ['constructor', 'lights', undefined])
        assert.throws(() => binner.bin(view, {}, {slices}).texels(name, 4), {message: /^name: /});
    return [view, binner, slices];
});

test_both('a viewport without pixels has no lists', lightbin => {
    const view = lightbin.view({...square, width: 0}), binner = lightbin.binner();
    const grid = binner.bin(view, {spheres: {array: random_spheres(9)}});
    assert.deepEqual([grid.lights, grid.ranges.length, grid.ids.length, view.info.tilesX], [9, 0, 0, 0]);
    assert.equal(grid.encode({encoding: 'sentinel', capacity: 2}).data.length, 0);
    view.update({width: 320});
    assert.equal(binner.bin(view, {spheres: {array: [0, 0, -5, 1]}}).ranges.length, 800);
    return [view, binner];
});

test_both('thousands of calls allocate nothing, and what is disposed of is free', lightbin => {
    const views = Array.from({length: 50}, () => lightbin.view(square)), binner = lightbin.binner();
    const spheres = random_spheres(50);
    binner.bin(views[0], {spheres: {array: spheres}});
    const live = lightbin.allocations;
    for (let i = 0; i < 2000; ++i) {
        views[i % 50].update({tileSize: 16 + i % 3, width: 200 + i % 120});
        binner.bin(views[i % 50], {viewMatrix: identity, spheres: {array: spheres}});
        assert.throws(() => binner.bin(views[0], {spheres: {array: spheres, stride: 3}}));
        assert.equal(lightbin.allocations, live);
    }
    return [...views, binner];
});

test('the lists of several views, one view after another', async () => {
    const other = await load(), strange = other.binner();
    for (const lightbin of modules)
        for (const [options, type] of [[{}, Uint32Array], [{ids: 'u16', slicing: 'clusters'}, Uint16Array]]) {
            const slices = lightbin.linearSlices({count: 3, begin: 5, end: 40});
            const binners = Array.from({length: 3}, () => lightbin.binner(options)), view = lightbin.view(square);
            const inputs = options.slicing && {slices};
            const grids = binners.map((binner, i) =>
                binner.bin(view, {spheres: {array: i === 1 ? [] : random_spheres(60)}}, inputs));
            const all = grids[0].append(grids[1], grids[2]);
            assert.ok(all.ids instanceof type && all.ids.length > 100);
            assert.deepEqual(lists_of(all), grids.flatMap(lists_of));
            assert.equal(all.ids.length, grids[0].ids.length + grids[2].ids.length);
            assert.deepEqual(lists_of(grids[2].append()), lists_of(grids[2]));

            const small = lightbin.view({...square, width: 160}), wide = lightbin.binner(options);
            const narrow = lightbin.binner({...options, ids: options.ids ? 'u32' : 'u16'});
            const away = strange.bin(other.view(square), {spheres: {array: []}});
            for (const [given, code, message] of [
                [[narrow.bin(view, {}, inputs)], 'not-a-value', /^append: the ids of one grid have [24] bytes/],
                [[wide.bin(small, {}, inputs)], 'grids-differ', /./],
                [[grids[1], grids[1]], 'not-a-value', /^append: a grid is given twice/],
                [[grids[0]], 'not-a-value', /^append: a grid is given twice/],
                [[away], 'not-a-value', /^append: a grid was not made by this module$/],
                [[null], 'not-a-value', /^append: a grid was not made by this module$/],
            ]) assert.throws(() => grids[0].append(...given), {name: 'LightbinError', code, message});
            assert.deepEqual(lists_of(grids[0].append(grids[1], grids[2])), grids.flatMap(lists_of));
            for (const made of [...binners, slices, view, small, wide, narrow]) made.dispose();
            assert.equal(grids[0].append().ids.length, 0);
            assert.equal(lightbin.allocations, 0);
        }
    // More grids than the module's stack of 128 KB has room for.
    const tiny = other.view({...square, width: 16, height: 16});
    const many = Array.from({length: 5000}, () => other.binner().bin(tiny, {spheres: {array: [0, 0, -5, 1]}}));
    assert.deepEqual([...many[0].append(...many.slice(1)).ranges], Array.from(many, (_, i) => [i, 1]).flat());
    const {text} = await other.shader({language: 'essl-300', storage: 'texture-2d', views: 2});
    assert.match(text, /lightbin_begin\(highp uvec2 pixel, highp float view_depth, highp uint view\)/);
});

test('shader text for WebGL 2 and WebGPU, with what to bind', async () => {
    for (const lightbin of modules) {
        const webgl = await lightbin.shader({language: 'essl-300', storage: 'texture-2d', slicing: 'clusters',
            prefix: 'lamps_',
                                             slots: {lists: {binding: 7}}});
        assert.match(webgl.text, /usampler2D lamps_lists/);
        assert.deepEqual(webgl.bindings.map(({name, resource, slot}) => [name, resource, slot.binding]), [
            ['lamps_grid', 'uniform-vector', 0], ['lamps_tiles', 'texture-2d', 0], ['lamps_lists', 'texture-2d', 7],
            ['lamps_slices', 'texture-2d',
                3]].filter(([name]) => webgl.bindings.some(binding => binding.name === name)));
        assert.equal(webgl.bindings.find(({name}) => name === 'lamps_lists').glInternalFormat, 0x8236);  // R32UI
        const webgpu = await lightbin.shader({language: 'wgsl', format: {ids: 'u16'}, heatMap: true});
        assert.match(webgpu.text, /@group\(0\) @binding\(0\) var<storage, read> lightbin_tiles/);
        assert.equal(lightbin.allocations, 0);
    }
});

test('shaders that reduce depth and make lists say what to bind', async () => {
    const bound = ({bindings}) => bindings.map(({name, resource, slot}) => [name, resource, slot.binding]);
    const [lightbin] = modules, language = 'wgsl';
    const expected = [['lightbin_grid_block', 'uniform-block'], ['lightbin_depth', 'texture-2d'],
                      ['lightbin_z_bounds', 'writable-buffer']];
    const reduce = bound(await lightbin.reduceShader({language}));
    assert.deepEqual(reduce.map(binding => binding.slice(0, 2)).sort(), expected.sort());
    const [, , before] = reduce.find(([name]) => name === 'lightbin_depth');
    const moved = bound(await lightbin.reduceShader({language, slots: {depth: {binding: before + 7}}}));
    assert.deepEqual(moved, reduce.map(([name, resource, at]) =>
        [name, resource, name === 'lightbin_depth' ? at + 7 : at]));
    const text_of = async format => (await lightbin.reduceShader({language, format})).text;
    const [usual, float32, unorm16] = await Promise.all([undefined, 'float32', 'unorm16'].map(text_of));
    assert.equal(usual, float32);
    assert.notEqual(usual, unorm16);
    const fill = options => lightbin.cullShader({language, pass: 'fill', ...options});
    const slots = {lights: 0, zBounds: 0, scratch: 1, slices: 2, tiles: 2, lightCount: 3, lists: 3, grid: 4};
    const given = Object.fromEntries(Object.entries(slots).map(([name, binding]) => [name, {binding}]));
    assert.deepEqual(await fill({}), await fill({slots: given}));
    assert.deepEqual(await fill({}), await fill({slots: {}}));
    await assert.rejects(lightbin.reduceShader({language: 'essl-300'}), {code: /^no-/});
    assert.equal(lightbin.allocations, 0);
});

test('shaders that make lists of lights on the GPU say what they refuse', async () => {
    const [lightbin] = modules, options = {language: 'wgsl'}, room = {lights: 9, entries: 9};
    const view = lightbin.view(square), slices = lightbin.linearSlices({count: 65536, begin: 1, end: 2000});
    const {bindings} = await lightbin.cullShader({...options, pass: 'fill', slots: {lists: {binding: 7}}});
    assert.deepEqual(bindings.find(({name}) => name === 'lightbin_lists').slot, {binding: 7, set: 0});
    for (const pass of ['project', 'fill'])
        assert.deepEqual(await lightbin.cullShader({...options, pass, slots: {}}),
            await lightbin.cullShader({...options, pass}));
    await assert.rejects(lightbin.cullShader({...options, pass: 'draw'}), {message: /'draw' is none of project/});
    await assert.rejects(lightbin.cullShader({language: 'essl-300'}), {code: 'no-storage-buffers'});
    const plan = (more, others = {}) => lightbin.planCull(view, {...options, ...more}, {...room, ...others});
    assert.deepEqual((await plan({})).passes.map(({pass}) => pass), ['project', 'count', 'sums', 'offsets', 'fill']);
    await assert.rejects(plan({slicing: 'clusters'}), {code: 'null-argument', message: /^slices: /});
    await assert.rejects(plan({slicing: 'z-bins'}, {slices}), {code: 'not-a-value', message: /slicing/});
    await assert.rejects(plan({slicing: 'clusters'}, {slices}), {code: 'too-many-slices'});
    await assert.rejects(plan({}, {slices}), {code: 'not-read', message: /^slices: /});
    await assert.rejects(plan({worldSpace: true}), {code: 'null-argument', message: /^to_view: /});
    await assert.rejects(plan({ids: 'u16'}, {lights: 65537}), {code: 'too-many-lights'});
    await assert.rejects(plan({}, {entries: 0.5}), {message: /^entries: 0.5 is no whole number/});
    await assert.rejects(plan({}, {room: 1}), {message: /there is no 'room'/});
    for (const wrong of [-1, 2 ** 32, '9'])
        for (const member of ['lights', 'entries'])
            await assert.rejects(plan({}, {[member]: wrong}), {message: /: \S+ is no whole number from 0 to/});
    await assert.rejects(plan({stride: -1}), {message: /^options.stride: -1 is no whole number from 0 to 4294967295$/});
    view.dispose();
    slices.dispose();
    await assert.rejects(plan({}), {message: /^view: it was disposed of/});
    assert.equal(lightbin.allocations, 0);
});

test('a worker runs the compiled module that it was sent', async () => {
    const worker = new Worker(`
        const {parentPort, workerData: {entry, module, square, spheres}} = require('node:worker_threads');
        import(entry).then(({load}) => load({wasm: module})).then(lightbin => {
            const grid = lightbin.binner().bin(lightbin.view(square), {spheres: {array: spheres}});
            parentPort.postMessage({ranges: grid.ranges.slice(), ids: grid.ids.slice()});
        });`, {eval: true, workerData: {
            entry: entry.href, module: modules[1].module, square, spheres: random_spheres(30)}});
    const made = await new Promise((resolve, reject) => worker.once('message', resolve).once('error', reject));
    assert.ok(made.ids.length > 0 && made.ranges.length === 800);
});

test('the package is whole and small', async () => {
    assert.equal(hasSimd(), true);
    const {version, exports} = JSON.parse(fs.readFileSync(path.join(folder, 'package.json')));
    for (const lightbin of modules) assert.equal(lightbin.version, version);
    const files = entry => typeof entry === 'string' ? [entry] : Object.values(entry);
    for (const file of Object.values(exports).flatMap(files))
        assert.ok(fs.existsSync(path.join(folder, file)), file);
    const gzip = name => zlib.gzipSync(fs.readFileSync(path.join(folder, name)), {level: 9}).length;
    for (const name of ['lightbin.wasm', 'lightbin_simd.wasm']) {
        const bytes = gzip('lightbin.js') + gzip(name);
        assert.ok(bytes <= 62000, `${name} and the JavaScript are ${bytes} bytes, compressed`);
    }
    // In a browser the module comes by fetch().
    const fetched = globalThis.fetch;
    try {
        globalThis.fetch = async url => new Response(fs.readFileSync(new URL(url)));
        const in_browser = await import(pathToFileURL(path.join(folder, 'lightbin.js')));
        const lightbin = await in_browser.load();
        assert.equal(lightbin.simd, true);
        assert.match((await lightbin.shader({language: 'wgsl'})).text, /lightbin_lists/);
        globalThis.fetch = async () => new Response('', {status: 404});
        await assert.rejects(in_browser.load(), {code: 'not-loaded', message: /404/});
        const later = await in_browser.load({wasm: lightbin.module});
        await assert.rejects(later.shader({language: 'wgsl'}), {code: 'not-loaded', message: /404/});
        globalThis.fetch = async url => new Response(fs.readFileSync(new URL(url)));  // the connection is back
        assert.match((await later.shader({language: 'wgsl'})).text, /lightbin_lists/);
    } finally {
        globalThis.fetch = fetched;
    }
});

// Its blocks are one program, in which the camera and the context of WebGL are stand-ins.
test('the program of docs/javascript.md runs', async t => {
    const page = fs.readFileSync(new URL('../../docs/javascript.md', import.meta.url), 'utf8');
    const blocks = [...page.matchAll(/^```js\n(.*?)^```$/gms)].map(([,
        block]) => block).filter(block => !/three/.test(block));
    assert.ok(blocks.length >= 4);
    const given = `
        const uploads = [], gl = new Proxy({}, {get: (_, name) => name === name.toUpperCase() ? name
            : (...given) => { if (name === 'texImage2D') uploads.push(given); }});
        const camera = {projectionMatrix: {elements: ${JSON.stringify(square.projection)}},
                        matrixWorldInverse: {elements: ${JSON.stringify(identity)}}};
        const tilesTexture = 1, listsTexture = 2, program = 3;`;
    const at = fs.mkdtempSync(path.join(path.dirname(folder), 'guide-'));
    t.after(() => fs.rmSync(at, {recursive: true}));
    fs.mkdirSync(path.join(at, 'node_modules'));
    fs.symlinkSync(folder, path.join(at, 'node_modules/lightbin'));
    fs.writeFileSync(path.join(at, 'guide.mjs'), given + blocks.join('') +
        '\nexport {bindings, data, grid, lists, shorter, text, texts, uploads, webgpu};');
    const made = await import(pathToFileURL(path.join(at, 'guide.mjs')));
    assert.ok(made.lists.ids.length > 0 && made.shorter.ids.length > 0 && made.data.length > 0);
    assert.match(made.text, /usampler2D lightbin_lists/);
    assert.match(made.webgpu.text, /@group\(1\) @binding\(1\)/);
    assert.equal(made.texts.length, 5);
    assert.deepEqual(made.uploads.map(given => given.at(-1)),
                     [made.grid.texels('ranges', made.grid.tilesX).data, made.grid.texels('ids', 2048).data]);
});
