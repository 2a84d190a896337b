// SPDX-License-Identifier: MIT
// node server.mjs PORT: serves this folder, and the packages in the folders THREE and LIGHTBIN, to this machine alone.
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import {fileURLToPath} from 'node:url';

const here = path.dirname(fileURLToPath(import.meta.url));
const folders = {three: process.env.THREE, lightbin: process.env.LIGHTBIN, fixtures: path.join(here, '../fixtures')};
const types = {'.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm'};

/// Returns the address of the server, once it listens.
export async function serve(port = 0) {
    const server = http.createServer((request, response) => {
        const [, first, ...rest] = decodeURI(new URL(request.url, 'http://localhost').pathname).split('/');
        const folder = folders[first] ?? here, file = path.join(folder, ...folder === here ? [first] : rest);
        if (!file.startsWith(folder) || !fs.statSync(file,
            {throwIfNoEntry: false})?.isFile()) return response.writeHead(404).end();
        response.writeHead(200, {'Content-Type': types[path.extname(file)] ?? 'application/octet-stream'});
        fs.createReadStream(file).pipe(response);
    });
    await new Promise(resolve => server.listen(port, '127.0.0.1', resolve));
    return {url: `http://localhost:${server.address().port}/`, close: () => server.close()};
}

if (process.argv[1] === fileURLToPath(import.meta.url))
    console.log(`${(await serve(Number(process.argv[2]))).url}page.html`);
