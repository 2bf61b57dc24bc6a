/* SPDX-License-Identifier: Apache-2.0 */
// node spz_reference.mjs <JOBS.json: .spz files by the reference code of the format, @adobe/spz. A job is
//   {"read": IN.spz, "to": OUT.ply}: what it reads, as a 3DGS .ply with the axes of one;
//   {"write": OUT.spz, "from": IN.ply, "mip": whether}: the latest version, harmonics with all their bits.
import { readFile, writeFile } from "node:fs/promises";
import createSpzModule from "@adobe/spz";

const PLACES = ["x", "y", "z"], COLOURS = ["f_dc_0", "f_dc_1", "f_dc_2"];
const SCALES = ["scale_0", "scale_1", "scale_2"], ROTATIONS = ["rot_1", "rot_2", "rot_3", "rot_0"]; // x y z w
const spz = await createSpzModule();
const { RDF } = spz.CoordinateSystem; // a .ply's axes: x right, y down, z forward

// Coefficients lie channel by channel in a .ply, and coefficient by coefficient in .spz.
const restNames = (degree) => {
    const count = (degree + 1) ** 2 - 1;
    return Array.from({ length: 3 * count }, (_, i) => `f_rest_${(i % 3) * count + Math.floor(i / 3)}`);
};

const fields = (degree) => [["positions", PLACES], ["colors", COLOURS], ["sh", restNames(degree)], ["alphas", ["opacity"]],
    ["scales", SCALES], ["rotations", ROTATIONS]];

async function readPly(path) {
    const bytes = await readFile(path), end = bytes.indexOf("end_header\n") + 11;
    const lines = bytes.subarray(0, end).toString("latin1").split("\n");
    const names = lines.filter((line) => line.startsWith("property float ")).map((line) => line.split(" ")[2]);
    const count = Number(lines.find((line) => line.startsWith("element vertex ")).split(" ")[2]);
    const at = new DataView(bytes.buffer, bytes.byteOffset + end);
    const degree = Math.sqrt(names.filter((name) => name.startsWith("f_rest_")).length / 3 + 1) - 1;
    const cloud = { numPoints: count, shDegree: degree, antialiased: false, extensions: [] };
    for (const [field, columns] of fields(degree)) {
        cloud[field] = Float32Array.from({ length: count * columns.length }, (_, i) => at.getFloat32(
            4 * (Math.floor(i / columns.length) * names.length + names.indexOf(columns[i % columns.length])), true));
    }
    return cloud;
}

async function writePly(path, cloud) {
    const degree = cloud.shDegree, columns = fields(degree).flatMap(([field, names]) => names.map((name, i) => [name, cloud[field], i, names.length]));
    const body = new Float32Array(cloud.numPoints * columns.length);
    body.forEach((_, i) => {
        const [, values, item, width] = columns[i % columns.length];
        body[i] = values[Math.floor(i / columns.length) * width + item];
    });
    const mark = cloud.antialiased ? ["comment SplatRenderMode: mip"] : [];
    const header = ["ply", "format binary_little_endian 1.0", ...mark, `element vertex ${cloud.numPoints}`,
        ...columns.map(([name]) => `property float ${name}`), "end_header", ""].join("\n");
    await writeFile(path, Buffer.concat([Buffer.from(header, "latin1"), new Uint8Array(body.buffer)]));
}

async function write(job) {
    const cloud = await readPly(job.from);
    cloud.antialiased = job.mip;
    const bytes = spz.saveSpzToBuffer(cloud, { version: spz.LATEST_SPZ_HEADER_VERSION, from: RDF, sh1Bits: 8, shRestBits: 8 });
    await writeFile(job.write, bytes);
}

let text = "";
for await (const part of process.stdin) {
    text += part;
}
for (const job of JSON.parse(text)) {
    if (job.write) {
        await write(job);
    } else {
        await writePly(job.to, spz.loadSpzFromBuffer(await readFile(job.read), { to: RDF }));
    }
}
