// SPDX-License-Identifier: MIT

/** Thrown by every function that refuses its input. The message is a sentence that names the argument and the cause. */
export class LightbinError extends Error {
    /** The name of the error in lightbin.h, such as 'tile-size-out-of-range' or 'out-of-memory'. */
    readonly code: string;
}

/** Returns whether this machine runs WebAssembly's 128-bit vectors. */
export function hasSimd(): boolean;

type Wasm = WebAssembly.Module | BufferSource | Response | URL | string;
export interface LoadOptions {
    /** Whether to load the module with 128-bit vectors. The scalar one takes 1.2 to 3.3 times the time. Default:
     * hasSimd(). */
    simd?: boolean;
    /** The module lightbin_simd.wasm or lightbin.wasm, or where it is. Default: beside the package's JavaScript. */
    wasm?: Wasm | Promise<Wasm> | (() => Wasm | Promise<Wasm>);
    /** The module shaders.wasm, which the first call that makes text loads, or where it is. If it can't be
     * loaded, the next call tries again. */
    shaders?: Wasm | Promise<Wasm> | (() => Wasm | Promise<Wasm>);
}

/** Loads the module. Each call returns another one, with memory of its own. */
export function load(options?: LoadOptions): Promise<Lightbin>;

type Numbers = ArrayLike<number>;
/** column-major: translation in the last four numbers, as in three.js, PlayCanvas, Babylon.js and gl-matrix. */
export type MatrixLayout = 'column-major' | 'row-major' | 'row-vectors';
export type Slicing = 'no-slicing' | 'clusters' | 'z-bins';

export interface ViewOptions {
    /** Sixteen numbers that map view space to clip space: any perspective or orthographic projection. */
    projection: Numbers;
    layout?: MatrixLayout;
    /** Of the viewport, in pixels: 0 to 32768. A view of 0 pixels has no tiles. */
    width: number;
    height: number;
    /** The side of a square tile in pixels. Default: 32. */
    tileSize?: number;
    /** In place of tileSize: so many columns and rows of tiles, 1 to 32768 each, which need not be whole pixels. */
    columns?: number;
    rows?: number;
    /** In place of all three: about square tiles, at most so many. */
    maxTiles?: number;
    /** The range of clip-space depth: minus-one-to-one for WebGL (the default), zero-to-one for WebGPU. */
    clipDepth?: 'minus-one-to-one' | 'zero-to-one';
    /** The corner of the window that holds pixel (0, 0): lower-left for WebGL (the default), upper-left for WebGPU. */
    origin?: 'lower-left' | 'upper-left';
    /** Read for orthographic matrices alone: the near plane has the larger window depth. */
    reversedZ?: boolean;
}

/** What a view knows; flags are 0 or 1. */
export interface ViewInfo {
    /** tileSize is 0 if numbers of tiles were given. */
    readonly width: number, height: number, tileSize: number, tilesX: number, tilesY: number;
    /** Rounded outward; farDepth is Infinity if there is no far plane. */
    readonly nearDepth: number, farDepth: number;
    readonly orthographic: number, reversedZ: number, xFlipped: number, yFlipped: number, looksDownNegativeZ: number;
    readonly oblique: number;
    /** 1 where the matrix or the viewport looks like a common mistake. */
    readonly looksTransposed: number, looksLikeViewMatrix: number, looksTurned: number, looksBehind: number;
    readonly looksZeroToOne: number, pixelsNotSquare: number, viewportEmpty: number;
    /** The projection turns the image by 90 or 270 degrees: tile columns are counted along y of the viewport. */
    readonly turned: number;
}

interface Disposable {
    /** Frees the object's memory. Calls that are then given the object throw; a second dispose() does nothing. */
    dispose(): void;
}

/** A projection, a viewport and a tile size. Tile (x, y) has index y * tilesX + x. */
export interface View extends Disposable {
    readonly info: ViewInfo;
    /** Changes the given options, as when the camera or the window changes. After an error the view is as before. */
    update(options: Partial<ViewOptions>): void;
    /** Returns where in the image a point of view space lies: x and y in pixels from the corner of the origin, and its
     * view depth. Where the depth of a perspective view is 0 or less, x and y mean nothing. */
    project(point: Numbers): [x: number, y: number, depth: number];
    /** The inverse of project(). The viewport must not be empty. */
    unproject(image: Numbers): [x: number, y: number, z: number];
    /** Returns the least and the greatest view depth that window depths from `lower` to `upper`, numbers from 0 to 1 as
     * a depth buffer holds them, stand for; rounded outward. */
    depths(lower: number, upper: number): [least: number, greatest: number];
    /** Returns the window depth of an image point, as project() returns it, up to rounding; NaN for an infinite view
     * depth. x and y matter with an oblique near plane alone. */
    windowDepth(image: Numbers): number;
    /** The constants `grid` (four numbers) and `corner` (two) of the shader text, as in its uniform block. */
    gridConstants(cornerX?: number, cornerY?: number): Uint32Array;
    /** The constants `image` and `depths` of the shader text's view check. */
    viewConstants(tolerance?: number): Float32Array;
    /** The constants of reduceShader(): the words of its uniform block, of which the second four are floats (`planes`). */
    reduceConstants(cornerX?: number, cornerY?: number): Uint32Array;
    /** What cullShader() reads with `box`, after the Z bounds: the sides of columns and rows of tiles. */
    shaderEdges(): Float32Array;
}

