// Checks a converted recording against the official Foxglove schemas: their own .proto definitions decode each message,
// images and transforms are what viewers expect, and nothing hangs loose between the coordinate frames.
//   node check_viewable.mjs FILE
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { McapIndexedReader } from "@mcap/core";
import protobuf from "protobufjs";
import { imageOf, loadZstd, readableOf, START_NS, streams, timeOf, toNs } from "./contents.mjs";

const { foxgloveEnumSchemas, foxgloveMessageSchemas, generateProto } =
  createRequire(import.meta.url)("@foxglove/schemas/internal.js");

const TIMESTAMP = "google.protobuf.Timestamp";

/** The message type as Foxglove defines it, with all that it is made of. */
function officialType(fullName) {
  const root = new protobuf.Root();
  root.define("google.protobuf").add(new protobuf.Type("Timestamp")
    .add(new protobuf.Field("seconds", 1, "int64")).add(new protobuf.Field("nanos", 2, "int32")));
  root.define("google.protobuf").add(new protobuf.Type("Duration")
    .add(new protobuf.Field("seconds", 1, "int64")).add(new protobuf.Field("nanos", 2, "int32")));
  const wanted = [fullName.replace("foxglove.", "")];
  const done = new Set();
  while (wanted.length > 0) {
    const name = wanted.pop();
    if (done.has(name) || name === "Timestamp" || name === "Duration") continue;
    done.add(name);
    const schema = foxgloveMessageSchemas[name];
    assert.ok(schema, `${name} is a schema of Foxglove`);
    const enums = Object.values(foxgloveEnumSchemas).filter(({ parentSchemaName }) => parentSchemaName === name);
    const text = generateProto(schema, enums).replace(/^import .*$/gm, "");
    protobuf.parse(text, root, { keepCase: true });
    for (const { type } of schema.fields) if (type.type === "nested") wanted.push(type.schema.name);
  }
  root.resolveAll();
  assert.ok(root.lookupType(TIMESTAMP));
  return root.lookupType(fullName);
}

async function readFoxglove(path) {
  const zstd = await loadZstd();
  const decompressHandlers = { zstd: (data, size) => zstd.decompress(data, Number(size)) };
  const reader = await McapIndexedReader.Initialize({ readable: readableOf(path), decompressHandlers });
  const types = new Map();
  const topics = new Map();
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const { topic, schemaId } = reader.channelsById.get(message.channelId);
    const { name } = reader.schemasById.get(schemaId);
    if (!name.startsWith("foxglove.")) continue;
    if (!types.has(name)) types.set(name, officialType(name));
    if (!topics.has(topic)) topics.set(topic, []);
    topics.get(topic).push({ name, logTime: message.logTime, value: types.get(name).decode(message.data) });
  }
  return topics;
}

function checkImages(topics) {
  for (const [name, stream] of Object.entries(streams)) {
    const messages = topics.get(`/${name}`);
    assert.equal(messages.length, stream.frames);
    messages.forEach(({ name: schema, value }, n) => {
      assert.equal(schema, "foxglove.RawImage");
      assert.equal(value.frame_id, name);
      assert.equal(value.encoding, "16UC1");
      assert.equal(value.width, stream.width);
      assert.equal(value.height, stream.height);
      assert.equal(value.step, 2 * stream.width);
      assert.equal(toNs(value.timestamp), timeOf(stream, n));
      assert.deepEqual(new Uint8Array(value.data), imageOf(stream, n));
    });
    const [{ name: schema, value: info }] = topics.get(`/${name}/camera_info`);
    assert.equal(schema, "foxglove.CameraCalibration");
    assert.equal(info.frame_id, name);
    assert.equal(info.width, stream.width);
    assert.equal(info.K.length, 9);
    assert.equal(info.P.length, 12);
  }
}

function checkTransforms(topics) {
  const only = (topic) => topics.get(topic)?.[0].value ?? assert.fail(`no ${topic}`);
  const thermal = only("/thermal/transform");
  assert.equal(thermal.parent_frame_id, "depth");
  assert.equal(thermal.child_frame_id, "thermal");
  // T_thermal_depth moves by +0.05 m along x: in depth coordinates the thermal camera is at -0.05 m.
  assert.ok(Math.abs(thermal.translation.x + 0.05) < 1e-12);
  assert.ok(Math.abs(thermal.rotation.w - 1) < 1e-12);

  const tracked = topics.get("/trajectory");
  assert.deepEqual(tracked.map(({ value }) => value.translation.z), [0.5, 0.75]);
  assert.equal(toNs(tracked[1].value.timestamp), START_NS + 300_000_000n);
  // One parent for each coordinate frame: the tracked pose is the rig's, the true one stands beside it.
  assert.equal(only("/trajectory").parent_frame_id, "world");
  assert.equal(only("/trajectory").child_frame_id, "depth");
  assert.equal(only("/groundtruth").child_frame_id, "groundtruth");
  const parents = new Map();
  for (const messages of topics.values()) {
    for (const { name, value } of messages) {
      if (name !== "foxglove.FrameTransform") continue;
      assert.equal(parents.get(value.child_frame_id) ?? value.parent_frame_id, value.parent_frame_id);
      parents.set(value.child_frame_id, value.parent_frame_id);
    }
  }
  assert.deepEqual(Object.fromEntries(parents), { depth: "world", thermal: "depth", groundtruth: "world" });
}

const path = process.argv[2];
const topics = await readFoxglove(path);
checkImages(topics);
checkTransforms(topics);
assert.equal(topics.get("/log")[0].value.message, "closer");
console.log(`${path}: as Foxglove's schemas have it`);
