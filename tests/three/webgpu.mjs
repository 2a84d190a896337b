// SPDX-License-Identifier: MIT
// node --test tests/three/webgpu.mjs: the adapter for three.js' WebGPURenderer in headless Chromium, with WebGPU and
// with WebGL 2.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import {test} from 'node:test';
import {page_of_tests, same} from '../browser.mjs';

const {page, complaints} = await page_of_tests(new URL('.', import.meta.url), 'stage', 'webgpu_page.html');

for (const backend of ['webgpu', 'webgl']) {
    // The result of three.js' own clusters is only shown.
    test(`${backend}: 700 moving lights, as every light in every fragment draws them`, async t => {
        const results = await page.evaluate(async backend => {
            await stage.use(backend);
            stage.lights(500, 200, {range: 2});
            const pictures = () => [0, 1.7].flatMap(seconds => {
                stage.move(seconds);
                return [stage.draw(), stage.draw(stage.other)];
            });
            stage.all();
            const all = pictures();
            stage.light(new stage.OwnClusters());
            const clusters = pictures();
            stage.cluster();
            const lists = pictures(), {tilesX, slices, lights, rejected} = stage.renderer.lighting.grid;
            stage.lamps.forEach((lamp, i) => { lamp.visible = i % 5 !== 0; });
            const fewer = pictures();
            const compare = others => others.map((picture, i) => difference(all[i], picture));
            return {lists: compare(lists), fewer: compare(fewer), clusters: compare(clusters),
                    grid: {tilesX, slices, lights, rejected}};
        }, backend);
        t.diagnostic(JSON.stringify(results));
        for (const result of results.lists) same(result, 'a picture', 1);
        for (const {pixels} of results.fewer) assert.ok(pixels > 300, 'it makes no difference if lights are left out');
        assert.deepEqual(results.grid, {tilesX: 10, slices: 24, lights: 700, rejected: 0});
    });

    // three.js does not look anew at what an object reads while the object and its material stay the same.
    test(`${backend}: lights, camera and canvas change where nothing else does, by the same shaders`, async () => {
        const {results, programs} = await page.evaluate(async backend => {
            await stage.use(backend);
            const {camera, renderer} = stage, changes = [
                () => stage.lights(10, 5),
                () => { camera.position.x += 2; },
                () => stage.lights(500, 200),
                () => stage.resize(150, 250),
                () => stage.lights(2, 1),
                () => stage.resize(500, 330),
                () => { camera.position.x -= 2; },
                () => stage.lights(0, 0),
                () => stage.lights(300, 100),
            ], programs = new Set();
            const pictures = () => changes.map(change => {
                change();
                const picture = stage.draw();
                programs.add(renderer.info.memory.programs);
                return picture;
            });
            stage.all();
            const all = pictures();
            stage.resize(320, 200);
            stage.cluster();
            programs.clear();
            return {results: pictures().map((picture, i) => difference(all[i], picture)), programs: [...programs]};
        }, backend);
        same(results[2], 'with many lights', 1);
        for (const [i, {most, length}] of results.entries())
            assert.ok(most <= 1 && length === 0, `picture ${i}: ${most} of 255 apart`);
        assert.equal(programs.length, 1);
    });

    test(`${backend}: pictures within pictures, other cameras, targets, materials and lights`, async t => {
        const names = await page.evaluate(async () => Object.keys((await import('/webgpu_settings.js')).settings));
        for (const name of names)
            await t.test(name, async () => {
                const {result, control} = await page.evaluate(async ([backend, name]) => {
                    const {settings} = await import('/webgpu_settings.js');
                    await stage.use(backend);
                    stage.lights(14, 6);
                    const {draw = () => stage.draw(), undo} = settings[name]();
                    const drawn = async () => { await draw(); return draw(); };
                    const own = await drawn();
                    stage.cluster();
                    const result = difference(own, await drawn());
                    stage.lamps.forEach((lamp, i) => { lamp.visible = i % 2 === 0; });
                    const control = difference(own, await drawn()).pixels;
                    undo();
                    return {result, control};
                }, [backend, name]);
                same(result, name, 1);
                assert.ok(control > 100, 'it makes no difference if lights are left out');
            });
    });
}

test('what has no lists is said once, and after dispose() nothing is left', async () => {
    const result = await page.evaluate(async () => {
        await stage.use('webgpu');
        stage.lights(14, 6);
        const own = stage.draw(), {renderer, scene, THREE} = stage;
        const before = stage.lightbin.allocations;
        stage.cluster();
        for (let i = 0; i < 2; ++i) renderer.render(scene, new THREE.PerspectiveCamera(60, 0 / 0, 0.1, 100));
        const picture = stage.draw(), made = stage.lightbin.allocations - before;
        stage.own();
        return {difference: difference(own, picture), made, left: stage.lightbin.allocations - before};
    });
    const [nan, ...others] = complaints.splice(0);
    assert.match(nan, /NaN/);
    assert.deepEqual(others, []);
    same(result.difference, 'a picture', 1);
    assert.ok(result.made > 0);
    assert.equal(result.left, 0);
});

test('an option that is misspelt is named, and masks are none', async () => {
    const messages = await page.evaluate(async () => [{tilesize: 16}, {masks: true}].map(options => {
        try {
            stage.cluster(options);
        } catch (error) {
            return error.message;
        }
    }));
    assert.match(messages[0], /there is no 'tilesize', but tileSize, slices/);
    assert.match(messages[1], /there is no 'masks'/);
});

test('the program of docs/threejs.md', async () => {
    const text = fs.readFileSync(new URL('../../docs/threejs.md', import.meta.url), 'utf8');
    const [, [, block]] = [...text.matchAll(/^```js\n(.*?)^```$/gms)];
    assert.match(block, /lightbin\/three-webgpu/);
    await page.evaluate(async () => {
        await stage.use('webgpu');
        stage.lights(14, 6);
        window.expected = stage.draw();
    });
    await page.addScriptTag({type: 'module', content:
        `const {scene, camera, renderer} = stage;\n${block}\nwindow.guide = renderer.lighting;`});
    await page.waitForFunction(() => window.guide !== undefined);
    const {result, lights} = await page.evaluate(() => ({result: difference(expected, stage.draw()),
                                                         lights: guide.grid.lights}));
    same(result, 'a picture', 1);
    assert.equal(lights, 20);
});

// The last, as the renderer leaves its depths to the cameras.
for (const backend of ['webgpu', 'webgl', 'webgpu, reversed depth'])
    test(`${backend}: 40 lights, as three.js draws them itself`, async () => {
        const results = await page.evaluate(async backend => {
            await stage.use(backend);
            stage.lights(28, 12);
            const within = stage.other.clone();
            within.near = -5;
            within.updateProjectionMatrix();
            const pictures = () => [stage.camera, stage.other, within].map(camera => stage.draw(camera));
            const own = pictures();
            stage.cluster();
            return pictures().map((picture, i) => difference(own[i], picture));
        }, backend);
        for (const result of results) same(result, 'a picture', 1);
    });
