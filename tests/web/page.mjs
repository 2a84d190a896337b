// SPDX-License-Identifier: MIT
// The page: it loads without complaint, its controls do what they say, it says what is wrong and lives on, and it fits
// a phone.
import assert from 'node:assert/strict';
import {readFile} from 'node:fs/promises';
import {after, before, test} from 'node:test';
import {
    Browser, compare, drop, mean_difference, picture, pictures, set_slider, text_of, wait_for_text,
} from './browser.mjs';

const small = 'lights=100&size=20&tile=16', still = small + '&move=0';
let browser;
before(async () => { browser = await Browser.start(); });
after(() => browser.close());

const fixture = name => readFile(new URL(`../fixtures/${name}`, import.meta.url));
const screenshot = (page, name) => page.screenshot({path: new URL(`${name}.png`, pictures).pathname});
const address_has = (page, words) => page.waitForFunction(words => location.hash.includes(words), words);

test('it loads without a complaint, and soon has a picture', async t => {
    const page = await browser.open(t, '', {width: 1280, height: 720});
    await wait_for_text(page, 'stats', /^10,000 lights, [0-9,]+ in view, \d+ a cluster at most, bin\s\d+\.\d\d\sms$/);
    await page.waitForTimeout(1500);
    await screenshot(page, 'desktop');
    assert.equal(await text_of(page, 'alert'), '');
    assert.deepEqual(page.complaints, []);
});

test('the slider of lights changes the lights and their lists', async t => {
    const page = await browser.open(t, small);
    const [few] = (await text_of(page, 'stats')).match(/\d+ a cluster/);
    await set_slider(page, 'lights', 500);
    const stats = await wait_for_text(page, 'stats', /^890 lights/);
    assert.ok(parseInt(stats.match(/(\d+) a cluster/)[1]) > parseInt(few), stats);
    await set_slider(page, 'lights', 1000);
    await wait_for_text(page, 'stats', /^50,000 lights/);
    assert.match(page.url(), /lights=50000/);
    assert.deepEqual(page.complaints, []);
});

test('tile size and depth method change the grid', async t => {
    const page = await browser.open(t, small);
    await wait_for_text(page, 'frame', /144 × 80 pixels, 9 × 5 tiles/);
    await set_slider(page, 'tile', 8);
    await wait_for_text(page, 'frame', / 18 × 10 tiles/);
    assert.equal(await text_of(page, 'tile_out'), '8 pixels');
    for (const [method, word] of Object.entries({z_bins: 'tile', clusters: 'cluster', z_bounds: 'tile'})) {
        await page.locator('#method').selectOption(method);
        await wait_for_text(page, 'stats', new RegExp(`a ${word} at most`));
    }
    // Only bounds want a depth pre-pass, and the plot says what it takes.
    await page.waitForFunction(() => parseFloat(document.querySelector('#costs b').textContent) > 0);
});

test('resolution, brightness and look change the picture', async t => {
    const page = await browser.open(t, still);
    await page.locator('#size').selectOption('50');
    await wait_for_text(page, 'frame', /360 × 200 pixels/);
    const as_metered = await picture(page);
    await set_slider(page, 'stops', 3);
    assert.equal(await text_of(page, 'stops_out'), '+3 stops');
    await address_has(page, 'stops=3');
    assert.ok(mean_difference(await picture(page)) > 1.3 * mean_difference(as_metered));
    await page.locator('#look').selectOption('heat');
    await page.locator('#heat_legend').waitFor();
    assert.ok(mean_difference(await picture(page), as_metered) > 10);
    assert.match(await text_of(page, 'heat_legend'), /^0 lights a pixel [1-9]/);
    await page.locator('#look').selectOption('check');
    await page.locator('#check_legend').waitFor();
});

test('the list check is magenta where a list lacks a light, and nowhere else', async t => {
    const magenta = async hash => {
        const seen = await picture(await browser.open(t, hash));
        let found = 0;
        for (let i = 0; i < seen.length; i += 3) found += seen[i] > 200 && seen[i + 1] < 50 && seen[i + 2] > 200;
        return found;
    };
    for (const renderer of ['webgl', 'webgpu']) {
        const few = `lights=16&view=2&size=20&tile=16&look=check&move=0&renderer=${renderer}`;
        assert.equal(await magenta(few), 0, few);
        assert.ok(await magenta(few + '&drop=3') > 10, few);
    }
});

test('lights move until they are stopped', async t => {
    const page = await browser.open(t, small);
    const earlier = await picture(page);
    await page.waitForTimeout(300);
    assert.notDeepEqual(await picture(page), earlier);
    await page.locator('#move').uncheck();
    await address_has(page, 'move=0');
    const stopped = await picture(page);
    await page.waitForTimeout(300);
    assert.deepEqual(await picture(page), stopped);
});