/** Floats in the module's memory, all 0 at first. Lights in such memory are read in place, without a copy. */
export interface Floats extends Disposable {
    readonly length: number;
    /** The floats. Read it anew after each call: when the module's memory grows, arrays read before are empty. */
    readonly array: Float32Array;
    /** Keeps the values, as far as they fit, and sets new ones to 0. */
    resize(length: number): void;
}

type FloatArray = Floats | Numbers;
/**
 * Floats of each light: an array of their own, in which light follows light without gaps, or where they begin in each
 * light of the `array` that the lights' attributes share.
 */
type Attribute = FloatArray | number;

interface Kind {
    /** Default: as many as the arrays hold, which then all have to end with the last light's floats. */
    count?: number;
    /** An array that attributes share: `stride` floats a light. A `Floats` is read in place, and so is a Float32Array
     * over its memory; others are copied. */
    array?: FloatArray;
    stride?: number;
}
/** Spheres outside of which lights give no light. The default is a stride of 4: x, y, z, radius. The radius -1 switches
 * a light off, a spot or a box, too: it is in no list, and counts as culled. */
export interface Spheres extends Kind {
    centre?: Attribute;
    /** Infinity: the light reaches everything. */
    radius?: Attribute;
}
/** Spheres that are cut by a cone from their centre. The default is a stride of 8: x, y, z, radius, axis, cosine. With
 * the cosine -1 a spot is its whole sphere, whatever its axis is. */
export interface Spots extends Spheres {
    /** 3 floats: the direction in which the light shines, of any length but zero. */
    axis?: Attribute;
    /** 1 float: of the angle between the axis and the cone's side, from 1 to -1. */
    cosine?: Attribute;
}
/**
 * Spheres that are cut by an oriented box or frustum. The default is a stride of 16: x, y, z, radius, the box's centre,
 * three vectors from that to the middles of three faces. Null for centre and radius: no sphere cuts the boxes.
 */
export interface Boxes extends Kind {
    centre?: Attribute | null;
    radius?: Attribute | null;
    boxCentre?: Attribute;
    /** 9 floats: three vectors. */
    halfAxes?: Attribute;
    /** 1 float from 0 to 1: the size of the face at centre - third vector, as a fraction of the opposite face's. */
    taper?: Attribute;
}
/** Ids number spheres, then spots, then boxes. */
export interface Lights {
    /** World space to view space, for lights in world space. Without it lights are in view space. */
    viewMatrix?: Numbers | null;
    /** Of viewMatrix. */
    layout?: MatrixLayout;
    /**
     * For worlds so large that floats round too much: the eye in world space. Each centre and boxCentre is then a
     * Float64Array, and the translation of viewMatrix is not read. Centres relative to the eye are computed in double.
     */
    eye?: Numbers | null;
    spheres?: Spheres | null;
    spots?: Spots | null;
    boxes?: Boxes | null;
}

/** Adjacent intervals of view depth. */
export interface Slices extends Disposable {
    readonly count: number;
    /** In ascending order, one less than there are slices. */
    readonly boundaries: Float32Array;
    /** Returns the index of the slice that contains a view depth, which must not be NaN. A boundary belongs to the
     * slice behind it. */
    at(depth: number): number;
    /** The content of the shader text's buffer `slices`. */
    shaderWords(): Uint32Array;
    /** What cullShader() reads with clusters and a depth test in place of Z bounds. */
    shaderSlabs(): Float32Array;
}

export interface BinnerOptions {
    ids?: 'u32' | 'u16';
    /** Whether lights are tested against the box around each cell. Needs Z bounds or, without these, clusters. */
    depthTest?: boolean;
    slicing?: Slicing;
}

/** The view depths that bound what is drawn in each tile: arrays of one float a tile, row-major. */
export interface ZBounds {
    min?: FloatArray;
    max?: FloatArray;
}

