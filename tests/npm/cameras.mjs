// SPDX-License-Identifier: MIT
// node tests/npm/cameras.mjs: the rows of docs/javascript.md's table of cameras for Babylon.js and gl-matrix. Views are
// made of these libraries' own matrices, and points fall into the tiles where the libraries project them. MODULES is
// the folder of both packages, LIGHTBIN that of the npm package.
import assert from 'node:assert/strict';
import path from 'node:path';
import {test} from 'node:test';
import {pathToFileURL} from 'node:url';

const from = (folder, file) => import(pathToFileURL(path.join(folder, file)));
const {load} = await from(process.env.LIGHTBIN, 'node.js');
const babylon = file => from(process.env.MODULES, `@babylonjs/core/${file}.js`);
const {NullEngine} = await babylon('Engines/nullEngine');
const {Scene} = await babylon('scene');
const {FreeCamera} = await babylon('Cameras/freeCamera');
const {Camera} = await babylon('Cameras/camera');
const {Matrix, Vector3} = await babylon('Maths/math.vector');
const {Viewport} = await babylon('Maths/math.viewport');
const {WebGPUShaderProcessorWGSL} = await babylon('Engines/WebGPU/webgpuShaderProcessorsWGSL');
const {WebGPUShaderProcessingContext} = await babylon('Engines/WebGPU/webgpuShaderProcessingContext');
const {mat4, vec4} = await from(process.env.MODULES, 'gl-matrix/esm/index.js');
const lightbin = await load();

const [width, height, tileSize, near, far] = [640, 360, 32, 0.25, 150];
const eye = [3, 2, -6], target = [-1, 1, 10];
const points = Array.from({length: 200}, (_, i) =>
    [(i * 7919 % 101 / 50 - 1) * 22, (i * 104729 % 97 / 48 - 1) * 12, i * 31 % 89 / 2 - 8]);

/// Asserts that a view of a camera has its near and far plane, and that each point which `project` returns the pixel
/// of, counted from the window's lower left corner, is listed in that pixel's tile and in few others. project(point)
/// returns null for points out of sight.
function check(options, viewMatrix, project) {
    for (const origin of ['lower-left', 'upper-left']) {
        const view = lightbin.view({...options, width, height, tileSize, origin});
        const {nearDepth, farDepth, tilesX} = view.info;
        assert.ok(Math.abs(nearDepth / near - 1) < 1e-3, `near ${nearDepth}`);
        assert.ok(Math.abs(farDepth / far - 1) < 1e-2, `far ${farDepth}`);
        for (const mistake of ['looksTransposed', 'looksLikeViewMatrix', 'looksTurned', 'looksBehind', 'looksZeroToOne',
                               'pixelsNotSquare'])
            assert.equal(view.info[mistake], 0, mistake);
        const binner = lightbin.binner(), radius = 1e-3;
        const spheres = points.flatMap(point => [...point, radius]);
        const {ranges, ids} = binner.bin(view, {viewMatrix, spheres: {array: spheres}});
        const tiles_of = points.map(() => []);
        for (let tile = 0; tile < ranges.length / 2; ++tile)
            for (let i = 0; i < ranges[2 * tile + 1]; ++i) tiles_of[ids[ranges[2 * tile] + i]].push(tile);
        let seen = 0;
        for (const [i, point] of points.entries()) {
            const pixel = project(point);
            if (pixel === null) continue;
            const y = origin === 'lower-left' ? pixel[1] : height - pixel[1];
            const tile = Math.floor(y / tileSize) * tilesX + Math.floor(pixel[0] / tileSize);
            assert.ok(tiles_of[i].includes(tile), `point ${i} at ${pixel} is in ${tiles_of[i]}, not in ${tile}`);
            assert.ok(tiles_of[i].length <= 4, `point ${i} is in ${tiles_of[i].length} tiles`);
            ++seen;
        }
        assert.ok(seen > 30 && seen < points.length, `${seen} points in sight`);
        assert.ok(tiles_of.some(tiles => tiles.length === 0));
        for (const made of [view, binner]) made.dispose();
    }
}

const ahead = target.map((at, i) => at - eye[i]), forward = ahead.map(part => part / Math.hypot(...ahead));

// A pixel well inside of the image and between near and far plane, or null.
const visible = (x, y, inside) => inside && x > 1 && y > 1 && x < width - 1 && y < height - 1 ? [x, y] : null;

