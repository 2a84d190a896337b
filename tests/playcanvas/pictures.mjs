// SPDX-License-Identifier: MIT
// node --test tests/playcanvas/pictures.mjs: the adapter for PlayCanvas in headless Chromium.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {page_of_tests, same} from '../browser.mjs';

const {page, complaints} = await page_of_tests(new URL('.', import.meta.url), 'Stage');
await page.evaluate(async () => {
    window.stages = {};
    for (const kind of ['own', 'lists', 'all']) stages[kind] = await new Stage(kind).start();
    /// How the pictures of two stages differ, after the same was done to both.
    window.compare = (one, other, change, draw = stage => stage.draw()) => {
        const pictures = [one, other].map(kind => {
            change(stages[kind]);
            return draw(stages[kind]);
        });
        return difference(...pictures);
    };
});

// Where PlayCanvas lists all lights it adds the same ones in the same order, but by another program.
for (const [points, spots] of [[70, 30], [300, 49]])
    test(`${points + spots} lights: as PlayCanvas draws them itself, and as all lights in every fragment`, async () => {
        const results = await page.evaluate(([points, spots]) => {
            const lights = stage => stage.lights(points, spots, {range: 6});
            stages.own.app.scene.lighting.maxLights = 400;
            return [compare('own', 'lists', lights), compare('lists', 'all', lights)];
        }, [points, spots]);
        same(results[0], "PlayCanvas' own", 1);
        same(results[1], 'all lights');
    });

test('WebGPU: as PlayCanvas draws them itself, and as all lights in every fragment', async () => {
    const results = await page.evaluate(async () => {
        const pictures = [];
        for (const kind of ['own', 'lists', 'all']) {
            const stage = await new Stage(kind).start({deviceType: 'webgpu'});
            pictures.push(stage.lights(70, 30, {range: 6}).draw());
            stage.destroy();
        }
        return [difference(pictures[0], pictures[1]), difference(pictures[1], pictures[2])];
    });
    same(results[0], "PlayCanvas' own", 1);
    same(results[1], 'all lights');
});

test('5,000 moving lights, and more than a texture has rows: as all lights in every fragment', async () => {
    for (const [points, spots, seconds, cells, width, height] of [
        [3500, 1500, 0, [32, 4, 32], 160, 100], [3500, 1500, 1.7, [16, 16, 16], 160, 100],
        [9000, 1, 0, [1, 1, 1], 48, 30], [9000, 1000, 0, [100, 3, 50], 48, 30]]) {
        const {result, lights, rows, control} = await page.evaluate(given => {
            const [points, spots, seconds, cells, width, height] = given;
            const change = stage => {
                stage.resize(width, height);
                stage.lights(points, spots, {range: 1.5, strength: 0.15}).move(seconds);
                stage.app.scene.lighting.cells = new pc.Vec3(...cells);
            };
            const result = compare('lists', 'all', change), {lights} = stages.lists.clusters.grid;
            const some = picture => stages.all.lamps.forEach((lamp, i) => { lamp.enabled = !picture || i % 5 !== 0; });
            const control = compare('lists', 'all', stage => some(stage === stages.all)).pixels;
            return {result, lights, rows: stages.lists.app.graphicsDevice.maxTextureSize, control};
        }, [points, spots, seconds, cells, width, height]);
        same(result, `${points + spots} lights`);
        assert.ok(lights > (points + spots) / 2, `only ${lights} lights are in view`);
        assert.ok(points < 9000 || lights > rows, `${lights} lights fit into ${rows} rows`);
        assert.ok(control > width * height / 20, `lights that are left out change ${control} pixels`);
    }
});