/** What the binner's options read, and no others. Clusters may be given bounds: cells outside of them are empty. */
export interface Inputs {
    slices?: Slices;
    bounds?: ZBounds;
}

/** The content of a texture, row by row: whole rows, as most APIs upload. */
export interface Texels {
    readonly data: Uint32Array | Uint16Array, width: number, height: number;
}

/**
 * The lists. The arrays are the module's memory. They hold until the binner's next call, and are read anew from the
 * object after each call to the module, as they are empty when its memory has grown.
 */
export interface Grid {
    /** How many lights were given, are bad input, and are outside of the view. */
    readonly lights: number, rejected: number, culled: number;
    readonly tilesX: number, tilesY: number;
    /** 1 unless made with clusters. */
    readonly slices: number;
    /** {offset, count}, two numbers a list: tilesX * tilesY lists, row-major; with clusters as many a slice. */
    readonly ranges: Uint32Array;
    readonly ids: Uint32Array | Uint16Array;
    readonly idBytes: number;
    /** With z-bins: for each rank the light's id, and two numbers for each bin, the least and greatest rank. */
    readonly order: Uint32Array, bins: Uint32Array;
    /** Ids below firstSpot are spheres, from there to firstBox spots, others boxes. */
    readonly firstSpot: number, firstBox: number;
    /** Writes the lists in another format; with 'offset-count' the ids alone, which `ranges` still index. The data hold
     * until the binner's next encode() or append(), or until the module's memory grows. */
    encode(format: ListFormat): {data: Uint8Array, tilesCut: number, entriesCut: number, capacityNeeded: number};
    /**
     * Writes the lists of several views, this grid's first, one view after another, for shaders made with
     * SnippetOptions.views: offsets count from the beginning of `ids`. The grids have the same numbers of tiles and
     * slices and ids of the same width, and each is of a binner of its own, as a binner's next call ends its lists.
     * Order and bins of z-bins are not appended. The arrays hold as the data of encode() do.
     */
    append(...others: Grid[]): {ranges: Uint32Array, ids: Uint32Array | Uint16Array};
    /**
     * Returns an array as the content of a texture that is `width` texels wide, an integer; 0 counts as 1. A texel has
     * two numbers of `ranges` or `bins`, and one of the others. The height is that of the rows that `ranges` take, at
     * least 1; of other arrays it is rounded up to a power of two, so that it seldom changes. What lies behind the
     * array's own numbers in `data` has no meaning. The data are a copy, which the next call for this name overwrites.
     */
    texels(name: 'ranges' | 'ids' | 'order' | 'bins', width: number): Texels;
}

/**
 * Masks of the columns and rows of tiles. Bit b of word w of a mask stands for the light ids[32 * w + b], and the lights
 * of tile (x, y) are those that both its column and its row have. The arrays hold as those of a Grid do.
 */
export interface Masks {
    /** As in Grid. */
    readonly lights: number, rejected: number, culled: number, firstSpot: number, firstBox: number;
    readonly tilesX: number, tilesY: number;
    /** The number of words of 32 bits in each mask, 0 if no light is in view. */
    readonly maskWords: number;
    /** All that a shader reads, to be uploaded as it is: maskWords; the masks of all columns, and an empty one; those of
     * all rows; 32 * maskWords ids, which are 0 beyond the lights in view; and the bins. */
    readonly words: Uint32Array;
    /** The lights in view, in ascending order, or with z-bins in order of depth. */
    readonly ids: Uint32Array;
    /** With z-bins: two numbers for each bin, the first and the last place in `ids` of the lights that meet it. */
    readonly bins: Uint32Array;
    /** As Grid.texels(). */
    texels(name: 'words' | 'ids' | 'bins', width: number): Texels;
}

/** Bins lights into tiles, and keeps the memory that this takes. */
export interface Binner extends Disposable {
    /** Makes the lists of the lights in a view. Each call returns the same object, with the new lists. */
    bin(view: View, lights: Lights, inputs?: Inputs): Grid;
    /** Makes masks of columns and rows, by which every tile has the lights of its list. 1,000 lights take 17 KB. A
     * binner with a depth test or clusters has none. Each call returns the same object, with the new masks. */
    masks(view: View, lights: Lights, inputs?: Inputs): Masks;
}

export interface ListFormat {
    encoding?: 'offset-count' | 'sentinel';
    ids?: 'u32' | 'u16' | 'u8';
    /** For sentinel: the ids that a tile has memory for. */
    capacity?: number;
}