for (const half of [false, true])
    for (const reversed of [false, true])
        for (const rightHanded of [false, true])
            for (const orthographic of [false, true])
                test(`Babylon.js, ${[half ? 'zero to one' : 'minus one to one', reversed ? 'reversed' : 'not reversed',
                    rightHanded ? 'right-handed' : 'left-handed',
                    orthographic ? 'orthographic' : 'perspective'].join(', ')}`, () => {
                    const engine = new NullEngine({renderWidth: width, renderHeight: height, textureSize: 64});
                    engine.isNDCHalfZRange = half;  // as WebGPUEngine has it
                    engine.useReverseDepthBuffer = reversed;
                    const scene = new Scene(engine);
                    scene.useRightHandedSystem = rightHanded;
                    const camera = new FreeCamera('camera', new Vector3(...eye), scene);
                    camera.setTarget(new Vector3(...target));
                    [camera.minZ, camera.maxZ] = [near, far];
                    if (orthographic) {
                        camera.mode = Camera.ORTHOGRAPHIC_CAMERA;
                        [camera.orthoLeft, camera.orthoRight, camera.orthoBottom, camera.orthoTop] = [-16, 16, -9, 9];
                    }
                    scene.setTransformMatrix(camera.getViewMatrix(), camera.getProjectionMatrix());
                    const window = new Viewport(0, 0, width, height);
                    check({
                        projection: scene.getProjectionMatrix().m,
                        clipDepth: engine.isNDCHalfZRange ? 'zero-to-one' : 'minus-one-to-one',
                        reversedZ: engine.useReverseDepthBuffer,
                    }, scene.getViewMatrix().m, point => {
                        const {x, y} = Vector3.Project(new Vector3(...point), Matrix.Identity(),
                            scene.getTransformMatrix(), window);  // y counts from the upper side
                        const depth = point.reduce((sum, at, i) => sum + (at - eye[i]) * forward[i], 0);
                        return visible(x, height - y, depth > near + 0.1 && depth < far - 1);
                    });
                    engine.dispose();
                });

// yFactor_ is 1 on the canvas and -1 in textures. Either way y = 0 is where NDC y is -1: the view's lower left corner.
test('Babylon.js, WebGPU: shaders count pixels from the lower side', () => {
    const processor = new WebGPUShaderProcessorWGSL();
    processor.initializeShaders(new WebGPUShaderProcessingContext(1, false));
    const {vertexCode, fragmentCode} = processor.finalizeShaders(
        '@vertex\nfn main(input : VertexInputs) -> FragmentInputs {\nvertexOutputs.position = vec4f(1.0);\n}',
        '@fragment\nfn main(input : FragmentInputs) -> FragmentOutputs {\n'
            + 'fragmentOutputs.color = fragmentInputs.position;\n}');
    const in_order = (code, ...lines) => lines.reduce((at, line) => {
        const found = code.indexOf(line, at);
        assert.ok(found >= 0, `${line} is not in ${code}`);
        return found;
    }, 0);
    in_order(vertexCode, 'vertexOutputs.position = vec4f(1.0);',
        'vertexOutputs.position.y = vertexOutputs.position.y * internals.yFactor_;', 'return vertexOutputs;');
    in_order(fragmentCode, 'if (internals.yFactor_ == 1.) {',
        'fragmentInputs.position.y = internals.textureOutputHeight_ - fragmentInputs.position.y;',
        'fragmentOutputs.color = fragmentInputs.position;');
});

for (const [name, range] of [['perspective', -1], ['perspectiveNO', -1], ['perspectiveZO', 0], ['ortho', -1],
                             ['orthoNO', -1], ['orthoZO', 0]])
    test(`gl-matrix, ${name}()`, () => {
        const projection = name.startsWith('ortho') ? mat4[name](mat4.create(), -16, 16, -9, 9, near, far)
            : mat4[name](mat4.create(), 0.9, width / height, near, far);
        const viewMatrix = mat4.lookAt(mat4.create(), eye, target, [0, 1, 0]);
        check({projection, ...range === 0 && {clipDepth: 'zero-to-one'}}, viewMatrix, point => {
            const [x, y, z, w] = vec4.transformMat4(vec4.create(), [...point, 1],
                mat4.multiply(mat4.create(), projection, viewMatrix));
            return visible((x / w + 1) * width / 2, (y / w + 1) * height / 2,
                w > 0 && z > (range + 1e-3) * w && z < 0.9999 * w);
        });
    });
