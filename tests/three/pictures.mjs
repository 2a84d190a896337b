// SPDX-License-Identifier: MIT
// node --test tests/three/pictures.mjs: the adapter for three.js in headless Chromium.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import {test} from 'node:test';
import {page_of_tests, same} from '../browser.mjs';

const {page, complaints} = await page_of_tests(new URL('.', import.meta.url), 'stage');

// Rounding differs, as three.js' own shader is another program: by 1 of 255 at most.
test('100 lights: as three.js draws them itself', async () => {
    same(await page.evaluate(() => {
        stage.lights(70, 30);
        stage.own();
        const own = stage.draw();
        stage.cluster();
        return difference(own, stage.draw());
    }), 'a picture', 1);
});

test('5,000 moving lights: as every light in every fragment draws them, byte by byte', async () => {
    for (const seconds of [0, 1.7]) {
        const {result, grid, control} = await page.evaluate(seconds => {
            stage.own();
            stage.resize(240, 150);
            stage.lights(3500, 1500, {range: 1.5});
            stage.move(seconds);
            stage.cluster();
            const lists = stage.draw(), {tilesX, slices, lights, rejected} = stage.clusters.grid;
            stage.all(5000);
            const all = stage.draw();
            stage.own();
            stage.cluster();
            stage.draw();
            stage.all(4000);
            const fewer = stage.draw();
            return {result: difference(lists, all), grid: {tilesX, slices, lights, rejected},
                    control: difference(lists, fewer).pixels};
        }, seconds);
        same(result);
        assert.ok(control > 300, 'it makes no difference if lights are left out');
        assert.deepEqual(grid, {tilesX: 8, slices: 24, lights: 5000, rejected: 0});
    }
});

test('masks in place of lists: as three.js draws few lights itself, and as lists draw 1,000', async () => {
    const {few, many, seen, control} = await page.evaluate(() => {
        const pictures = () => [stage.draw(), stage.draw(stage.other)];
        const drawn = (options, make) => {
            stage.own();
            make();
            if (options !== undefined) stage.cluster(options);
            return pictures();
        };
        const few = () => stage.lights(70, 30), many = () => stage.lights(700, 300, {range: 1.5});
        stage.resize(320, 200);
        const few_own = drawn(undefined, few), few_masks = drawn({masks: true}, few);
        const many_lists = drawn({}, many), many_masks = drawn({masks: true}, many);
        const {lights, rejected, bins, tilesX} = stage.clusters.masks;
        const seen = {lights, rejected, bins: bins.length, tilesX};
        stage.lamps.forEach((lamp, i) => { lamp.visible = i % 5 !== 0; });
        return {few: few_own.map((own, i) => difference(own, few_masks[i])),
                many: many_lists.map((lists, i) => difference(lists, many_masks[i])), seen,
                control: difference(many_masks[0], pictures()[0]).pixels};
    });
    for (const result of [...few, ...many]) same(result, 'a picture', 1);  // lights are added in another order
    assert.deepEqual(seen, {lights: 1000, rejected: 0, bins: 256, tilesX: 10});
    assert.ok(control > 300, 'it makes no difference if lights are left out');
});

test('shadows, directional lights and lights that change stay as three.js draws them', async () => {
    const results = await page.evaluate(() => {
        const {THREE, renderer, scene} = stage, results = {};
        stage.resize(240, 150);
        renderer.shadowMap.enabled = true;
        stage.own();
        stage.lights(30, 20);
        const sun = new THREE.DirectionalLight(0xffffff, 0.3), torch = new THREE.SpotLight(0xffffff, 300, 60, 0.6, 0.5);
        torch.position.set(2, 12, 3);
        torch.castShadow = true;
        scene.add(sun, torch, torch.target);
        const pictures = () => {
            const made = {shadow: stage.draw()};
            torch.castShadow = false;
            made.none = stage.draw();
            torch.castShadow = true;
            made.again = stage.draw();
            stage.lamps[3].visible = stage.lamps[40].visible = false;
            stage.lamps[4].layers.set(3);
            stage.lamps[5].color.set(0x00ff00);
            made.changed = stage.draw();
            stage.lamps[3].visible = stage.lamps[40].visible = true;
            stage.lamps[4].layers.set(0);
            return made;
        };
        const own = pictures();
        stage.cluster();
        const lists = pictures();
        stage.own();
        const after = pictures();
        for (const name in own)
            results[name] = [difference(own[name], lists[name]), difference(own[name], after[name])];
        results.seen = [difference(own.shadow, own.none).pixels, difference(own.shadow, own.changed).pixels];
        results.layers = stage.lamps.every(({layers}) => layers.mask === 1);
        results.allocations = stage.lightbin.allocations;
        scene.remove(sun, torch, torch.target);
        return results;
    });
    for (const name of ['shadow', 'none', 'again', 'changed']) {
        same(results[name][0], name, 1);
        same(results[name][1], `${name}, after dispose()`);
    }
    assert.ok(results.seen.every(pixels => pixels > 30), `${results.seen}`);
    assert.ok(results.layers);
    assert.equal(results.allocations, 0);
});

