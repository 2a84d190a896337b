// SPDX-License-Identifier: MIT
// Debian's Chromium without a window, with WebGL 2 and WebGPU on a software renderer. MODULES is the folder of
// npm packages that has playwright-core.
import assert from 'node:assert/strict';
import path from 'node:path';
import {after} from 'node:test';
import {pathToFileURL} from 'node:url';
import {serve} from './server.mjs';

const {chromium} = await import(pathToFileURL(path.join(process.env.MODULES, 'playwright-core/index.mjs')));

// Nothing is looked for outside of this machine.
export const launch = () => chromium.launch({executablePath: '/usr/bin/chromium', args: [
    '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update',
    '--disable-sync', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
    '--enable-features=Vulkan', '--use-vulkan=swiftshader', '--enable-unsafe-webgpu',
    '--use-webgpu-adapter=swiftshader',
]});

/// Returns the list of errors and warnings of a page from now on. Chromium warns of its own reading of a canvas, where
/// a program draws that and not a GPU.
export function complaints_of(page) {
    const complaints = [];
    page.on('pageerror', error => complaints.push(error.stack));
    page.on('console', message => {
        if (['error', 'warning'].includes(message.type()) && !/GPU stall due to ReadPixels/.test(message.text()))
            complaints.push(message.text());
    });
    return complaints;
}

/// Opens a page of a folder, a URL, which draws nothing until it is told to, and waits for window[name]. Returns the
/// page, its complaints, and close().
export async function open(folder, name, file = 'tests/page.html') {
    const server = await serve(0, folder.pathname), browser = await launch(), page = await browser.newPage();
    const complaints = complaints_of(page);
    page.setDefaultTimeout(240000);
    await page.goto(`${server.url}${file}#still`);
    await page.waitForFunction(name => window[name] !== undefined, name)
        .catch(() => { throw new Error(complaints.join('\n')); });
    return {page, complaints, close: async () => {
        await browser.close();
        server.close();
    }};
}

/// Opens a page for the tests of a file, and closes it after them. They take out the complaints that they expect.
export async function page_of_tests(...given) {
    const {page, complaints, close} = await open(...given);
    after(async () => {
        await close();
        assert.deepEqual(complaints, []);
    });
    return {page, complaints};
}

/// Asserts of the difference() of two pictures that they are at most `apart` of 255 apart, and not dark.
export function same({most, mean, length}, what = 'a picture', apart = 0) {
    assert.ok(mean > 4, `${what} is dark: ${mean}`);
    assert.equal(length, 0, what);
    assert.ok(most <= apart, `${what}: ${most} of 255 apart`);
}