// Waits until the address tells another place, and returns its numbers: x, y, z, yaw, pitch, distance.
async function moved_from(page, before) {
    const at = await page.waitForFunction(before => {
        const at = new URLSearchParams(location.hash.slice(1)).get('at') ?? '';
        return at !== '' && at !== before && at;
    }, before);
    return (await at.jsonValue()).split(',').map(Number);
}

test('the mouse turns, moves sideways and zooms', async t => {
    const page = await browser.open(t, still);
    const drag = async button => {
        await page.mouse.move(200, 200);
        await page.mouse.down({button});
        await page.mouse.move(260, 230, {steps: 4});
        await page.mouse.up({button});
    };
    await drag('left');
    const turned = await moved_from(page, '');
    assert.ok(Math.hypot(turned[0] + 40, turned[2] - 60) > 5, `it orbits, so it moves: ${turned}`);
    await drag('right');
    const panned = await moved_from(page, turned.join());
    assert.deepEqual(panned.slice(3, 5), turned.slice(3, 5));
    await page.mouse.wheel(0, -400);
    const zoomed = await moved_from(page, panned.join());
    assert.ok(zoomed[1] < panned[1], 'looking down, nearer is lower');
    assert.ok(zoomed[5] < panned[5]);
});

test('keys fly, choose cameras and reach the main controls', async t => {
    const page = await browser.open(t, still);
    await page.keyboard.down('w');
    const flown = await moved_from(page, '');
    await page.keyboard.up('w');
    assert.ok(Math.hypot(flown[0] + 40, flown[1] - 30, flown[2] - 60) > 0.01);
    await page.keyboard.press('2');
    await page.waitForFunction(() => location.hash.includes('view=1') && !location.hash.includes('at='));
    for (const [key, id, value] of [['h', 'look', 'heat'], ['m', 'method', 'z_bounds'], [']', 'tile', '24']]) {
        await page.keyboard.press(key);
        assert.equal(await page.locator('#' + id).inputValue(), value, key);
    }
    await page.keyboard.press('+');
    await wait_for_text(page, 'lights_out', /^1[1-9]\d$/);
    for (const [key, id, shown] of [['p', 'panel', false], ['?', 'keys', true], ['Escape', 'keys', false]]) {
        await page.keyboard.press(key);
        assert.equal(await page.locator('#' + id).isVisible(), shown, key);
    }
});

test('a link restores what it was made of', async t => {
    const hash = 'scene=street&view=1&move=0&method=z_bins&tile=24&look=heat&size=25&stops=1.5';
    const page = await browser.open(t, hash);
    await wait_for_text(page, 'stats', /^598 lights/);
    const values = {scene: 'street', view: '1', method: 'z_bins', look: 'heat', size: '25', stops: '1.5'};
    for (const [id, value] of Object.entries(values))
        assert.equal(await page.locator('#' + id).inputValue(), value, id);
    assert.deepEqual(new URL(page.url()).hash.slice(1).split('&').sort(), hash.split('&').sort());
});

const broken = {
    'a text': async () => Buffer.from('This is no scene.'),
    'an empty file': async () => Buffer.alloc(0),
    'a file cut short': async () => (await fixture('nova.glb')).subarray(0, 100000),
};
for (const [what, bytes] of Object.entries(broken))
    test(`${what} instead of a .glb gives a sentence, and the page lives on`, async t => {
        const page = await browser.open(t, small);
        await drop(page, 'broken.glb', await bytes());
        assert.match(await wait_for_text(page, 'alert', /./), /^Can't show 'broken\.glb': .{10,}[^.]\.$/);
        assert.ok(await page.locator('#alert').isVisible());
        assert.match(await compare(page), /^The same picture/);
        assert.match(await text_of(page, 'stats'), /^100 lights/);
        await drop(page, 'mine.glb', await fixture('nova.glb'));
        await wait_for_text(page, 'stats', /^255 lights/);
        assert.equal(await text_of(page, 'alert'), '');
        assert.deepEqual(page.complaints, []);
    });

test('a .glb can be dropped, or opened by the button', async t => {
    const page = await browser.open(t, small);
    await drop(page, 'mine.glb', await fixture('nova.glb'));
    await wait_for_text(page, 'stats', /^255 lights/);
    assert.equal(await page.locator('#scene').inputValue(), 'file');
    assert.match(await compare(page), /^The same picture/);
    await page.locator('#file').setInputFiles({name: 'other.glb', mimeType: '', buffer: await fixture('darkness.glb')});
    await wait_for_text(page, 'stats', /^226 lights/);
    await page.locator('#scene').selectOption('city');
    await wait_for_text(page, 'stats', /^100 lights/);
    assert.deepEqual(page.complaints, []);
});

test('where the first picture can\'t be drawn, another tile size helps', async t => {
    const page = await browser.open(t, 'lights=100&size=200&tile=1&move=0', {width: 1280, height: 720});
    await wait_for_text(page, 'alert', /use larger tiles/);
    await page.locator('#size').selectOption('25');
    await set_slider(page, 'tile', 64);
    await wait_for_text(page, 'stats', /^100 lights/);
    assert.equal(await text_of(page, 'alert'), '');
});

const lacks = {
    'WebGL 2': [/has no WebGL 2/, () => {
        const get_context = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
            return kind === 'webgl2' ? null : get_context.call(this, kind, ...rest);
        };
    }],
    'exceptions in WebAssembly': [/no exceptions/, () => {
        for (const name of ['instantiate', 'instantiateStreaming', 'compile', 'compileStreaming'])
            WebAssembly[name] = () => Promise.reject(new WebAssembly.CompileError('no exceptions'));
    }],
};
for (const [what, [sentence, before]] of Object.entries(lacks))
    test(`without ${what} it says so`, async t => {
        const page = await browser.open(t, small, {before});
        const said = await text_of(page, 'alert');
        assert.match(said, sentence);
        assert.match(said, /Chrome or Edge|Firefox/);
        assert.ok(!await page.locator('#panel').isVisible());
        assert.deepEqual(page.complaints, []);
    });

