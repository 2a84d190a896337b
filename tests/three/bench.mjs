// SPDX-License-Identifier: MIT
// node bench.mjs: frames of three.js' own lights and of the adapter's, in turns, in headless Chromium. THREE, LIGHTBIN
// and PLAYWRIGHT are the folders of these packages.
import {open} from '../browser.mjs';

const browser = await open(new URL('.', import.meta.url), 'stage');
browser.page.setDefaultTimeout(0);
const renderer = await browser.page.evaluate(async () => {
    // Two scenes, each with the materials of its own.
    window.own = new stage.constructor();
    window.lists = new stage.constructor();
    for (const scene of [own, lists]) {
        await scene.start();
        scene.model.visible = false;  // three.js' own shaders take minutes to compile for its textured materials
    }
    const gl = stage.renderer.getContext();
    return gl.getParameter(gl.getExtension('WEBGL_debug_renderer_info').UNMASKED_RENDERER_WEBGL);
});
console.log(`${renderer}, 320 x 200 pixels, medians in milliseconds
lights   three.js' own   first frame   lightbin   first frame   of it lists and uploads   largest difference of 255`);

let links = true;  // whether three.js' own shader does
for (const [points, spots, range] of [[70, 30, 4], [200, 100, 4], [700, 300, 2.5], [3500, 1500, 1.5]]) {
    const row = await browser.page.evaluate(([points, spots, range, with_own]) => {
        const time = run => {
            const begin = performance.now();
            run();
            return performance.now() - begin;
        };
        const median = times => times.sort((a, b) => a - b)[Math.floor(times.length / 2)];
        const row = {own: [], lists: [], update: []};
        for (const scene of [own, lists]) {
            scene.own();
            scene.lights(points, spots, {range});
        }
        const programs = stage.renderer.info.programs;
        if (with_own) {
            row.own_first = time(() => own.draw());
            row.links = programs.every(({diagnostics}) => diagnostics === undefined || diagnostics.runnable);
        }
        lists.cluster();
        row.lists_first = time(() => lists.draw());
        if (row.links) row.difference = difference(own.draw(), lists.draw()).most;
        const {onBeforeRender} = lists.scene;
        lists.scene.onBeforeRender = (...words) => row.update.push(time(() => onBeforeRender(...words)));
        for (let turn = 1; turn <= 15; ++turn)
            for (const [scene, times] of [[own, row.own], [lists, row.lists]]) {
                if (scene === own && !row.links) continue;
                scene.move(turn);
                times.push(time(() => scene.draw()));
            }
        for (const name of ['own', 'lists', 'update']) row[name] = median(row[name]);
        return row;
    }, [points, spots, range, links]);
    links = row.links === true;
    const number = (value, digits = 0) => (value === undefined ? '-' : value.toFixed(digits));
    console.log([points + spots, links ? number(row.own) : 'no shader', links ? number(row.own_first) : '-',
        number(row.lists), number(row.lists_first), number(row.update, 2), number(row.difference)].map(
        (text, i) => String(text).padStart([6, 15, 13, 10, 13, 25, 28][i])).join(' '));
}
await browser.close();
