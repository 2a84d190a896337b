// SPDX-License-Identifier: MIT
// The page in a browser: a server of build/web on this machine, and what a test does with a page.
import {spawn} from 'node:child_process';
import {once} from 'node:events';
import {complaints_of, launch} from '../browser.mjs';

const folder = new URL('../../build/web/', import.meta.url);
export const pictures = new URL('../../build/web-tests/', import.meta.url);

// What examples/web.sh serves with.
async function serve() {
    const program = new URL('../../examples/web/serve.py', import.meta.url);
    const server = spawn('python3', [program.pathname, folder.pathname, '0']);
    const [line] = await once(server.stdout, 'data');
    return {url: String(line).match(/http:\S+/)[0], close: () => server.kill()};
}

export class Browser {
    static async start() {
        return new Browser(await serve(), await launch());
    }

    constructor(server, browser) {
        this.server = server;
        this.browser = browser;
    }

    async close() {
        await this.browser.close();
        this.server.close();
    }

    // A page, until the test ends, that has drawn its first picture, or said why it can't. `before`: what runs in the
    // page before its own script. `complaints` are what the console has of errors and warnings.
    async open(test, hash, {width = 720, height = 400, touch = false, before = () => {}, ...options} = {}) {
        const context = await this.browser.newContext({
            viewport: {width, height}, hasTouch: touch, isMobile: touch, deviceScaleFactor: touch ? 2 : 1, ...options});
        test.after(() => context.close());
        const page = await context.newPage();
        page.complaints = complaints_of(page);
        await page.addInitScript(before);
        await page.goto(`${this.server.url}#${hash}`);
        await page.waitForFunction(() => performance.getEntriesByName('first picture').length > 0
            || document.body.classList.contains('cannot'));
        return page;
    }
}

export const text_of = (page, id) => page.locator('#' + id).textContent();

// Waits until the text of an element says what it should, and returns it.
export async function wait_for_text(page, id, pattern) {
    const handle = await page.waitForFunction(([id, source]) => {
        const text = document.getElementById(id).textContent;
        return new RegExp(source).test(text) && [text];
    }, [id, pattern.source]);
    return (await handle.jsonValue())[0];
}

export async function set_slider(page, id, value) {
    await page.locator('#' + id).evaluate((slider, value) => {
        slider.value = value;
        slider.dispatchEvent(new Event('input', {bubbles: true}));
    }, value);
}

// The page's own comparison with every light: what it says in the end.
export async function compare(page) {
    await page.locator('#compare').click();
    return wait_for_text(page, 'verdict', /same picture|differ/i);
}

// Drops a file on the page.
export async function drop(page, name, bytes) {
    await page.evaluate(([name, bytes]) => {
        const files = new DataTransfer();
        files.items.add(new File([Uint8Array.from(atob(bytes), c => c.charCodeAt(0))], name));
        document.body.dispatchEvent(new DragEvent('drop', {dataTransfer: files, bubbles: true, cancelable: true}));
    }, [name, Buffer.from(bytes).toString('base64')]);
}

// What the stage shows, without what lies over it: red, green and blue of each pixel.
export async function picture(page) {
    const style = 'body > :not(main), main > :not(#stage) { visibility: hidden; }';
    const png = await page.locator('#stage').screenshot({style});
    const text = await page.evaluate(async png => {
        const bytes = Uint8Array.from(atob(png), c => c.charCodeAt(0));
        const bitmap = await createImageBitmap(new Blob([bytes]));
        const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
        context.drawImage(bitmap, 0, 0);
        const rgb = context.getImageData(0, 0, bitmap.width, bitmap.height).data.filter((_, i) => i % 4 !== 3);
        let text = '';
        for (let at = 0; at < rgb.length; at += 30000)
            text += btoa(String.fromCharCode(...rgb.subarray(at, at + 30000)));
        return text;
    }, png.toString('base64'));
    return Buffer.from(text, 'base64');
}

// Of two pictures, a byte; of one, how bright it is.
export function mean_difference(a, b = Buffer.alloc(a.length)) {
    let sum = 0;
    for (let i = 0; i < a.length; ++i) sum += Math.abs(a[i] - b[i]);
    return sum / a.length;
}
