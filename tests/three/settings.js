// SPDX-License-Identifier: MIT
// What makes three.js draw pictures within pictures, or to targets of other sizes than the canvas. Each setting changes
// window.stage, and returns what takes that back and, where it is not the default: what draws the picture (stage.draw),
// how many frames (2), the options of ClusteredLights, and words of what the adapter warns of.
import * as THREE from 'three';
import {Reflector} from 'three/addons/objects/Reflector.js';
import {Refractor} from 'three/addons/objects/Refractor.js';
import {Water} from 'three/addons/objects/Water.js';
import {EffectComposer} from 'three/addons/postprocessing/EffectComposer.js';
import {OutputPass} from 'three/addons/postprocessing/OutputPass.js';
import {RenderPass} from 'three/addons/postprocessing/RenderPass.js';

const {camera, other, renderer, scene} = stage;
const still = new THREE.DataTexture(new Uint8Array([128, 128, 255, 255]), 1, 1);
still.needsUpdate = true;

/// Objects, of which the first one is drawn before all others, and a ball for it to reflect.
function add(...objects) {
    const ball = new THREE.Mesh(new THREE.SphereGeometry(2), new THREE.MeshStandardMaterial());
    ball.position.set(-5, -1, 1);
    objects[0].renderOrder = -1;
    scene.add(...objects, ball);
    return {undo: () => scene.remove(...objects, ball)};
}

function standing(object, x, y, z) {
    object.position.set(x, y, z);
    return add(object);
}

/// A mirror. Its camera's near plane lies in it.
function mirror(Mirror, size, is_lying, ...place) {
    const object = new Mirror(new THREE.PlaneGeometry(...size), {
        textureWidth: 150, textureHeight: 100, waterNormals: still, sunColor: 0, waterColor: 0});
    if (is_lying) object.rotation.x = -Math.PI / 2;
    return standing(object, ...place);
}

/// A screen that shows the scene from behind, and on that a screen with the outer camera's picture.
function nested() {
    const behind = new THREE.PerspectiveCamera(70, 1.5, 0.1, 80), cameras = [behind, camera];
    behind.position.set(0, 2, -18);
    behind.lookAt(0, -2, 0);
    const targets = cameras.map((_, i) => new THREE.WebGLRenderTarget(120 - 40 * i, 80 - 30 * i));
    const material = new THREE.MeshBasicMaterial({map: targets[0].texture, side: THREE.DoubleSide});
    const screen = new THREE.Mesh(new THREE.PlaneGeometry(9, 6), material);
    let depth = 0;
    screen.onBeforeRender = () => {
        const outer = renderer.getRenderTarget(), within = cameras[depth], target = targets[depth++];
        screen.visible = depth < cameras.length;
        renderer.setRenderTarget(target);
        renderer.render(scene, within);
        renderer.setRenderTarget(outer);
        material.map = target.texture;
        screen.visible = true;
        --depth;
    };
    return standing(screen, 0, 1, -7);
}

function composed(ratio, width, height) {
    renderer.setPixelRatio(ratio);
    stage.resize(width, height);
    const composer = new EffectComposer(renderer);
    composer.addPass(new RenderPass(scene, camera));
    composer.addPass(new OutputPass());
    return {
        draw: () => {
            composer.render();
            renderer.setRenderTarget(null);
            return stage.pixels();
        },
        undo: () => {
            composer.dispose();
            renderer.setPixelRatio(1);
        },
    };
}

/// Two cameras' pictures, one over a corner of the other one, neither over all of the window.
function corners() {
    return {
        draw: () => {
            renderer.autoClear = false;
            renderer.clear();
            renderer.setViewport(27, 21, 150, 90);
            renderer.render(scene, camera);
            renderer.setViewport(5, 3, 90, 50);
            renderer.clearDepth();
            return stage.draw(other);
        },
        undo: () => { renderer.autoClear = true; },
    };
}

function part_of_target() {
    const target = new THREE.WebGLRenderTarget(200, 125);
    target.viewport.set(20.5, 10.25, 150.5, 90.75);
    return {
        draw: () => {
            const pixels = new Uint8Array(4 * 200 * 125);
            renderer.setRenderTarget(target);
            renderer.render(scene, camera);
            renderer.readRenderTargetPixels(target, 0, 0, 200, 125, pixels);
            renderer.setRenderTarget(null);
            return pixels;
        },
        undo: () => target.dispose(),
    };
}

function glass(scale, ...viewport) {
    const material = new THREE.MeshPhysicalMaterial({transmission: 1, roughness: 0, ior: 1});
    const {undo} = standing(new THREE.Mesh(new THREE.PlaneGeometry(14, 9), material), 1, 0, 7);
    renderer.transmissionResolutionScale = scale;
    renderer.setViewport(...viewport);
    return {undo: () => {
        undo();
        renderer.transmissionResolutionScale = 1;
    }};
}

