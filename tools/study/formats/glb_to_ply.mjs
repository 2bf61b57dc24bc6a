/* SPDX-License-Identifier: Apache-2.0 */
// node glb_to_ply.mjs IN.glb OUT.ply: what three.js's loader reads of a .glb of Gaussians, as a 3DGS .ply with its axes.
import { readFile, writeFile } from "node:fs/promises";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

const [input, output] = process.argv.slice(2);
const file = await readFile(input);
const gltf = await new GLTFLoader().parseAsync(file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength), "");
let geometry;
gltf.scene.traverse((object) => (geometry = object.geometry ?? geometry));

const attribute = (name) => geometry.getAttribute(name === "POSITION" ? "position" : `khr_gaussian_splatting:${name.toLowerCase()}`);
const values = (name) => {
    const found = attribute(name);
    return (row, item) => found.getComponent(row, item);
};
const columns = [];
const add = (name, value) => columns.push({ name, value });
const addAll = (names, value) => names.forEach((name, item) => add(name, (row) => value(row, item)));
addAll(["x", "y", "z"], values("POSITION"));
const zero = values("SH_DEGREE_0_COEF_0");
addAll(["f_dc_0", "f_dc_1", "f_dc_2"], zero);
const rest = [];
for (let degree = 1; degree <= 3; degree++) {
    for (let i = 0; i < 2 * degree + 1 && attribute(`SH_DEGREE_${degree}_COEF_${i}`); i++) {
        rest.push(values(`SH_DEGREE_${degree}_COEF_${i}`));
    }
}
for (let channel = 0; channel < 3; channel++) {
    rest.forEach((value, i) => add(`f_rest_${channel * rest.length + i}`, (row) => value(row, channel)));
}
const opacity = values("OPACITY");
add("opacity", (row) => Math.log(opacity(row, 0) / (1 - opacity(row, 0))));
const scale = values("SCALE");
addAll(["scale_0", "scale_1", "scale_2"], (row, item) => Math.log(scale(row, item)));
const rotation = values("ROTATION"); // x y z w
addAll(["rot_0", "rot_1", "rot_2", "rot_3"], (row, item) => rotation(row, (item + 3) % 4));

const count = attribute("POSITION").count;
const header = ["ply", "format binary_little_endian 1.0", `element vertex ${count}`,
    ...columns.map(({ name }) => `property float ${name}`), "end_header", ""].join("\n");
const body = new DataView(new ArrayBuffer(4 * count * columns.length));
for (let row = 0, at = 0; row < count; row++) {
    for (const { value } of columns) {
        body.setFloat32(at, value(row), true);
        at += 4;
    }
}
await writeFile(output, Buffer.concat([Buffer.from(header, "latin1"), new Uint8Array(body.buffer)]));