// What is asked for in the address, why it is refused, the choice that is not to be had, and what is taken instead.
const refusals = {
    'without WebGPU': ['renderer=webgpu', /^WebGPU can't be had here/, 'renderer', 'webgpu', 'webgl',
        () => Object.defineProperty(navigator, 'gpu', {value: undefined})],
    'with WebGPU, which has no z-bins': ['renderer=webgpu&method=z_bins', /^Z-bins can't be had in WebGPU/, 'method',
        'z_bins', 'clusters'],
    'without float targets': ['method=z_bounds', /EXT_color_buffer_float/, 'method', 'z_bounds', 'clusters', () => {
        const get_extension = WebGL2RenderingContext.prototype.getExtension;
        WebGL2RenderingContext.prototype.getExtension = function (name) {
            return name === 'EXT_color_buffer_float' ? null : get_extension.call(this, name);
        };
    }],
};
for (const [what, [asked, reason, id, value, instead, before]] of Object.entries(refusals))
    test(`${what} not all can be chosen, and the reason is given`, async t => {
        const page = await browser.open(t, `${small}&${asked}`, {before});
        await wait_for_text(page, 'refused', reason);
        assert.ok(await page.locator(`#${id} option[value=${value}]`).isDisabled());
        assert.equal(await page.locator('#' + id).inputValue(), instead);
        assert.match(await compare(page), /^The same picture/);
        assert.deepEqual(page.complaints, []);
    });

test('it says when the graphics context is lost, and goes on when it is back', async t => {
    const page = await browser.open(t, small);
    await page.evaluate(() => {
        const gl = document.querySelector('#stage canvas').getContext('webgl2');
        globalThis.way_back = gl.getExtension('WEBGL_lose_context');
        globalThis.way_back.loseContext();
    });
    await wait_for_text(page, 'alert', /took the graphics context away/);
    await page.evaluate(() => globalThis.way_back.restoreContext());
    await wait_for_text(page, 'alert', /^$/);
    assert.match(await compare(page), /^The same picture/);
});

test('it goes on with WebGL 2 where a device of WebGPU is lost', async t => {
    const page = await browser.open(t, small + '&renderer=webgpu', {before: () => {
        const request_device = GPUAdapter.prototype.requestDevice;
        GPUAdapter.prototype.requestDevice = async function (options) {
            return globalThis.device = await request_device.call(this, options);
        };
    }});
    await wait_for_text(page, 'frame', /^WebGPU/);
    await page.evaluate(() => globalThis.device.destroy());
    await wait_for_text(page, 'frame', /^WebGL 2/);
    await wait_for_text(page, 'refused', /WebGPU can't be had here: .*lost/);
    assert.match(await compare(page), /^The same picture/);
});

for (const [width, height] of [[390, 844], [360, 640], [844, 390]])
    test(`a screen of ${width} x ${height} has room for all of it`, async t => {
        const page = await browser.open(t, small, {width, height, touch: true});
        if (await page.locator('#fold').getAttribute('aria-expanded') === 'false') await page.locator('#fold').tap();
        const problems = await page.evaluate(() => {
            const kinds = '#fold, #panel :is(select, button, input[type=range], .check)';
            const controls = [...document.querySelectorAll(kinds)];
            const {documentElement: whole} = document, panel = document.getElementById('panel');
            const box = element => element.getBoundingClientRect();
            const side = control => Math.min(box(control).width, box(control).height);
            const is_small = control => side(control) > 0 && side(control) < 39.5;
            const sticks_out = element => box(element).left < 0 || box(element).right > innerWidth + 0.5;
            return [
                ...[whole, panel].filter(element => element.scrollWidth > element.clientWidth),
                ...controls.filter(is_small),
                ...[panel, document.getElementById('summary'), ...controls].filter(sticks_out),
            ].map(element => element.id || element.textContent);
        });
        assert.deepEqual(problems, []);
        await screenshot(page, `phone_${width}`);
        assert.deepEqual(page.complaints, []);
    });
