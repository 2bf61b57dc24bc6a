/* SPDX-License-Identifier: Apache-2.0 */
// A file of ours, read by MCAP's reference reader: every record checked, every message decoded by its own schema text.
// Chunked files are read once more by the reader that seeks by the index.
//   node read_ours.mjs none|zstd|lz4|unchunked ENCODING FILE
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { loadDecompressHandlers } from "@mcap/support";
import { definitions } from "./ros2.mjs";
import * as sample from "./sample.mjs";

const decompressHandlers = await loadDecompressHandlers();
const [storage, encoding, path] = process.argv.slice(2);
const bytes = readFileSync(path);

const identity = [1, 0, 0, 0, 1, 0, 0, 0, 1];
const header = (f, frame_id) => ({ stamp: sample.stamp(f), frame_id });
const expected = {
  "/camera/image": (f) => ({
    header: header(f, "camera"), height: sample.HEIGHT, width: sample.WIDTH, encoding, is_bigendian: 0,
    step: sample.step(encoding), data: sample.image(encoding, f),
  }),
  "/camera/depth": (f) => ({
    header: header(f, "camera"), height: sample.DEPTH_HEIGHT, width: sample.DEPTH_WIDTH, encoding: "16UC1",
    is_bigendian: 0, step: 2 * sample.DEPTH_WIDTH,
    data: Uint8Array.from(sample.depth(f).flatMap((z) => [z & 255, z >> 8])),
  }),
  "/camera/camera_info": (f) => {
    const [fx, , cx, , fy, cy] = sample.k(f);
    return {
      header: header(f, "camera"), height: sample.HEIGHT, width: sample.WIDTH, distortion_model: sample.model(f),
      d: Float64Array.from(sample.d(f)), k: Float64Array.from(sample.k(f)), r: Float64Array.from(identity),
      p: Float64Array.from([fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0]), binning_x: 0, binning_y: 0,
      roi: { x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false },
    };
  },
  "/camera/pose": (f) => ({
    header: header(f, "world"), pose: { position: sample.position(f), orientation: sample.orientation(f) },
  }),
  "/tf": (f) => ({
    transforms: [{
      header: header(f, "world"), child_frame_id: "camera",
      transform: { translation: sample.position(f), rotation: sample.orientation(f) },
    }],
  }),
};

// nanosec is called nsec by the reader of ROS 2 messages
const plain = (message) => {
  if (message.transforms) return { transforms: message.transforms.map(plain) };
  const { sec, nsec, nanosec } = message.header.stamp;
  return { ...message, header: { ...message.header, stamp: { sec, nanosec: nanosec ?? nsec } } };
};

// The schema's text says what a ROS 2 installation says, with all that the message refers to.
function checkSchema(schema) {
  const plainly = (list, root) => list.map((definition, i) => ({
    name: i === 0 ? root : definition.name,
    fields: definition.definitions.filter((field) => !field.isConstant).map(
      ({ type, name, isArray, arrayLength }) => [type.replace("builtin_interfaces/Time", "time"), name, !!isArray, arrayLength]),
  })).filter(({ name }) => name !== "builtin_interfaces/Time").sort((a, b) => a.name.localeCompare(b.name));
  const root = schema.name.replace("/msg/", "/");
  const text = new TextDecoder().decode(schema.data);
  assert.deepEqual(plainly(parse(text, { ros2: true }), root), plainly(definitions(schema.name), root), schema.name);
}

// One message against the sample's; `list` holds those of its topic before it.
function check(record, channel, schema, list) {
  const f = channel.topic === "/camera/depth" && list.length === 1 ? 2 : list.length;
  const text = new TextDecoder().decode(schema.data);
  const decoded = new MessageReader(parse(text, { ros2: true })).readMessage(record.data);
  assert.deepEqual(plain(decoded), expected[channel.topic](f), `${channel.topic} of frame ${f}`);
  assert.equal(record.logTime, sample.stampNs(f));
  assert.equal(record.publishTime, sample.stampNs(f));
  assert.equal(record.sequence, list.length);
  list.push(decoded);
}

