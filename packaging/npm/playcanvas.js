// SPDX-License-Identifier: MIT
// Clustered lights for PlayCanvas: its grid of cells in world space, with lists that lightbin makes.
// playcanvas.d.ts describes what is exported.
import {
    LIGHTTYPE_SPOT, PIXELFORMAT_R32U, PIXELFORMAT_RGBA32F, SHADERLANGUAGE_GLSL, SHADERLANGUAGE_WGSL,
    ShaderChunks, Vec3, WorldClusters,
} from 'playcanvas';
import {warner} from './adapters.js';

// PlayCanvas has one light in each row of its texture of lights, which limits their number. Here a row has this many.
const lights_per_row = 64, words_per_row = 2048;

// What PlayCanvas' shader does, and what it does here, in each language: the place of a light in the texture, and the
// loop over a cell's lights. PlayCanvas gives each cell room in its texture for the same number of lights, up to 255,
// and numbers the lights from 1. Here a cell has room for two words, which are where its list begins and how long it
// is; the lists follow after the last cell. One texture holds both, as each upload has its own cost.
const changes = {
    [SHADERLANGUAGE_GLSL]: [
        ['uniform highp usampler2D clusterWorldTexture;', text => `${text}
    uint lightbin_word(uint at) {
        return texelFetch(clusterWorldTexture, ivec2(at % ${words_per_row}u, at / ${words_per_row}u), 0).x;
    }`],
        ['ivec2(index, lightIndex)', `ivec2(lightIndex % ${lights_per_row} * {CLUSTER_TEXTURE_COUNT} + index,
        lightIndex / ${lights_per_row})`],
        [/for \(int lightCellIndex = 0;[^{]*\{[^;]*;\s*if \(lightIndex == 0u\)\s*break;/, `
        uint lightbin_cell = uint(cellIndex), lightbin_begin = lightbin_word(lightbin_cell)
            + uint(2 * clusterCellsMax.x * clusterCellsMax.y * clusterCellsMax.z);
        uint lightbin_end = lightbin_begin + lightbin_word(lightbin_cell + 1u);
        for (uint lightbin_at = lightbin_begin; lightbin_at < lightbin_end; ++lightbin_at) {
            uint lightIndex = 1u + lightbin_word(lightbin_at);`],
    ],
    [SHADERLANGUAGE_WGSL]: [
        ['var clusterWorldTexture: texture_2d<u32>;', text => `${text}
    fn lightbin_word(at: u32) -> u32 {
        return textureLoad(clusterWorldTexture, vec2<u32>(at % ${words_per_row}u, at / ${words_per_row}u), 0).r;
    }`],
        ['vec2<i32>(index, lightIndex)', `vec2<i32>(lightIndex % ${lights_per_row} * {CLUSTER_TEXTURE_COUNT} + index,
        lightIndex / ${lights_per_row})`],
        [/for \(var lightCellIndex: i32 = 0;[^{]*\{[^;]*;\s*if \(lightIndex == 0u\) \{\s*break;\s*\}/, `
        let lightbin_cells: vec3i = uniform.clusterCellsMax;
        let lightbin_begin: u32 = lightbin_word(u32(cellIndex))
            + u32(2 * lightbin_cells.x * lightbin_cells.y * lightbin_cells.z);
        let lightbin_end: u32 = lightbin_begin + lightbin_word(u32(cellIndex) + 1u);
        for (var lightbin_at: u32 = lightbin_begin; lightbin_at < lightbin_end; lightbin_at++) {
            let lightIndex: u32 = 1u + lightbin_word(lightbin_at);`],
    ],
};

const updates = new WeakMap();  // of graphics devices: what stands in for WorldClusters.update()

/// Makes the clusters of devices that have an update call it.
let patch = () => {
    patch = () => {};
    const own = WorldClusters.prototype.update;
    WorldClusters.prototype.update = function(lights, params) {
        const update = updates.get(this.device);
        if (update !== undefined)
            update(this, lights, params ?? {});
        else
            own.call(this, lights, params);
    };
};

export class ClusteredLights {
    #lightbin;
    #binner;
    #view;
    #slices;
    #edges = [];
    #floats;
    #texels;  // of a light in PlayCanvas' texture
    #warn = warner("lists all lights in one cell where it can't make scene.lighting.cells");

    constructor(lightbin, app, {depthTest = false, ...others} = {}) {
        for (const key in others) throw new Error(`options: there is no '${key}', but depthTest`);
        const device = app.graphicsDevice, {empty} = app.renderer.worldClustersAllocator;
        if (updates.has(device)) throw new Error('this application has ClusteredLights');
        if (app.frame > 0) throw new Error('ClusteredLights must be made before the first frame, which makes shaders');
        this.#binner = lightbin.binner({slicing: 'clusters', depthTest});
        this.#floats = lightbin.floats(1024);
        this.#lightbin = lightbin;
        for (const language in changes) this.#change(ShaderChunks.get(device, language), changes[language]);
        updates.set(device, this.#update.bind(this));
        patch();
        empty.update([]);  // what layers without lights read
    }

    dispose() {
        for (const made of [this.#binner, this.#view, this.#slices, this.#floats]) made?.dispose();
    }

    #change(chunks, changes) {
        const text = changes.reduce((before, [what, by]) => {
            const after = before.replace(what, by);
            if (after === before) throw new Error(`this version of PlayCanvas has other shaders: no ${what}`);
            return after;
        }, chunks.get('clusteredLightPS'));
        this.#texels = Number(chunks.get('lightBufferDefinesPS').match(/\{CLUSTER_TEXTURE_COUNT\} (\d+)/)[1]);
        chunks.set('clusteredLightPS', text);
    }

    /// Makes and uploads the lists of `lights`. PlayCanvas' own functions find the lights that are to be drawn, the
    /// bounds of the cells, and what the texture says of a light.
    #update(clusters, lights, params) {
        const buffer = clusters.lightsBuffer;
        if (buffer.maxLights !== Infinity) Object.defineProperty(buffer, 'maxLights', {value: Infinity});
        buffer.cookiesEnabled = params.cookiesEnabled;
        buffer.shadowsEnabled = params.shadowsEnabled;
        buffer.areaLightsEnabled = params.areaLightsEnabled;
        clusters.cells = params.cells ?? clusters.cells;
        clusters.collectLights(lights);
        this.#leaveOut(clusters.usedLights);
        clusters.evaluateBounds();
        const points = this.#sort(clusters.usedLights), make = (points, margin) => {
            this.#write(clusters, points, margin);
            this.grid = this.#bin(clusters, points);
            this.#upload(clusters, this.grid, params.debugLayer);
        };
        try {
            make(points, this.#align(clusters));
        } catch (error) {
            make(clusters.usedLights.length - 1, this.#unite(clusters));
            this.#warn(error);
        }
    }

    /// Makes one cell of all that is drawn. With the infinite margin it lists all lights.
    #unite(clusters) {
        clusters.cells = Vec3.ONE;
        clusters.boundsMin.set(-1e18, -1e18, -1e18);
        clusters.boundsDelta.set(2e18, 2e18, 2e18);
        this.#look([-1e18, 1e18, 1, -1e18, 1e18, 1, -1e18, 1e18, 1]);
        return Infinity;
    }

    /// Leaves out the lights whose place or range is no number, which would leave no bounds to the others.
    #leaveOut(used) {
        let kept = 1;
        for (let i = 1; i < used.length; ++i) {
            const {min, max} = used[i];
            if (Number.isFinite(max.x - min.x + max.y - min.y + max.z - min.z)) used[kept++] = used[i];
        }
        used.length = kept;
    }

    /// Sorts point lights before spots, as lightbin numbers them, and returns the number of point lights. The boxes
    /// around the lights stay where they are, as PlayCanvas has no more use for them.
    #sort(used) {
        const spots = [];
        let end = 1;
        for (let i = 1; i < used.length; ++i) {
            const {light} = used[i];
            if (light.type === LIGHTTYPE_SPOT)
                spots.push(light);
            else
                used[end++].light = light;
        }
        spots.forEach((light, i) => { used[end + i].light = light; });
        return end - 1;
    }

    /// Makes the cells' bounds larger, by up to 1/16 of their size, so that they change seldom and floats have them
    /// exactly; makes the camera that sees the cells, if they have changed; and returns a margin for the shader's
    /// arithmetic.
    ///
    /// The shader finds a point's cell as floor((point - begin) * scale) along each axis. Each of the two operations
    /// rounds by at most 2^-23 of its result; or of begin * scale, where the compiler multiplies out. So along an axis
    /// a point lies outside of its cell by at most 2^-22 of the cells' extent and of where they begin. The margin is
    /// four times as much, which leaves room for the rounding of the lights' own numbers.
    #align({boundsMin, boundsDelta, cells}) {
        const edges = [], slacks = [];
        for (const axis of ['x', 'y', 'z']) {
            const low = boundsMin[axis], size = Math.max(boundsDelta[axis], 1e-3);
            const slack = (size + Math.abs(low)) * 2 ** -19, step = 2 ** Math.floor(Math.log2(size + slack) - 5);
            const begin = Math.floor((low - slack) / step) * step;
            const scale = Math.fround(cells[axis] / (Math.ceil((low + size + slack - begin) / step) * step));
            boundsMin[axis] = begin;
            boundsDelta[axis] = cells[axis] / scale;
            edges.push(begin, begin + boundsDelta[axis], cells[axis]);
            slacks.push(slack / 2);
        }
        if (edges.some((edge, i) => edge !== this.#edges[i])) this.#look(edges);
        return Math.hypot(...slacks);
    }

    /// The cells are the tiles of one pixel and the slices of an orthographic camera that looks up: its x is the
    /// world's, its y is the world's z, and its view depth is the world's y.
    #look(edges) {
        const [left, right, width, begin, end, count, bottom, top, height] = edges;
        const options = {
            width, height, tileSize: 1, projection: [
                2 / (right - left), 0, 0, 0, 0, 2 / (top - bottom), 0, 0, 0, 0, 2 / (begin - end), 0,
                (right + left) / (left - right), (top + bottom) / (bottom - top), (end + begin) / (begin - end), 1],
        };
        if (this.#view === undefined)
            this.#view = this.#lightbin.view(options);
        else
            this.#view.update(options);
        const slices = this.#lightbin.linearSlices({count, begin, end});
        this.#slices?.dispose();
        this.#slices = slices;
        this.#edges = edges;
    }

    /// Writes the lights to PlayCanvas' texture, and to the module's memory spheres and cones that are larger by the
    /// margin on all sides.
    #write({usedLights, lightsBuffer: buffer}, points, margin) {
        const count = usedLights.length - 1, texels = this.#texels, needed = 8 * count - 4 * points;
        const texture = fit(buffer.lightsTexture, buffer, PIXELFORMAT_RGBA32F, texels * lights_per_row,
                            Math.ceil(usedLights.length / lights_per_row));
        const rows = texture.lock();
        if (rows !== buffer.lightsFloat) {
            buffer.lightsFloat = rows;
            buffer.lightsUint = new Uint32Array(rows.buffer);
        }
        if (this.#floats.length < needed) this.#floats.resize(2 * needed);
        const {array} = this.#floats;
        let at = 0;
        // Into the space of the camera that sees the cells.
        const write = (x, y, z, last) => {
            array[at++] = x;
            array[at++] = z;
            array[at++] = -y;
            array[at++] = last;
        };
        buffer.lightsTexture = {width: texels};  // for addLightData(), which puts each light in a row of its own
        try {
            for (let i = 1, row = 4 * texels; i <= count; ++i, row += 4 * texels) {
                const {light} = usedLights[i];
                buffer.addLightData(light, i);
                const x = rows[row], y = rows[row + 1], z = rows[row + 2], radius = rows[row + 3] + margin;
                if (i <= points) {
                    write(x, y, z, radius);
                    continue;
                }
                // The cone of PlayCanvas' shader is narrower than the light's by a hundredth, which is more than the
                // halfs round by in which it has the cosine, down to a tenth of a degree.
                const angle = Math.max(light.outerConeAngle, 0.1) * Math.PI / 180, is_wide = angle > Math.PI / 2;
                const behind = margin / (is_wide ? 1 : Math.sin(angle));
                const axis_x = rows[row + 4], axis_y = rows[row + 5], axis_z = rows[row + 6];
                write(x - behind * axis_x, y - behind * axis_y, z - behind * axis_z, radius + behind);
                write(axis_x, axis_y, axis_z, is_wide ? -1 : Math.cos(angle));
            }
        } finally {
            buffer.lightsTexture = texture;
        }
    }

    #bin({usedLights}, points) {
        return this.#binner.bin(this.#view, {
            spheres: {array: this.#floats, count: points},
            spots: {array: this.#floats.array.subarray(4 * points), count: usedLights.length - 1 - points},
        }, {slices: this.#slices});
    }

    #upload(clusters, {ranges, ids: list}, debugLayer) {
        const {lightsBuffer: buffer} = clusters;
        clusters.maxCellLightCount = 2;  // words of a cell
        clusters.updateCells();
        clusters.clusterTexture = fit(clusters.clusterTexture, buffer, PIXELFORMAT_R32U, words_per_row,
                                      Math.ceil((ranges.length + list.length) / words_per_row));
        const words = clusters.clusterTexture.lock();
        words.set(ranges);
        words.set(list, ranges.length);
        clusters.clusterTexture.unlock();
        buffer.lightsTexture.unlock();
        if (debugLayer !== undefined) clusters.counts.forEach((_, i, counts) => counts[i] = ranges[2 * i + 1]);
    }
}

/// A texture of at least this many rows, and at most twice as many: the one that there is, or else another.
function fit(texture, buffer, format, width, rows) {
    const {height} = texture, {maxTextureSize} = buffer.device;
    if (rows > maxTextureSize) throw new Error('the cells and their lists do not fit into a texture of this device');
    if (texture.format === format && texture.width === width && height >= rows && height <= 2 * rows) return texture;
    texture.destroy();
    return buffer.createTexture(buffer.device, width, Math.min(rows + (rows >> 2), maxTextureSize), format, 'lightbin');
}
