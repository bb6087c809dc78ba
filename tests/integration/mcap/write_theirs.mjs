// Writes recordings with @mcap/core as a foreign program might, with the schemas found in a recording of ours.
import { closeSync, openSync, writeSync } from "node:fs";
import { McapIndexedReader, McapWriter } from "@mcap/core";
import { imageOf, loadZstd, readableOf, streams, timeOf, typeOf } from "./contents.mjs";

const [, , ours, folder] = process.argv;
const zstd = await loadZstd();

async function schemaOfOurs() {
  const decompressHandlers = { zstd: (data, size) => zstd.decompress(data, Number(size)) };
  const reader = await McapIndexedReader.Initialize({ readable: readableOf(ours), decompressHandlers });
  return [...reader.schemasById.values()].find(({ name }) => name === "foxglove.RawImage");
}

function fileWriter(path) {
  const file = openSync(path, "w");
  let position = 0n;
  return {
    write: async (bytes) => void (position += BigInt(writeSync(file, bytes))),
    position: () => position,
    close: () => closeSync(file),
  };
}

/** Depth first, then thermal: the file's order is not that of time. */
async function write(path, options) {
  const writable = fileWriter(path);
  const writer = new McapWriter({ writable, chunkSize: 3000, ...options });
  await writer.start({ profile: "", library: "foreign" });
  const schema = await schemaOfOurs();
  const type = typeOf(schema);
  const schemaId = await writer.registerSchema({ name: schema.name, encoding: schema.encoding, data: schema.data });
  for (const [name, stream] of Object.entries(streams)) {
    const channelId = await writer.registerChannel({
      schemaId, topic: `/${name}`, messageEncoding: "protobuf", metadata: new Map(),
    });
    for (let n = 0; n < stream.frames; n++) {
      const logTime = timeOf(stream, n);
      const data = type.encode({
        timestamp: { seconds: Number(logTime / 1_000_000_000n), nanos: Number(logTime % 1_000_000_000n) },
        frame_id: name, width: stream.width, height: stream.height,
        encoding: "mono16", step: 2 * stream.width, data: imageOf(stream, n),
      }).finish();
      await writer.addMessage({ channelId, sequence: n, logTime, publishTime: logTime, data });
    }
  }
  await writer.addMetadata({ name: "origin", metadata: new Map([["folder", "scan"], ["unit", "µK"]]) });
  await writer.end();
  writable.close();
}

const compressChunk = (data) => ({ compression: "zstd", compressedData: zstd.compress(data, 3) });
await write(`${folder}/zstd.mcap`, { compressChunk });
await write(`${folder}/uncompressed.mcap`, {});
await write(`${folder}/unchunked.mcap`, { useChunks: false });
await write(`${folder}/no_index.mcap`, {
  compressChunk, useStatistics: false, useSummaryOffsets: false, repeatSchemas: false, repeatChannels: false,
  useMetadataIndex: false, useMessageIndex: false, useChunkIndex: false,
});
