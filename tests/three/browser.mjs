// SPDX-License-Identifier: MIT
// Chromium without a window, with the page of this folder in it. PLAYWRIGHT is the folder of that package.
import path from 'node:path';
import {pathToFileURL} from 'node:url';
import {serve} from './server.mjs';

const {chromium} = await import(pathToFileURL(path.join(process.env.PLAYWRIGHT, 'index.mjs')));

/// Returns the page, which draws nothing until it is told to; `complaints`, to which errors and warnings are added; and
/// close().
export async function open() {
    const server = await serve(), complaints = [];
    const browser = await chromium.launch({executablePath: '/usr/bin/chromium', args: [
        '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
        '--disable-component-update', '--disable-sync', '--use-gl=angle', '--use-angle=swiftshader',
        '--enable-unsafe-swiftshader']});
    const page = await browser.newPage();
    page.setDefaultTimeout(240000);
    page.on('pageerror', error => complaints.push(error.stack));
    page.on('console', message => {
        if (['error', 'warning'].includes(message.type()) && !/GPU stall due to ReadPixels|404/.test(message.text()))
            complaints.push(message.text());
    });
    await page.goto(`${server.url}page.html#still`);
    await page.waitForFunction(() => window.stage !== undefined)
        .catch(() => { throw new Error(complaints.join('\n')); });
    return {page, complaints, close: async () => {
        await browser.close();
        server.close();
    }};
}
