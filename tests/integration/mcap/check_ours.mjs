// Reads recordings of ours with both readers of @mcap/core and checks every message, schema, index and checksum.
import assert from "node:assert/strict";
import { crc32 } from "@foxglove/crc";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { imageOf, loadZstd, readableOf, START_NS, streams, timeOf, toNs, typeOf } from "./contents.mjs";

const zstd = await loadZstd();
const decompressHandlers = { zstd: (data, size) => zstd.decompress(data, Number(size)) };
const common = {
  "/depth": 30, "/thermal": 40, "/rig": 1, "/depth/camera_info": 1, "/thermal/camera_info": 1,
  "/nuc": 1, "/groundtruth": 1, "/log": 1,
};

async function checkIndexed(path, viewable) {
  const readable = readableOf(path);
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  assert.match(reader.header.library, /^isotherm \d/);
  assert.ok(reader.chunkIndexes.length >= 2, "several chunks");
  assert.equal(reader.dataSectionCrc, crc32(readable.bytes.subarray(0, Number(reader.dataEndOffset))));

  const seen = {};
  let last = 0n;
  const messages = new Map();
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const { topic, schemaId, messageEncoding } = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(schemaId);
    assert.equal(messageEncoding, "protobuf");
    assert.equal(schema.encoding, "protobuf");
    assert.ok(message.logTime >= last, "order of log time");
    last = message.logTime;
    assert.equal(message.sequence, seen[topic] ?? 0);
    seen[topic] = (seen[topic] ?? 0) + 1;
    if (!messages.has(topic)) messages.set(topic, []);
    messages.get(topic).push({ ...message, schema, value: typeOf(schema).decode(message.data) });
  }
  // For viewers, the place of the thermal camera is there as a transform.
  const counts = viewable ? { ...common, "/thermal/transform": 1 } : common;
  assert.deepEqual(seen, counts);
  const total = Object.values(counts).reduce((a, b) => a + b);
  assert.equal(Number(reader.statistics.messageCount), total);
  assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
  assert.equal(reader.statistics.messageStartTime, START_NS);
  for (const [id, count] of reader.statistics.channelMessageCounts) {
    assert.equal(Number(count), counts[reader.channelsById.get(id).topic]);
  }
  await checkSeek(reader);
  await checkMetadata(reader);
  return messages;
}

/** One topic from a time on: goes through the message indexes. */
async function checkSeek(reader) {
  const times = [];
  for await (const message of reader.readMessages({ topics: ["/thermal"], startTime: START_NS + 500_000_000n })) {
    times.push(message.logTime);
  }
  assert.equal(times.length, 20);
  assert.equal(times[0], START_NS + 500_000_000n);
}

async function checkMetadata(reader) {
  const metadata = {};
  for await (const { name, metadata: values } of reader.readMetadata()) metadata[name] = Object.fromEntries(values);
  assert.deepEqual(metadata.origin, { folder: "scan", unit: "µK" });
  assert.match(metadata["isotherm.recording"].version, /^1\./);
}

function checkFrames(messages, compact) {
  for (const [name, stream] of Object.entries(streams)) {
    messages.get(`/${name}`).forEach(({ value, logTime, publishTime, schema }, n) => {
      assert.equal(schema.name, compact ? "foxglove.CompressedImage" : "foxglove.RawImage");
      assert.equal(logTime, timeOf(stream, n));
      assert.equal(publishTime, timeOf(stream, n) + 5_000_000n);
      assert.equal(toNs(value.timestamp), timeOf(stream, n));
      assert.equal(toNs(value.frame.arrival), timeOf(stream, n) + 5_000_000n);
      assert.equal(value.frame_id, name);
      assert.equal(Number(value.frame.frame_number), n);
      assert.equal(Number(value.frame.session), 42);
      assert.equal(Number(value.frame.device_ticks), 1000 * n);
      assert.equal(Number(value.frame.capture_sigma_ns), 777);
      assert.equal(value.frame.width, stream.width);
      assert.equal(value.frame.height, stream.height);
      if (compact) {
        assert.match(value.format, /^isotherm-\d+$/);
        assert.ok(value.data.length > 0);
        return;
      }
      assert.equal(value.width, stream.width);
      assert.equal(value.height, stream.height);
      assert.equal(value.step, 2 * stream.width);
      assert.equal(value.encoding, "16UC1");
      assert.deepEqual(new Uint8Array(value.data), imageOf(stream, n));
    });
  }
  assert.equal(messages.get("/depth")[0].value.depth.depth_scale, 5000);
  const thermal = messages.get("/thermal")[39].value.thermal;
  assert.equal(thermal.nuc_state, 5);
  assert.equal(thermal.nuc_source, 2);
  assert.equal(thermal.seconds_since_nuc, 0.25);
  assert.equal(thermal.fpa_celsius, 31.5);
  assert.ok(!Object.hasOwn(thermal, "shutter_celsius"));
  assert.equal(thermal.valid, true);
}

function checkOthers(messages) {
  const only = (topic) => messages.get(topic)[0].value;
  const info = only("/thermal/camera_info");
  assert.equal(info.distortion_model, "plumb_bob");
  assert.equal(info.width, 12);
  assert.deepEqual(info.D, [-0.25, 0.1, 0.001, -0.002, 0.01]);
  assert.deepEqual(info.K, [600, 0, 6, 0, 601, 5, 0, 0, 1]);
  assert.deepEqual(info.P, [600, 0, 6, 0, 0, 601, 5, 0, 0, 0, 1, 0]);
  const rig = only("/rig").calibration;
  assert.equal(rig.depth.fx, 580);
  assert.equal(rig.thermal_delay_s, -0.0427);
  assert.ok(Math.abs(rig.T_thermal_depth.tx - 0.05) < 1e-12);
  const pose = only("/groundtruth");
  assert.equal(pose.parent_frame_id, "world");
  assert.equal(pose.child_frame_id, "depth");
  assert.deepEqual({ ...pose.translation }, { x: 1, y: 2, z: 3 });
  assert.equal(toNs(only("/nuc").end) - toNs(only("/nuc").start), 300_000_000n);
  assert.equal(only("/log").message, "closer");
  assert.equal(only("/log").level, 3);
}

function checkStream(path, viewable) {
  const reader = new McapStreamReader({ validateCrcs: true, decompressHandlers });
  const { bytes } = readableOf(path);
  const kinds = {};
  for (let at = 0; at < bytes.length; at += 1000) {
    reader.append(bytes.subarray(at, at + 1000));
    for (let record; (record = reader.nextRecord()); ) kinds[record.type] = (kinds[record.type] ?? 0) + 1;
  }
  assert.ok(reader.done(), "the stream reader reaches the end of the file");
  assert.equal(kinds.Message, viewable ? 77 : 76);
  assert.equal(kinds.Statistics, 1);
  assert.ok(kinds.ChunkIndex >= 2);
  assert.ok(kinds.SummaryOffset >= 4);
}

const folder = process.argv[2];
for (const storage of ["viewable", "compact"]) {
  const path = `${folder}/${storage}.mcap`;
  const messages = await checkIndexed(path, storage === "viewable");
  checkFrames(messages, storage === "compact");
  checkOthers(messages);
  checkStream(path, storage === "viewable");
  console.log(`${path}: read by both readers of @mcap/core`);
}