export interface Slot {
    binding?: number;
    /** The bind group in WebGPU. */
    set?: number;
}

/** essl-300 for WebGL 2, wgsl for WebGPU. */
type Language = 'essl-300' | 'wgsl' | 'essl-310' | 'glsl-330' | 'glsl-430' | 'glsl-vulkan' | 'hlsl-5-0' | 'hlsl-5-1';

/** docs/shader.md explains each member at length. */
export interface SnippetOptions {
    language: Language;
    /** texture-2d or uniform-block for WebGL 2. Default: storage-buffer. */
    storage?: 'storage-buffer' | 'texel-buffer' | 'texture-2d' | 'uniform-block';
    /** That of the binner. */
    slicing?: Slicing;
    /** Default: the lists of a binner whose ids have 32 bits. */
    format?: ListFormat;
    /** Read Masks.words, bound at `lists`, in place of lists and their format. */
    masks?: boolean;
    /** Every name in the text begins with it. Default: 'lightbin_'. */
    prefix?: string;
    /** In pixels, fixed in the text. Default: read at run time from the constant `grid`. */
    tileSize?: number;
    /** For views of which numbers of tiles were given; tileSize is not read. */
    columnsAndRows?: boolean;
    /** ViewInfo.turned. */
    turned?: boolean;
    tilesInUniformBlock?: boolean;
    packedIds?: boolean;
    flipY?: boolean;
    viewportCorner?: boolean;
    heatMap?: boolean;
    waveLoop?: boolean;
    viewCheck?: boolean;
    /** The number of views whose lists Grid.append() wrote one after another. */
    views?: number;
    listCheck?: boolean;
    window?: boolean;
    pushConstants?: boolean;
    textureWidth?: number;
    maxTiles?: number;
    maxEntries?: number;
    maxSlices?: number;
    uniformBlockBytes?: number;
    /** Default: the bindings 0 to 5 of set 0 in this order. */
    slots?: {tiles?: Slot, lists?: Slot, grid?: Slot, slices?: Slot, bins?: Slot, view?: Slot};
}

/** A shader that reduces a depth texture to Z bounds. Defaults: a compute shader, one sample, 32-bit floats. */
export interface ReduceOptions {
    language: Language;
    fragment?: boolean;
    samples?: number;
    /** 'view-depth': the texture holds view depths, such as converted logarithmic ones; background is Infinity. */
    format?: 'float32' | 'unorm24' | 'unorm16' | 'view-depth';
    reversedZ?: boolean;
    orthographic?: boolean;
    oblique?: boolean;
    skipBackground?: boolean;
    flipY?: boolean;
    viewportCorner?: boolean;
    pushConstants?: boolean;
    prefix?: string;
    /** Default: the bindings 0 to 2 of set 0 in this order. */
    slots?: {depth?: Slot, zBounds?: Slot, grid?: Slot};
}

/** The compute shaders that make the lists on the GPU of lights in a buffer there. */
export type CullPass = 'project' | 'count' | 'sums' | 'offsets' | 'fill' | 'masks';

/** All passes need the same options except for `pass`. docs/gpu.md explains them and the buffers. */
export interface CullOptions {
    language: Language;
    pass?: CullPass;
    /** mixed: spheres, behind them spots, and behind them boxes. Ids number them in this order. */
    kind?: 'sphere' | 'spot' | 'box' | 'mixed';
    /** Where a light's numbers lie in the buffer `lights`, in words of 32 bits. Without stride, lights lie side by
     * side: x, y, z, radius, with spots axis and cosine, with boxes box centre, half axes and taper. */
    stride?: number;
    centre?: number;
    radius?: number;
    axis?: number;
    cosine?: number;
    boxCentre?: number;
    halfAxes?: number;
    taper?: number;
    /** With kind mixed; `stride` is that of spheres. */
    spotStride?: number;
    boxStride?: number;
    /** With kind mixed, for planCull(): their numbers, with countInBuffer the greatest. */
    spots?: number;
    boxes?: number;
    worldSpace?: boolean;
    /** The number of lights is read from word `countAt` of the buffer `light_count`; with kind mixed that of spheres,
     * and those of spots and boxes from the two words behind it. */
    countInBuffer?: boolean;
    countAt?: number;
    ids?: 'u32' | 'u16';
    depthTest?: boolean;
    slicing?: 'no-slicing' | 'clusters';
    maxOnly?: boolean;
    /** With clusters: cells whose slice does not meet their tile's Z bounds list no light. */
    bounded?: boolean;
    orthographic?: boolean;
    prefix?: string;
    /** Default: the bindings 0, 0, 1, 2, 2, 3, 3 and 4 of set 0 in this order. */
    slots?: {lights?: Slot, zBounds?: Slot, scratch?: Slot, slices?: Slot, tiles?: Slot, lightCount?: Slot,
             lists?: Slot, grid?: Slot};
}