const reader = new McapStreamReader({ validateCrcs: true, decompressHandlers });
reader.append(bytes);
const seen = { messages: {}, metadata: {}, schemas: new Map(), channels: new Map(), order: [] };
let inSummary = false;
for (let record; (record = reader.nextRecord()); ) {
  switch (record.type) {
    case "Header":
      assert.equal(record.profile, "ros2");
      assert.match(record.library, /^trim3r \d+\.\d+\.\d+$/);
      break;
    case "Schema":
      assert.equal(record.encoding, "ros2msg");
      seen.schemas.set(record.id, record);
      checkSchema(record);
      break;
    case "Channel":
      assert.equal(record.messageEncoding, "cdr");
      assert.ok(record.metadata.has("offered_qos_profiles"));
      seen.channels.set(record.id, record);
      break;
    case "Message": {
      const channel = seen.channels.get(record.channelId);
      const list = (seen.messages[channel.topic] ??= []);
      check(record, channel, seen.schemas.get(channel.schemaId), list);
      seen.order.push(channel.topic);
      break;
    }
    case "Metadata":
      seen.metadata[record.name] = Object.fromEntries(record.metadata);
      break;
    case "DataEnd":
      assert.notEqual(record.dataSectionCrc, 0);
      inSummary = true;
      break;
    case "Statistics":
      assert.ok(inSummary);
      assert.equal(record.messageCount, BigInt(5 * sample.FRAMES - 1));
      assert.equal(record.channelMessageCounts.get(1), BigInt(sample.FRAMES - 1));
      assert.equal(record.messageStartTime, sample.stampNs(0));
      assert.equal(record.messageEndTime, sample.stampNs(sample.FRAMES - 1));
      break;
  }
}
assert.ok(reader.done());
assert.equal(reader.bytesRemaining(), 0);
for (const topic of Object.keys(expected)) {
  assert.equal(seen.messages[topic].length, topic === "/camera/depth" ? sample.FRAMES - 1 : sample.FRAMES, topic);
}
assert.equal(seen.order.at(-1), "/camera/image");
assert.deepEqual(seen.metadata.trim3r_triplets, { triplets: sample.TRIPLETS });
const { version, bits_epoch, ...rest } = seen.metadata.trim3r;
assert.match(version, /^\d+\.\d+\.\d+$/);
assert.match(bits_epoch, /^[1-9]\d*$/);
assert.deepEqual(rest, { depth_unit: sample.DEPTH_UNIT, clock: "synthetic", source: "sample" });

// The summary, by the reader that starts at the footer; it checks the summary's CRC.
const indexed = await McapIndexedReader.Initialize({
  readable: {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)),
  },
  decompressHandlers,
});
assert.equal(indexed.statistics.metadataCount, 2);
assert.deepEqual([...indexed.channelsById.values()].map((channel) => channel.topic), Object.keys(expected));
assert.deepEqual(indexed.metadataIndexes.map((index) => index.name), ["trim3r", "trim3r_triplets"]);
for await (const metadata of indexed.readMetadata({ name: "trim3r_triplets" })) {
  assert.equal(metadata.metadata.get("triplets"), sample.TRIPLETS);
}
const found = Object.fromEntries(Object.keys(expected).map((topic) => [topic, []]));
for await (const message of indexed.readMessages({ validateCrcs: true })) {
  const channel = indexed.channelsById.get(message.channelId);
  check(message, channel, indexed.schemasById.get(channel.schemaId), found[channel.topic]);
}
const chunked = storage !== "unchunked";
assert.equal(indexed.statistics.chunkCount, chunked ? sample.FRAMES : 0);
assert.equal(indexed.chunkIndexes.length, chunked ? sample.FRAMES : 0);
for (const topic of Object.keys(expected)) { // a reader that seeks finds what stands in chunks
  assert.equal(found[topic].length, chunked ? seen.messages[topic].length : 0, topic);
}
const first = sample.stampNs(1);
let later = 0;
for await (const message of indexed.readMessages({ startTime: first, topics: ["/tf"] })) {
  assert.ok(message.logTime >= first);
  later++;
}
assert.equal(later, chunked ? sample.FRAMES - 1 : 0);
console.log(`${storage}, ${encoding}: ${seen.order.length} messages as written`);
