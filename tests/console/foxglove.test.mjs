// /foxglove by the protocol's own library, each message decoded by the official schemas.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { after, before, test } from "node:test";
import wsProtocol from "@foxglove/ws-protocol";
import protobuf from "protobufjs";
import descriptor from "protobufjs/ext/descriptor/index.js";
import WebSocket from "ws";
import { Stack, until } from "./stack.mjs";

const require = createRequire(import.meta.url);
const stack = new Stack();
before(async () => {
  await stack.startGround();
  stack.startEdge();
});
after(() => stack.stop());

const { foxgloveEnumSchemas, foxgloveMessageSchemas, generateProto } = require("@foxglove/schemas/internal.js");

/** A message type as Foxglove defines it, with all that it is made of. */
function officialType(fullName) {
  const root = new protobuf.Root();
  for (const name of ["Timestamp", "Duration"])
    root.define("google.protobuf").add(new protobuf.Type(name).add(new protobuf.Field("seconds", 1, "int64")).add(new protobuf.Field("nanos", 2, "int32")));
  const wanted = [fullName.replace("foxglove.", "")];
  const done = new Set();
  while (wanted.length > 0) {
    const name = wanted.pop();
    if (done.has(name) || name === "Timestamp" || name === "Duration") continue;
    done.add(name);
    const schema = foxgloveMessageSchemas[name];
    assert.ok(schema, `${name} is a schema of Foxglove`);
    const enums = Object.values(foxgloveEnumSchemas).filter(({ parentSchemaName }) => parentSchemaName === name);
    protobuf.parse(generateProto(schema, enums).replace(/^import .*$/gm, ""), root, { keepCase: true });
    for (const { type } of schema.fields) if (type.type === "nested") wanted.push(type.schema.name);
  }
  root.resolveAll();
  return root.lookupType(fullName);
}
function officialTypes() {
  const names = ["RawImage", "CameraCalibration", "FrameTransforms", "PosesInFrame", "PointCloud", "SceneUpdate", "Log"];
  return new Map(names.map((name) => [`foxglove.${name}`, officialType(`foxglove.${name}`)]));
}

/** What a point cloud says of the temperature of each of its points, in °C. */
function temperaturesOf(type, message) {
  const cloud = type.decode(new Uint8Array(message.buffer, message.byteOffset, message.byteLength));
  assert.equal(cloud.data.length % cloud.point_stride, 0);
  const at = cloud.fields.find(({ name }) => name === "temperature").offset;
  const bytes = Buffer.from(cloud.data);
  return Array.from({ length: bytes.length / cloud.point_stride }, (_, i) => bytes.readFloatLE(i * cloud.point_stride + at));
}

const { FoxgloveClient } = wsProtocol;

for (const subprotocol of [FoxgloveClient.SUPPORTED_SUBPROTOCOL, "foxglove.sdk.v1"]) {
  test(`channels, data and services by ${subprotocol}`, async () => {
    const client = new FoxgloveClient({ ws: new WebSocket(`${stack.url.replace("http", "ws")}/foxglove`, [subprotocol]) });
    const channels = new Map(), services = new Map(), messages = new Map();
    let info;
    client.on("serverInfo", (event) => { info = event; });
    client.on("advertise", (list) => { for (const channel of list) channels.set(channel.topic, channel); });
    client.on("advertiseServices", (list) => { for (const service of list) services.set(service.name, service); });
    const bySubscription = new Map();
    client.on("message", ({ subscriptionId, data }) => {
      const topic = bySubscription.get(subscriptionId);
      if (!messages.has(topic)) messages.set(topic, []);
      messages.get(topic).push(data);
    });
    await until(() => services.size >= 4 && channels.size >= 10, "what is offered");
    assert.match(info.name, /^Isotherm/);
    for (const channel of channels.values()) bySubscription.set(client.subscribe(channel.id), channel.topic);
    await until(() => ["/depth", "/thermal", "/depth/calibration", "/thermal/calibration", "/tf", "/path", "/cloud", "/surface", "/guidance"]
      .every((topic) => messages.has(topic)), `all topics, got ${[...messages.keys()]}`, 60000);

    const types = officialTypes();
    const plain = { bytes: String, longs: String, enums: Number };
    for (const [topic, list] of messages) {
      const channel = channels.get(topic);
      assert.equal(channel.encoding, "protobuf");
      // By the schema that is announced, and by the official one: the same message.
      const set = descriptor.FileDescriptorSet.decode(Buffer.from(channel.schema, "base64"));
      const announced = protobuf.Root.fromDescriptor(set).lookupType(channel.schemaName);
      const official = types.get(channel.schemaName);
      for (const data of list.slice(0, 50)) {
        const bytes = new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
        const own = announced.toObject(announced.decode(bytes), plain);
        if (official) assert.deepEqual(official.toObject(official.decode(bytes), plain), own, topic);
      }
    }
    const measured = () => temperaturesOf(types.get("foxglove.PointCloud"), messages.get("/cloud").at(-1)).some((celsius) => celsius > 0 && celsius < 400);
    await until(measured, "temperatures in °C", 60000);

    const answer = new Promise((resolve) => {
      client.on("serviceCallResponse", (event) => resolve(JSON.parse(new TextDecoder().decode(event.data))));
      client.on("serviceCallFailure", (event) => resolve({ done: false, text: event.message }));
    });
    const request = new TextEncoder().encode("{}");
    client.sendServiceCallRequest({ serviceId: services.get("/nuc_now").id, callId: 7, encoding: "json", data: new DataView(request.buffer) });
    const { text } = await answer;
    assert.equal(typeof text, "string");
    console.log(`# nuc_now: ${text}`);
    client.close();
  });
}