/** What the buffers have room for, and what the options ask for. */
export interface CullCapacity {
    /** The number of lights, with countInBuffer the greatest. With kind mixed that of spheres. */
    lights: number;
    /** Ids that fit in the buffer `lists`. */
    entries: number;
    /** With clusters. */
    slices?: Slices;
    /** With worldSpace. */
    viewMatrix?: Numbers;
    layout?: MatrixLayout;
}

export interface CullPlan {
    /** The content of the uniform block `grid`. */
    constants: Uint32Array;
    /** The sizes of the buffers. The first four words of scratch are, after the passes: the entries of the complete
     * lists, the lights that are bad input, those in view, and those given. */
    bytes: {scratch: number, tiles: number, lists: number, masks: number};
    /** The passes that make lists in the order of their dispatches, and the work groups of each. */
    passes: {pass: CullPass, x: number, y: number}[];
    /** The same for masks in the buffer `lists`, which then has `bytes.masks`. */
    maskPasses: {pass: CullPass, x: number, y: number}[];
    /** Whether masks are meant for so few lights rather than lists: up to 1,024, without clusters and depth test. */
    masksSuit: boolean;
}

/** One resource that the program has to bind. */
export interface ShaderBinding {
    readonly name: string;
    readonly resource: 'uniform-vector' | 'uniform-block' | 'push-constants' | 'storage-buffer' | 'texel-buffer'
        | 'texture-2d' | 'writable-buffer';
    readonly slot: Required<Slot>;
    readonly stride: number, bytes: number, width: number;
    /** The three arguments of texImage2D(); 0 if there are no texels. */
    readonly glInternalFormat: number, glFormat: number, glType: number;
    readonly vkFormat: number, dxgiFormat: number;
    /** Such as 'r32uint'; '' if there are no texels. */
    readonly webgpuFormat: string;
}

export interface ShaderText {
    text: string;
    bindings: ShaderBinding[];
}

export interface Lightbin {
    readonly version: string;
    readonly simd: boolean;
    /** The compiled module, for load({wasm: module}) in a worker. */
    readonly module: WebAssembly.Module;
    view(options: ViewOptions): View;
    binner(options?: BinnerOptions): Binner;
    floats(length: number): Floats;
    /** Slices whose depth grows geometrically from `first`, where the first slice ends, to `last`, where the last one
     * would end; in fact it reaches to the far plane. margin, from 0 to 1/2: how far a reader's own formula may miss, as
     * a part of the depth. */
    exponentialSlices(options: {count: number, first: number, last: number, margin?: number}): Slices;
    linearSlices(options: {count: number, begin: number, end: number, margin?: number}): Slices;
    slicesFromBoundaries(options: {boundaries: Numbers, margin?: number}): Slices;
    /** Makes shader text that reads the lists, to be inserted after `#version`. The first call loads shaders.wasm. */
    shader(options: SnippetOptions): Promise<ShaderText>;
    /** Makes a whole shader, but for `#version`: docs/shader.md says what its buffers hold, and how to dispatch it. */
    reduceShader(options: ReduceOptions): Promise<ShaderText>;
    cullShader(options: CullOptions): Promise<ShaderText>;
    /** Returns the constants, buffer sizes and dispatches of cullShader() for a view. Where only the camera moves, only
     * the constants change. The first call loads shaders.wasm. */
    planCull(view: View, options: CullOptions, room: CullCapacity): Promise<CullPlan>;
    /** Returns what was read from a view's matrix as one line of text, with a question for each likely mistake. For
     * development: it loads shaders.wasm. */
    viewText(view: View): Promise<string>;
    /** Returns a frame as JSON text, to be kept in a file when a picture is wrong: the view, the binner's options, the
     * lights and the lists. `sh examples/run.sh --replay FILE` in lightbin's repository checks it. All that is given is
     * copied before the call returns. It loads shaders.wasm.
     *
     * made: what bin() or masks() returned, before the binner's next call
     * view, lights, inputs: what that call was given */
    dump(made: Grid | Masks, view: View, lights: Lights, inputs?: Inputs): Promise<string>;
    /** Returns the distance at which a light of an intensity falls below `cutoff` by the inverse square law. */
    lightRange(intensity: number, cutoff: number): number;
    /** How many blocks of the module's memory views, slices, binners and floats hold: 0 when all were disposed of. */
    readonly allocations: number;
}
