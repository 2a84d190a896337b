// SPDX-License-Identifier: MIT
// The page in headless Chromium, with WebGL 2 and WebGPU on a software renderer. PLAYCANVAS, LIGHTBIN and PLAYWRIGHT
// are the folders of these packages.
import path from 'node:path';
import {fileURLToPath, pathToFileURL} from 'node:url';
import {serve} from '../three/server.mjs';

const {chromium} = await import(pathToFileURL(path.join(process.env.PLAYWRIGHT, 'index.mjs')));

/// Opens the page, and returns it with what its console had of errors and warnings.
export async function open() {
    const server = await serve(0, path.dirname(fileURLToPath(import.meta.url))), complaints = [];
    const browser = await chromium.launch({executablePath: '/usr/bin/chromium', args: [
        '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
        '--disable-component-update', '--disable-sync', '--use-gl=angle', '--use-angle=swiftshader',
        '--enable-unsafe-swiftshader', '--enable-features=Vulkan', '--use-vulkan=swiftshader', '--enable-unsafe-webgpu',
        '--use-webgpu-adapter=swiftshader']});
    const page = await browser.newPage();
    page.setDefaultTimeout(240000);
    page.on('pageerror', error => complaints.push(error.stack));
    page.on('console', message => {
        if (['error', 'warning'].includes(message.type()) && !/GPU stall due to ReadPixels|404/.test(message.text()))
            complaints.push(message.text());
    });
    await page.goto(`${server.url}page.html#still`);
    await page.waitForFunction(() => window.Stage !== undefined).catch(() => { throw Error(complaints.join('\n')); });
    return {page, complaints, close: async () => {
        await browser.close();
        server.close();
    }};
}