test('each point of a light has the light in the list that the shader finds for it', async () => {
    for (const [extent, cells, depthTest] of [[14, [32, 4, 32], false], [14, [7, 9, 33], true],
                                              [4000, [10, 3, 10], true]]) {
        const {missing, points, moved} = await page.evaluate(async given => {
            const [extent, cells, depthTest] = given;
            const stage = new Stage('lists');
            await stage.start({width: 16, height: 16, model: false, depthTest});
            stage.lights(500, 300, {extent, range: extent / 6});
            stage.camera.setPosition(0, 4 * extent, 0);
            stage.camera.lookAt(0, 0, 1e-3 * extent);
            stage.camera.camera.farClip = 10 * extent;
            stage.app.scene.lighting.cells = new pc.Vec3(...cells);
            stage.render();
            const [{usedLights, boundsMin, boundsDelta}] = stage.drawn, {ranges, ids} = stage.clusters.grid;
            const begin = boundsMin.toArray(), delta = boundsDelta.toArray();
            const scale = cells.map((count, axis) => Math.fround(count / delta[axis]));
            const lists = (x, y, z) => {
                const cell = x + cells[0] * (z + cells[2] * y);
                return ids.subarray(ranges[2 * cell], ranges[2 * cell] + ranges[2 * cell + 1]);
            };
            // The shader's arithmetic, and that of real numbers as nearly as doubles have it.
            const cell_of = (point, round) => point.map((p, axis) =>
                Math.floor(round(round(p - begin[axis]) * scale[axis])));
            const result = {missing: 0, points: 0, moved: 0};
            const {random} = await import('/tests/pictures.js');
            usedLights.slice(1).forEach(({light}, id) => {
                const centre = light._node.getPosition().toArray(), range = light.attenuationEnd;
                const axis = light._node.up.toArray().map(x => -x), is_spot = light.type === pc.LIGHTTYPE_SPOT;
                const cosine = is_spot ? Math.cos(light.outerConeAngle * Math.PI / 180) : -2;
                for (let i = 0; i < 400; ++i) {
                    const to = [random(-1, 1), random(-1, 1), random(-1, 1)], reach = range * random(0, 1) ** (i % 4);
                    const size = Math.hypot(...to), point = to.map((x, k) => Math.fround(centre[k] + x * reach / size));
                    // Onto a boundary between cells, and to the floats beside it.
                    const along = i % 3, cell = cell_of(point, x => x)[along];
                    if (i % 5 > 0) {
                        const at = Math.fround(begin[along] + cell / scale[along]), ulp = 2 ** -23 * Math.abs(at);
                        point[along] = Math.fround(at + (i % 5 - 2) * ulp / 2);
                    }
                    const from = point.map((x, k) => x - centre[k]), far = Math.hypot(...from);
                    const along_axis = from.reduce((sum, x, k) => sum + x * axis[k], 0);
                    if (far >= range || along_axis <= cosine * far) continue;
                    const [x, y, z] = cell_of(point, Math.fround);
                    ++result.points;
                    result.moved += cell_of(point, p => p).some((c, k) => c !== [x, y, z][k]) ? 1 : 0;
                    if (!lists(x, y, z).includes(id)) ++result.missing;
                }
            });
            stage.destroy();
            return result;
        }, [extent, cells, depthTest]);
        assert.ok(points > 50000, `${points} points`);
        assert.ok(moved > 10, 'no rounding was seen');
        assert.equal(missing, 0);
    }
});

