/* SPDX-License-Identifier: Apache-2.0 */
// The sample as MCAP's reference writer stores it: chunked with lz4, zstd, uncompressed, and without chunks; poses as
// TransformStamped.   node write_theirs.mjs none|lz4|zstd|unchunked ENCODING FILE
import { writeFileSync } from "node:fs";
import { McapWriter, TempBuffer } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import * as zstd from "@foxglove/wasm-zstd";
import lz4 from "lz4js";
import { SCHEMAS } from "./schemas.mjs";
import * as sample from "./sample.mjs";

const [packing, encoding, path] = process.argv.slice(2);
await zstd.isLoaded;
const compressors = {
  lz4: (data) => ({ compression: "lz4", compressedData: Uint8Array.from(lz4.compress(data)) }),
  zstd: (data) => ({ compression: "zstd", compressedData: zstd.compress(data, 3) }),
};
const writable = new TempBuffer();
const writer = new McapWriter({
  writable, useChunks: packing !== "unchunked", chunkSize: 2000, compressChunk: compressors[packing],
});
await writer.start({ profile: "ros2", library: "reference" });
await writer.addMetadata({
  name: "trim3r",
  metadata: new Map([["bits_epoch", "1"], ["depth_unit", sample.DEPTH_UNIT], ["clock", "synthetic"]]),
});
await writer.addMetadata({ name: "trim3r_triplets", metadata: new Map([["triplets", sample.TRIPLETS]]) });
await writer.addAttachment({
  logTime: 0n, createTime: 0n, name: "a", mediaType: "text/plain", data: new Uint8Array(9),
});

async function channel(topic, name) {
  const text = SCHEMAS[name];
  const schemaId = await writer.registerSchema({ name, encoding: "ros2msg", data: new TextEncoder().encode(text) });
  const id = await writer.registerChannel({ schemaId, topic, messageEncoding: "cdr", metadata: new Map() });
  const serializer = new MessageWriter(parse(text, { ros2: true }));
  let sequence = 0;
  return (f, message) => writer.addMessage({
    channelId: id, sequence: sequence++, logTime: sample.stampNs(f), publishTime: sample.stampNs(f),
    data: serializer.writeMessage(message),
  });
}

const image = await channel("/camera/image", "sensor_msgs/msg/Image");
const depth = await channel("/camera/depth", "sensor_msgs/msg/Image");
const info = await channel("/camera/camera_info", "sensor_msgs/msg/CameraInfo");
const pose = await channel("/tracker/transform", "geometry_msgs/msg/TransformStamped");
for (let f = 0; f < sample.FRAMES; f++) {
  const { sec, nanosec } = sample.stamp(f);
  const header = { stamp: { sec, nsec: nanosec, nanosec }, frame_id: "optical" };
  await image(f, {
    header, height: sample.HEIGHT, width: sample.WIDTH, encoding, is_bigendian: 0, step: sample.step(encoding),
    data: sample.image(encoding, f),
  });
  if (sample.depth(f)) {
    await depth(f, {
      header, height: sample.DEPTH_HEIGHT, width: sample.DEPTH_WIDTH, encoding: "16UC1", is_bigendian: 0,
      step: 2 * sample.DEPTH_WIDTH, data: Uint8Array.from(sample.depth(f).flatMap((z) => [z & 255, z >> 8])),
    });
  }
  await info(f, {
    header, height: sample.HEIGHT, width: sample.WIDTH, distortion_model: sample.model(f), d: sample.d(f),
    k: sample.k(f), r: [1, 0, 0, 0, 1, 0, 0, 0, 1], p: new Array(12).fill(0), binning_x: 0, binning_y: 0,
    roi: { x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false },
  });
  await pose(f, {
    header, child_frame_id: "optical",
    transform: { translation: sample.position(f), rotation: sample.orientation(f) },
  });
}
await writer.end();
writeFileSync(path, writable.get());
