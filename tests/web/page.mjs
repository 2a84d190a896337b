// SPDX-License-Identifier: MIT
// The page as a whole: it loads without complaint, says what is wrong and lives on, and fits a phone.
import assert from 'node:assert/strict';
import {readFile} from 'node:fs/promises';
import {after, before, test} from 'node:test';
import {
    Browser, compare, drop, mean_difference, picture, pictures, set_slider, text_of, wait_for_text,
} from './browser.mjs';

const small = 'lights=100&size=20&tile=16';
let browser;
before(async () => { browser = await Browser.start(); });
after(() => browser.close());

const fixture = name => readFile(new URL(`../fixtures/${name}`, import.meta.url));
const screenshot = (page, name) => page.screenshot({path: new URL(`${name}.png`, pictures).pathname});

test('it loads without a complaint, and soon has a picture', async t => {
    const page = await browser.open(t, '', {width: 1280, height: 720});
    const first = await page.evaluate(() => performance.getEntriesByName('first picture')[0].startTime);
    console.log(`first picture after ${Math.round(first)} ms`);
    await wait_for_text(page, 'stats', /^10,000 lights, [0-9,]+ in view, \d+ a cluster at most, bin\s\d+\.\d\d\sms$/);
    await page.waitForTimeout(1500);
    await screenshot(page, 'desktop');
    assert.equal(await text_of(page, 'alert'), '');
    assert.deepEqual(page.complaints, []);
});

test('pictures to look at', async t => {
    const page = await browser.open(t, 'lights=3000&size=50&tile=16&look=heat&move=0', {width: 1280, height: 720});
    await screenshot(page, 'heat_map');
    const lacking = await browser.open(t, 'lights=100&size=50&tile=16&move=0&drop=0', {width: 1280, height: 720});
    await compare(lacking);
    await screenshot(lacking, 'differences');
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

test('a good file takes away what was said of a broken one', async t => {
    const page = await browser.open(t, small);
    await drop(page, 'broken.glb', Buffer.from('This is no scene.'));
    await wait_for_text(page, 'alert', /./);
    await drop(page, 'mine.glb', await fixture('nova.glb'));
    await wait_for_text(page, 'stats', /^255 lights/);
    assert.equal(await text_of(page, 'alert'), '');
});

test('an address that makes no sense does no harm', async t => {
    const page = await browser.open(t, small + '&view=0.5&tile=13.7&lights=12.5&at=1,2&stops=x&scene=file');
    await wait_for_text(page, 'stats', /^100 lights/);
    assert.equal(await text_of(page, 'tile_out'), '16 pixels');
    assert.equal(await page.locator('#view').inputValue(), '0');
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

test('without WebGPU it can\'t be chosen, and the reason is given', async t => {
    const page = await browser.open(t, small + '&renderer=webgpu',
        {before: () => Object.defineProperty(navigator, 'gpu', {value: undefined})});
    await wait_for_text(page, 'refused', /^WebGPU can't be had here/);
    assert.ok(await page.locator('#renderer option[value=webgpu]').isDisabled());
    await wait_for_text(page, 'frame', /^WebGL 2/);
    assert.deepEqual(page.complaints, []);
});

test('WebGPU has no z-bins, and the reason is given', async t => {
    const page = await browser.open(t, small + '&renderer=webgpu&method=z_bins');
    await wait_for_text(page, 'refused', /^Z-bins can't be had in WebGPU/);
    assert.ok(await page.locator('#method option[value=z_bins]').isDisabled());
    assert.equal(await page.locator('#method').inputValue(), 'clusters');
    await page.locator('#renderer').selectOption('webgl');
    await wait_for_text(page, 'refused', /^$/);
    assert.ok(!await page.locator('#method option[value=z_bins]').isDisabled());
    assert.deepEqual(page.complaints, []);
});

test('without float targets there are no Z bounds, and the reason is given', async t => {
    const page = await browser.open(t, small + '&method=box', {before: () => {
        const get_extension = WebGL2RenderingContext.prototype.getExtension;
        WebGL2RenderingContext.prototype.getExtension = function (name) {
            return name === 'EXT_color_buffer_float' ? null : get_extension.call(this, name);
        };
    }});
    await wait_for_text(page, 'refused', /EXT_color_buffer_float/);
    assert.ok(await page.locator('#method option[value=box]').isDisabled());
    assert.equal(await page.locator('#method').inputValue(), 'clusters');
    assert.match(await compare(page), /^The same picture/);
});

test('without a clock of the GPU drawing is measured until it is done, and still shown', async t => {
    const page = await browser.open(t, small, {before: () => {
        const get_extension = WebGL2RenderingContext.prototype.getExtension;
        WebGL2RenderingContext.prototype.getExtension = function (name) {
            return name.includes('timer_query') ? null : get_extension.call(this, name);
        };
    }});
    await wait_for_text(page, 'costs_note', /until the GPU is done/);
    assert.ok(mean_difference(await picture(page)) > 30);
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
        await screenshot(page, `phone_${width}_folded`);
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
        await page.locator('#panel').evaluate(panel => panel.scrollTo(0, 0));
        await screenshot(page, `phone_${width}`);
        assert.deepEqual(page.complaints, []);
    });