test('another size, several cameras, layers with lights of their own, a render target', async () => {
    const results = await page.evaluate(() => {
        for (const stage of Object.values(stages)) {
            const {app} = stage;
            stage.resize(301, 173);
            stage.lights(70, 30, {range: 6});
            app.scene.lighting.cells = new pc.Vec3(10, 3, 10);
            const layer = new pc.Layer({name: 'another'});
            app.scene.layers.push(layer);
            stage.add('box', [0, -3, 6], [6, 2, 3], stage.material, [layer.id]);
            for (const lamp of stage.lamps.slice(0, 10)) lamp.light.layers = [layer.id];
            stage.camera.camera.layers = [...stage.camera.camera.layers, layer.id];
            stage.other = stage.eye({projection: pc.PROJECTION_ORTHOGRAPHIC, orthoHeight: 8, priority: 1,
                                     rect: new pc.Vec4(0.6, 0.1, 0.3, 0.4), layers: [pc.LAYERID_WORLD]});
            stage.other.setPosition(0, 20, 10);
            stage.other.lookAt(0, 0, 0);
            const texture = new pc.Texture(app.graphicsDevice, {width: 128, height: 96, format: pc.PIXELFORMAT_RGBA8,
                                                                mipmaps: false});
            stage.third = stage.eye({priority: -1, renderTarget: new pc.RenderTarget({colorBuffer: texture})});
            stage.third.setPosition(-12, 6, -12);
            stage.third.lookAt(0, -3, 0);
        }
        const target = stage => {
            stage.render();
            const {gl} = stage.app.graphicsDevice, pixels = new Uint8Array(4 * 128 * 96);
            gl.bindFramebuffer(gl.FRAMEBUFFER, stage.third.camera.renderTarget.impl._glFrameBuffer);
            gl.readPixels(0, 0, 128, 96, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
            stage.app.graphicsDevice.renderTarget = undefined;  // so that it binds again what it draws to
            return pixels;
        };
        const nothing = () => {}, results = {};
        for (const [one, other] of [['own', 'lists'], ['lists', 'all']]) {
            results[`${one} and ${other}`] = compare(one, other, nothing);
            results[`${one} and ${other}, target`] = compare(one, other, nothing, target);
        }
        const clusters = stages.lists.drawn.length;
        for (const stage of Object.values(stages)) {
            stage.other.destroy();
            stage.third.destroy();
        }
        return {results, clusters, alone: compare('own', 'lists', nothing)};
    });
    for (const [name, result] of Object.entries(results.results)) same(result, name, name.startsWith('own') ? 1 : 0);
    same(results.alone, 'one camera', 1);
    assert.equal(results.clusters, 2);
});

test('shadows, cookies, directional lights and lights that change stay as PlayCanvas draws them', async () => {
    const results = await page.evaluate(() => {
        for (const stage of Object.values(stages)) {
            const {app} = stage, {lighting} = app.scene;
            stage.resize(240, 150);
            stage.lights(40, 20, {range: 6});
            Object.assign(lighting, {shadowsEnabled: true, cookiesEnabled: true});
            stage.sun = stage.entity('light', {type: 'directional', intensity: 0.2, castShadows: true});
            stage.sun.setEulerAngles(40, 20, 0);
            const texture = new pc.Texture(app.graphicsDevice, {width: 8, height: 8, format: pc.PIXELFORMAT_RGBA8});
            texture.lock().set(Array.from({length: 256}, (_, i) => i % 4 === 3 || (i >> 2 ^ i >> 5) & 1 ? 255 : 40));
            texture.unlock();
            const options = {range: 40, intensity: 2, castShadows: true, shadowBias: 0.1, normalOffsetBias: 0.1};
            stage.torch = stage.entity('light', {type: 'spot', outerConeAngle: 50, innerConeAngle: 30, ...options});
            stage.torch.setPosition(10, 6, 4);
            stage.torch.setEulerAngles(0, 0, -50);
            stage.bulb = stage.entity('light', {type: 'omni', ...options, range: 20});
            stage.bulb.setPosition(-4, 1, 9);
            stage.lamps.push(stage.sun, stage.torch, stage.bulb);
            stage.cookie = texture;
        }
        const steps = {
            shadows: () => {},
            cookie: stage => { stage.torch.light.cookie = stage.cookie; },
            'without shadows': stage => { stage.torch.light.castShadows = stage.bulb.light.castShadows = false; },
            'other light': stage => {
                stage.torch.light.type = 'omni';
                stage.lamps[3].light.range = 15;
                stage.lamps[5].light.mask = pc.MASK_AFFECT_LIGHTMAPPED;
                stage.lamps[6].enabled = false;
            },
            'no light': stage => stage.lamps.forEach(lamp => { lamp.enabled = lamp === stage.sun; }),
            'all again': stage => stage.lamps.forEach(lamp => { lamp.enabled = true; }),
        };
        const results = {};
        let last;
        for (const [name, step] of Object.entries(steps)) {
            const all = stage => stage === stages.all && step(stage);
            results[name] = {...compare('own', 'lists', step), all: compare('lists', 'all', all)};
            const now = stages.lists.draw();
            results[name].changed = last === undefined ? 1000 : difference(last, now).pixels;
            last = now;
        }
        return results;
    });
    for (const [name, {all, changed, ...own}] of Object.entries(results)) {
        same(own, name, 1);
        same(all, `${name}, all lights`);
        assert.ok(changed > 100, `${name} changes ${changed} pixels`);
    }
});

test("what is not a light in the world changes no other light; PlayCanvas' view of its cells works", async () => {
    const results = await page.evaluate(() => {
        const {lists} = stages, {lighting} = lists.app.scene;
        lists.lights(30, 20, {range: 6});
        lists.lamps[3].enabled = lists.lamps[40].enabled = false;
        const before = lists.draw();
        lists.lamps[3].enabled = lists.lamps[40].enabled = true;
        lists.lamps[3].setPosition(NaN, 0, 0);
        lists.lamps[40].light.range = Infinity;
        const bad = difference(before, lists.draw());
        lists.lamps[3].setPosition(0, 0, 0);
        lists.lamps[40].light.range = 1e9;
        lists.lamps[40].enabled = false;
        const again = difference(before, lists.draw());
        lighting.debugLayer = pc.LAYERID_WORLD;
        lists.draw();
        const seen = difference(before, lists.draw());
        lighting.debugLayer = undefined;
        return {bad, again, seen};
    });
    same(results.bad, 'bad lights');
    assert.ok(results.again.pixels > 10, 'the light is back');
    assert.ok(results.seen.pixels > 1000, 'the cells are to be seen');
});

test('where it can make no cells it lists all lights in one, says so once, and makes cells again', async () => {
    const results = await page.evaluate(() => {
        const {lists} = stages, {lighting} = lists.app.scene, results = {};
        const cells = (...counts) => { lighting.cells = new pc.Vec3(...counts); };
        lists.lights(30, 20, {range: 6});
        cells(10, 3, 10);
        const before = lists.draw();
        for (const counts of [[0, 3, 10], [10, -1, 10], [40000, 1, 1], [1000, 100, 100]]) {
            cells(...counts);
            lists.draw();
            results[counts] = difference(before, lists.draw());
            cells(10, 3, 10);
            results[`after ${counts}`] = difference(before, lists.draw());
        }
        results['an endless light'] = compare('own', 'lists', stage => {
            if (stage !== lists) stage.lights(30, 20, {range: 6});
            stage.app.scene.lighting.cells = new pc.Vec3(10, 3, 10);
            stage.lamps[3].light.range = 1e30;
        });
        return results;
    });
    for (const [name, result] of Object.entries(results)) same(result, name, name === 'an endless light' ? 1 : 0);
    const causes = [/NaN/, /at least 1 slice/, /40000/, /fit into a texture/, /2\^80/];
    const warnings = complaints.splice(0);
    assert.equal(warnings.length, causes.length, `${warnings}`);
    causes.forEach((cause, i) => assert.match(warnings[i], cause));
});

test('where PlayCanvas fails to write a light, the next frame is right', async () => {
    const {bytes, message} = await page.evaluate(() => {
        const {lists} = stages, [{lightsBuffer: buffer}] = lists.drawn, before = lists.draw();
        let message;
        buffer.addLightData = () => { throw new Error('no such light'); };
        try {
            lists.render();
        } catch (error) {
            ({message} = error);
        }
        delete buffer.addLightData;
        return {bytes: difference(before, lists.draw()), message};
    });
    assert.equal(message, 'no such light');
    same(bytes, 'the next frame');
});

test('what is refused, and dispose()', async () => {
    const results = await page.evaluate(async () => {
        const message = body => {
            try {
                body();
            } catch (error) {
                return error.message;
            }
            return '';
        };
        const {lists, own} = stages;
        const twice = message(() => new ClusteredLights(lightbin, lists.app));
        const misspelt = message(() => new ClusteredLights(lightbin, own.app, {depthtest: true}));
        const late = message(() => new ClusteredLights(lightbin, own.app));
        lists.clusters.dispose();
        const disposed = message(() => lists.render());
        for (const stage of Object.values(stages)) stage.destroy();
        return {twice, misspelt, late, disposed, allocations: lightbin.allocations};
    });
    assert.match(results.twice, /has ClusteredLights/);
    assert.match(results.misspelt, /there is no 'depthtest', but depthTest/);
    assert.match(results.late, /before the first frame/);
    assert.notEqual(results.disposed, '');
    assert.equal(results.allocations, 0);
});