test('pictures within pictures, and targets of other sizes: as three.js draws them itself', async t => {
    const names = await page.evaluate(async () => Object.keys((await import('/settings.js')).settings));
    assert.ok(names.length > 15);
    for (const name of names)
        await t.test(name, async () => {
            const {result, says = []} = await page.evaluate(async name => {
                const {settings} = await import('/settings.js');
                const pictures = cluster => {
                    stage.own();
                    stage.resize(200, 125);
                    stage.lights(16, 8, {range: 12});
                    if (cluster) stage.cluster();
                    const {draw = () => stage.draw(), undo, options, frames = 2, says} = settings[name]();
                    if (cluster && options !== undefined) {
                        stage.own();
                        stage.cluster(options);
                    }
                    try {
                        for (let i = 1; i < frames; ++i) draw();
                        return [draw(), says];
                    } finally {
                        stage.renderer.setRenderTarget(null);
                        undo();
                    }
                };
                stage.model.visible = false;
                const [[own], [lists, says]] = [false, true].map(pictures);
                stage.model.visible = true;
                return {result: difference(own, lists), says};
            }, name);
            const warnings = complaints.splice(0);
            assert.equal(warnings.length, says.length, `${warnings}`);
            says.forEach((words, i) => assert.ok(warnings[i].includes(words), warnings[i]));
            same(result, name, 1);
        });
});

test('a cutoff: as three.js draws lights that end where they have fallen to it, in shorter lists', async () => {
    const {result, entries, all} = await page.evaluate(() => {
        stage.model.visible = false;
        const pictures = (cutoff, options) => {
            stage.own();
            stage.lights(16, 8, {range: 7});
            stage.lamps.forEach((lamp, i) => {
                lamp.distance = 0;
                lamp.decay = 2 - i % 3 / 4;
                if (i % 4 === 0) lamp.color.set(0.1, 0.7, 0.3);
                const {r, g, b} = lamp.color, strongest = Math.max(r, g, b) * lamp.intensity;
                if (cutoff > 0) lamp.distance = (strongest / cutoff) ** (1 / lamp.decay);
            });
            if (options !== undefined) stage.cluster(options);
            return stage.draw();
        };
        const own = pictures(0.2), lists = pictures(0, {cutoff: 0.2}), entries = stage.clusters.grid.ids.length;
        pictures(0, {});
        stage.model.visible = true;
        return {result: difference(own, lists), entries, all: stage.clusters.grid.ids.length};
    });
    same(result, 'a picture', 1);
    assert.ok(entries < all / 4, `${entries} entries of ${all}`);
});

test('where a picture within another one fails, the next frame is right', async () => {
    const {results, said, restored, seen} = await page.evaluate(async () => {
        const {scene, THREE} = stage, [lamp] = stage.lamps, screen = new THREE.Object3D(), {onAfterRender} = scene;
        const object = scene.children.find(({isMesh}) => isMesh);
        stage.own();
        stage.cluster();
        const before = stage.draw(), said = [];
        for (const where of ['outer', 'inner']) {
            object.onBeforeRender = (renderer, scene, camera) => {
                if (camera === stage.other || where === 'outer') throw new Error(where);
                stage.renderer.render(scene, stage.other);
            };
            try {
                stage.draw();
            } catch ({message}) {
                said.push(message);
            }
        }
        delete object.onBeforeRender;
        const same_task = difference(before, stage.draw());
        await undefined;
        return {results: [same_task, difference(before, stage.draw())], said,
                restored: scene.onAfterRender === onAfterRender, seen: lamp.layers.test(stage.camera.layers)};
    });
    assert.deepEqual(said, ['outer', 'inner']);
    for (const result of results) same(result);
    assert.ok(restored && seen);
});

