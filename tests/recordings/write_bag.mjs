/* SPDX-License-Identifier: Apache-2.0 */
// A bag as MCAP's reference writer stores it, of the messages that SPEC lists: {packing, messages: [{topic, type, stamp
// (ns), message, data (base64)}]}. `data` becomes the field of that name. node write_bag.mjs SPEC FILE
import { readFileSync, writeFileSync } from "node:fs";
import { McapWriter, TempBuffer } from "@mcap/core";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import * as zstd from "@foxglove/wasm-zstd";
import lz4 from "lz4js";
import { definitions, text } from "./ros2.mjs";

const { packing, messages } = JSON.parse(readFileSync(process.argv[2], "utf8"));
await zstd.isLoaded;
const compressors = {
  lz4: (data) => ({ compression: "lz4", compressedData: Uint8Array.from(lz4.compress(data)) }),
  zstd: (data) => ({ compression: "zstd", compressedData: zstd.compress(data, 3) }),
};
const writable = new TempBuffer();
const writer = new McapWriter({ writable, chunkSize: 5000, compressChunk: compressors[packing] });
await writer.start({ profile: "ros2", library: "reference" });
const channels = new Map();
for (const { topic, type, stamp, message, data } of messages) {
  if (!channels.has(topic)) {
    const schemaId = await writer.registerSchema({
      name: type, encoding: "ros2msg", data: new TextEncoder().encode(text(type)),
    });
    const id = await writer.registerChannel({ schemaId, topic, messageEncoding: "cdr", metadata: new Map() });
    channels.set(topic, { id, serializer: new MessageWriter(definitions(type)), sequence: 0 });
  }
  const channel = channels.get(topic);
  if (data !== undefined) message.data = Uint8Array.from(Buffer.from(data, "base64"));
  await writer.addMessage({
    channelId: channel.id, sequence: channel.sequence++, logTime: BigInt(stamp), publishTime: BigInt(stamp),
    data: channel.serializer.writeMessage(message),
  });
}
await writer.end();
writeFileSync(process.argv[3], writable.get());