/// What two eyes see in a part of the window.
function eyes(setting = {undo: () => {}}) {
    const both = stage.eyes([7, 5, 93, 100], [102, 14, 84, 100]);
    return {...setting, draw: () => stage.draw(both)};
}

/// A ball that another scene's lamp lights, over the picture: with a material of both scenes.
function another_scene() {
    const within = new THREE.Scene(), lamp = new THREE.PointLight(0xffffff, 20, 9);
    const {material} = scene.children.find(({isMesh}) => isMesh);
    lamp.position.set(1, 2, 9);
    within.add(new THREE.Mesh(new THREE.SphereGeometry(3), material), lamp);
    return {
        draw: () => {
            renderer.render(scene, camera);
            renderer.autoClear = false;
            renderer.render(within, camera);
            return stage.pixels();
        },
        undo: () => { renderer.autoClear = true; },
    };
}

/// A ball near and a lamp, which three.js shows once it has found out how far away they are.
function levels() {
    const detail = new THREE.LOD(), near = new THREE.Group(), material = new THREE.MeshStandardMaterial();
    near.add(new THREE.Mesh(new THREE.SphereGeometry(2), material), new THREE.PointLight(0xff8800, 50, 9));
    near.children[1].position.set(0, 3, 3);
    near.visible = false;
    detail.addLevel(near, 0).addLevel(new THREE.Group(), 500);
    return {...standing(detail, 2, -2, 4), frames: 1};
}

/// A copy of all lamps after their first picture, beside them.
function copied(copy) {
    const lamps = new THREE.Group();
    lamps.add(...stage.lamps, ...stage.lamps.flatMap(({target}) => target ?? []));
    scene.add(lamps);
    stage.draw();
    const copies = copy(lamps);
    copies.position.x = 3;
    return add(copies, lamps);
}

export const settings = {
    'pictures within pictures': nested,
    'Reflector': () => mirror(Reflector, [16, 8], false, 0, -1, -8),
    'Reflector, orthographic': () => ({
        ...mirror(Reflector, [14, 14], true, 0, -4.7, 0), draw: () => stage.draw(other)}),
    'Reflector, masks': () => ({...mirror(Reflector, [16, 8], false, 0, -1, -8), options: {masks: true}}),
    'Refractor': () => mirror(Refractor, [12, 8], false, 1, 0, 5),
    'Refractor, orthographic': () => ({
        ...mirror(Refractor, [14, 14], true, 0, 2, 0), draw: () => stage.draw(other)}),
    'Water': () => mirror(Water, [14, 14], true, 0, -4.7, 0),
    'Water, orthographic': () => ({...mirror(Water, [14, 14], true, 0, -4.7, 0), draw: () => stage.draw(other)}),
    'an orthographic z row of the other sign': () => {
        const turned = other.clone(), {elements} = turned.projectionMatrix;
        for (const i of [10, 14]) elements[i] *= -1;
        return {draw: () => stage.draw(turned), undo: () => {}};
    },
    'two eyes': eyes,
    'two eyes and a mirror': () => eyes(mirror(Reflector, [16, 8], false, 0, -1, -8)),
    'two eyes and glass, scale 0.5': () => eyes(glass(0.5, 0, 0, 200, 125)),
    'EffectComposer': () => composed(1, 200, 125),
    'EffectComposer, pixel ratio 1.25': () => composed(1.25, 162, 101),
    'EffectComposer, pixel ratio 1.5': () => composed(1.5, 161, 100),
    'two cameras in corners of the window': corners,
    'a part of a target, at fractions of pixels': part_of_target,
    'transmission': () => glass(1, 0, 0, 200, 125),
    'transmission, scale 0.5': () => glass(0.5, 0, 0, 200, 125),
    'transmission, scale 0.7, a part of the canvas': () => glass(0.7, 31, 17, 151, 93),
    'another scene with the same material': another_scene,
    'levels of detail, first picture': levels,
    'a material for all objects': () => {
        scene.overrideMaterial = new THREE.MeshPhongMaterial();
        return {undo: () => { scene.overrideMaterial = null; }};
    },
    'clones of lights': () => copied(lamps => lamps.clone()),
    'lights that were saved and loaded': () => copied(lamps => new THREE.ObjectLoader().parse(lamps.toJSON())),
    'lists of more rows than a texture has': () => {
        stage.resize(40, 400);
        return {undo: () => {}, options: {tileSize: 1}, says: ['more rows']};
    },
};
