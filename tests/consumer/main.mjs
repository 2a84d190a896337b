// main.cpp as a user of the npm package writes it: one light, four tiles, a known answer; and the text of a shader.
import {load} from 'lightbin';

const lightbin = await load();
const view = lightbin.view({projection: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -0.2, 0],
                            width: 64, height: 64, tileSize: 32});
const lights = lightbin.floats(4);
lights.array.set([3, 3, -5, 1]);
const grid = lightbin.binner().bin(view, {spheres: {array: lights}});
const {text} = await lightbin.shader({language: 'essl-300', storage: 'texture-2d'});
const right = `${grid.ranges}` === '0,0,0,0,0,0,0,1' && `${grid.ids}` === '0' && text.includes('lightbin_for_each_light');
console.log(right ? 'right' : `WRONG: ${grid.ranges}; ${grid.ids}`);
process.exit(right ? 0 : 1);