test('scene.onAfterRender is called once a picture, and compile() makes the shaders of the pictures', async () => {
    const {calls, compiled, drawn} = await page.evaluate(() => {
        const {camera, renderer, scene} = stage, {programs} = renderer.info, calls = [];
        stage.own();
        stage.cluster();
        stage.clusters.update(renderer, scene, camera);
        renderer.compile(scene, camera);
        const compiled = programs.length;
        scene.onAfterRender = (...given) => calls.push(given[2] === camera && given[1] === scene);
        stage.draw();
        stage.draw();
        delete scene.onAfterRender;
        return {calls, compiled, drawn: programs.length};
    });
    assert.deepEqual(calls, [true, true]);
    assert.equal(drawn, compiled);
});

test('it throws nothing out of render(): what has no lists is said once, and after dispose() nothing', async () => {
    const result = await page.evaluate(() => {
        const {camera, renderer, scene, THREE} = stage;
        stage.own();
        const own = stage.draw();
        stage.cluster();
        for (let i = 0; i < 2; ++i)
            for (const each of [new THREE.ArrayCamera(), new THREE.PerspectiveCamera(60, 0 / 0, 0.1, 100)])
                renderer.render(scene, each);
        const {update} = stage.clusters;
        stage.own();
        scene.onBeforeRender = update;
        return difference(own, stage.draw());
    });
    const [nan, ...others] = complaints.splice(0);
    assert.match(nan, /NaN/);
    assert.deepEqual(others, []);
    same(result);
});

test('workers make the same lists, of the module that they were sent or load themselves', async () => {
    const lists = await page.evaluate(async () => {
        const {lightbin, camera} = stage, made = [];
        const text = `import {load} from '${location.origin}/lightbin/lightbin.js';
            onmessage = async ({data: {options, view, spheres}}) => {
                const lightbin = await load(options), grid = lightbin.binner().bin(lightbin.view(view), {spheres});
                postMessage([...grid.ranges, ...grid.ids].join());
            };`;
        const address = URL.createObjectURL(new Blob([text], {type: 'text/javascript'}));
        const view = {projection: [...camera.projectionMatrix.elements], width: 320, height: 200}, array = [];
        for (let i = 0; i < 500; ++i) array.push(i % 23 - 11, i % 13 - 6, -1 - i % 41, 0.5 + i % 3);
        for (const options of [{wasm: lightbin.module}, {}, {simd: false}]) {
            const worker = new Worker(address, {type: 'module'});
            worker.postMessage({options, view, spheres: {array}});
            made.push(await new Promise((resolve, reject) => {
                worker.onmessage = ({data}) => resolve(data);
                worker.onerror = ({message}) => reject(new Error(message));
            }));
            worker.terminate();
        }
        const {ranges, ids} = lightbin.binner().bin(lightbin.view(view), {spheres: {array}});
        return [...made, [...ranges, ...ids].join()];
    });
    assert.ok(lists[0].length > 1000);
    assert.equal(new Set(lists).size, 1);
});

test('an option that is misspelt or wrong is named', async () => {
    const messages = await page.evaluate(async () => {
        const {ClusteredLights} = await import('lightbin/three');
        const mistakes = [{tilesize: 16}, {tileSize: -1}, {slices: 0}, {cutoff: -1}, {masks: true, depthTest: true}, {}];
        return mistakes.map(options => {
            try {
                new ClusteredLights(stage.lightbin, options).update({isWebGPURenderer: true});
            } catch (error) {
                return error.message;
            }
        });
    });
    [/there is no 'tilesize', but masks, tileSize/, /tile size/, /slice/, /options.cutoff: -1/, /depthTest/,
     /three-webgpu/].forEach(
        (words, i) => assert.match(messages[i], words));
});

test('the program of docs/threejs.md', async () => {
    const text = fs.readFileSync(new URL('../../docs/threejs.md', import.meta.url), 'utf8');
    const blocks = [...text.matchAll(/^```js\n(.*?)^```$/gms)].map(([, block]) => block);
    assert.equal(blocks.length, 2);
    const expected = await page.evaluate(() => {
        stage.own();
        stage.lights(200, 100);
        stage.cluster();
        window.expected = stage.draw();
        stage.own();
        return expected.length;
    });
    assert.ok(expected > 0);
    await page.addScriptTag({type: 'module', content:
        `const {scene, camera, renderer} = stage;\n${blocks[0]}\nwindow.guide = {lights};`});
    await page.waitForFunction(() => window.guide !== undefined);
    const {result, count} = await page.evaluate(() => {
        const made = {result: difference(expected, stage.draw()), count: guide.lights.grid.lights};
        guide.lights.dispose();
        return made;
    });
    same(result);
    assert.equal(count, 300);
});
