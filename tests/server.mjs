// SPDX-License-Identifier: MIT
// node server.mjs PORT FOLDER: serves a folder, and as /modules/, /lightbin/ and /tests/ the folders MODULES, LIGHTBIN
// and this one, to this machine alone.
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import {fileURLToPath} from 'node:url';

const folders = {modules: process.env.MODULES, lightbin: process.env.LIGHTBIN,
                 tests: path.dirname(fileURLToPath(import.meta.url))};
const types = {'.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm'};
// With these a page's clock has steps of 5 microseconds, and else of 100.
const isolated = {'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp'};

/// Returns the address of the server, once it listens.
export async function serve(port, here) {
    const server = http.createServer((request, response) => {
        const [, first, ...rest] = decodeURI(new URL(request.url, 'http://localhost').pathname).split('/');
        const folder = folders[first] ?? here, file = path.join(folder, ...folder === here ? [first] : rest);
        const found = file.startsWith(folder) && fs.statSync(file, {throwIfNoEntry: false})?.isFile();
        if (!found) return response.writeHead(404).end();
        response.writeHead(200, {'Content-Type': types[path.extname(file)] ?? 'application/octet-stream', ...isolated});
        fs.createReadStream(file).pipe(response);
    });
    await new Promise(resolve => server.listen(port, '127.0.0.1', resolve));
    return {url: `http://localhost:${server.address().port}/`, close: () => server.close()};
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
    const [, , port, folder] = process.argv;
    console.log(`${(await serve(Number(port), path.resolve(folder))).url}tests/page.html`);
}
