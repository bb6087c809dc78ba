// What the recordings of this test contain; mcap_fixture.cc has the same.
import { readFileSync } from "node:fs";
import zstd from "@foxglove/wasm-zstd";
import protobuf from "protobufjs";
import "protobufjs/ext/descriptor/index.js";
import descriptor from "protobufjs/ext/descriptor/index.js";

export const START_NS = 1_700_000_000_000_000_000n;
export const streams = {
  depth: { frames: 30, periodNs: 33_333_333n, width: 16, height: 12 },
  thermal: { frames: 40, periodNs: 25_000_000n, width: 12, height: 10 },
};
export const timeOf = (stream, n) => START_NS + BigInt(n) * stream.periodNs;
export const pixelOf = (n, x, y) => (1000 * n + 7 * x + 13 * y) % 65536;

export function imageOf(stream, n) {
  const data = new Uint8Array(2 * stream.width * stream.height);
  const view = new DataView(data.buffer);
  for (let y = 0; y < stream.height; y++) {
    for (let x = 0; x < stream.width; x++) {
      view.setUint16(2 * (y * stream.width + x), pixelOf(n, x, y), true);
    }
  }
  return data;
}

export async function loadZstd() {
  await zstd.isLoaded;
  return zstd;
}

/** The message type that an MCAP schema record describes. */
export function typeOf(schema) {
  const files = descriptor.FileDescriptorSet.decode(schema.data);
  return protobuf.Root.fromDescriptor(files).lookupType(schema.name);
}

export function readableOf(path) {
  const bytes = new Uint8Array(readFileSync(path));
  return {
    bytes,
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
  };
}

export const toNs = (time) => BigInt(time.seconds.toString()) * 1_000_000_000n + BigInt(time.nanos ?? 0);
