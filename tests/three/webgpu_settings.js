// SPDX-License-Identifier: MIT
// What makes WebGPURenderer draw pictures within pictures, by other cameras, to targets of other sizes than the canvas,
// and with other materials and lights. Each setting changes window.stage, and returns what takes that back and, where
// it is not stage.draw, what draws the picture.
import * as THREE from 'three/webgpu';
import {pass, reflector} from 'three/tsl';

const {camera, other, scene} = stage;

/// Adds an object that is drawn before all others.
function add(object, x, y, z) {
    object.position.set(x, y, z);
    object.renderOrder = -1;
    scene.add(object);
    return {undo: () => scene.remove(object)};
}

function mirror(size, turn, ...place) {
    const reflection = reflector({resolutionScale: 0.5});
    const object = new THREE.Mesh(new THREE.PlaneGeometry(...size),
        new THREE.MeshBasicNodeMaterial({colorNode: reflection}));
    object.rotation.x = turn;
    object.add(reflection.target);
    return add(object, ...place);
}

/// A screen that shows the scene from behind. That camera draws a picture of its own before.
function nested() {
    const behind = new THREE.PerspectiveCamera(70, 1.5, 0.1, 80), target = new THREE.RenderTarget(120, 80);
    behind.position.set(0, 2, -18);
    behind.lookAt(0, -2, 0);
    const screen = new THREE.Mesh(new THREE.PlaneGeometry(9, 6), new THREE.MeshBasicMaterial({map: target.texture}));
    const draw_behind = () => {
        const {renderer} = stage, outer = renderer.getRenderTarget();
        screen.visible = false;
        renderer.setRenderTarget(target);
        renderer.render(scene, behind);
        renderer.setRenderTarget(outer);
        screen.visible = true;
    };
    screen.onBeforeRender = draw_behind;
    return {...add(screen, 0, 1, -7), draw: () => {
        draw_behind();
        return stage.draw();
    }};
}

function part_of_canvas() {
    const {renderer} = stage;
    renderer.setPixelRatio(1.25);
    renderer.setViewport(27, 21, 150, 90);
    return {undo: () => {
        renderer.setPixelRatio(1);
        renderer.setViewport(0, 0, 320, 200);
    }};
}

function part_of_target() {
    const target = new THREE.RenderTarget(200, 125);
    target.viewport.set(20.5, 10.75, 150.5, 90.75);
    for (const lamp of stage.lamps) lamp.intensity *= 40;  // the target's colors are linear
    return {
        draw: async () => {
            const {renderer} = stage;
            renderer.setRenderTarget(target);
            renderer.render(scene, camera);
            renderer.setRenderTarget(null);
            return renderer.readRenderTargetPixelsAsync(target, 0, 0, 200, 125);
        },
        undo: () => target.dispose(),
    };
}

function post_processing() {
    const pipeline = new THREE.RenderPipeline(stage.renderer, pass(scene, camera));
    return {
        draw: async () => {
            await new Promise(requestAnimationFrame);  // a pass draws once a frame
            pipeline.render();
            return stage.pixels();
        },
        undo: () => pipeline.dispose(),
    };
}

function eyes() {
    const both = stage.eyes([0, 0, 160, 200], [160, 0, 160, 200]);
    return {draw: () => stage.draw(both), undo: () => {}};
}

/// A light with a shadow and one with a map, beside others.
function shadows() {
    const torch = new THREE.SpotLight(0xffffff, 300, 60, 0.6, 0.5), slide = torch.clone(), {shadowMap} = stage.renderer;
    const map = new THREE.DataTexture(new Uint8Array([255, 0, 0, 255, 0, 255, 0, 255]), 2, 1);
    map.needsUpdate = true;
    torch.position.set(2, 12, 3);
    torch.castShadow = true;
    slide.position.set(-6, 9, 3);
    slide.map = map;
    shadowMap.enabled = true;
    scene.add(torch, torch.target, slide, slide.target, new THREE.DirectionalLight(0xffffff, 0.3));
    const sun = scene.children.at(-1);
    return {undo: () => {
        scene.remove(torch, torch.target, slide, slide.target, sun);
        shadowMap.enabled = false;
    }};
}

function materials() {
    const kinds = [THREE.MeshStandardNodeMaterial, THREE.MeshPhongMaterial, THREE.MeshLambertMaterial,
                   THREE.MeshToonMaterial, THREE.MeshSSSNodeMaterial];
    const balls = new THREE.Group();
    kinds.forEach((Kind, i) => {
        balls.add(new THREE.Mesh(new THREE.SphereGeometry(2), new Kind()));
        balls.children[i].position.x = 5 * i - 10;
    });
    return add(balls, 0, -3, 6);
}

/// Lights and a ball that are no scene.
function group() {
    const group = new THREE.Group();
    group.add(new THREE.Mesh(new THREE.SphereGeometry(9), new THREE.MeshStandardMaterial()), ...stage.lamps);
    group.children[0].position.y = -9;
    for (const lamp of stage.lamps) lamp.intensity *= 4;
    return {
        draw: () => {
            stage.renderer.render(group, camera);
            return stage.pixels();
        },
        undo: () => scene.add(...stage.lamps),
    };
}

export const settings = {
    'a mirror': () => mirror([16, 8], 0, 0, -1, -8),
    'a mirror, orthographic': () => ({...mirror([14, 14], -Math.PI / 2, 0, -4.7, 0), draw: () => stage.draw(other)}),
    'a picture within a picture': nested,
    'a part of the canvas, pixel ratio 1.25': part_of_canvas,
    'a part of a target, at fractions of pixels': part_of_target,
    'a pipeline with a pass': post_processing,
    'transmission': () => add(new THREE.Mesh(new THREE.PlaneGeometry(14, 9),
        new THREE.MeshPhysicalMaterial({transmission: 1, roughness: 0, ior: 1})), 1, 0, 7),
    'two eyes': eyes,
    'shadows, maps and a sun': shadows,
    'materials': materials,
    'a group': group,
};
