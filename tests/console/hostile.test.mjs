// Clients that mean no good, or are merely bad, against a running scan: refused, counted, and the scan goes on.
import assert from "node:assert/strict";
import { connect } from "node:net";
import { request } from "node:http";
import { after, before, test } from "node:test";
import WebSocket from "ws";
import { Stack, sleep, until } from "./stack.mjs";

const stack = new Stack();
before(async () => {
  await stack.startGround();
  stack.startEdge();
  await until(async () => Number((await stack.state()).depth?.received ?? 0) > 10, "a scan");
});
after(async () => {
  const [ground] = await stack.stop();
  assert.equal(ground, 0, stack.ground.text.slice(-3000));
});

const received = async () => Number((await stack.state()).depth.received);
const refused = async () => Number((await stack.state()).console.refused);
const dropped = async () => Number((await stack.state()).console.dropped_clients);

function raw(bytes, wait_ms = 300) {
  return new Promise((resolve) => {
    const socket = connect(stack.port, "127.0.0.1");
    let text = "";
    socket.on("data", (data) => { text += data.toString("latin1"); });
    socket.on("error", () => resolve(text));
    socket.on("close", () => resolve(text));
    socket.on("connect", () => socket.write(bytes));
    setTimeout(() => socket.destroy(), wait_ms).unref?.();
  });
}

function get(path, headers = {}) {
  return new Promise((resolve, reject) => {
    const asked = request({ host: "127.0.0.1", port: stack.port, path, headers }, (reply) => {
      let text = "";
      reply.on("data", (data) => { text += data; });
      reply.on("end", () => resolve({ status: reply.statusCode, text, headers: reply.headers }));
    });
    asked.on("error", reject);
    asked.end();
  });
}

function socketCode(path, options) {
  return new Promise((resolve) => {
    const socket = new WebSocket(`ws://127.0.0.1:${stack.port}${path}`, options?.protocols ?? ["isotherm.live.v1"], options);
    socket.on("unexpected-response", (_, reply) => { resolve(reply.statusCode); socket.terminate(); });
    socket.on("open", () => { resolve("open"); socket.close(); });
    socket.on("error", () => resolve("error"));
  });
}

test("paths lead nowhere outside the page", async () => {
  for (const path of ["/../../etc/passwd", "/..%2f..%2fetc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "/dist/app.js", "/app.js/..", "/.console/codes.txt", "/index.html%00.js"]) {
    const { status, text } = await get(path);
    assert.equal(status, 404, path);
    assert.doesNotMatch(text, /root:/);
  }
});

test("foreign hosts and origins are refused", async () => {
  assert.equal((await get("/", { Host: "evil.example" })).status, 421);
  assert.equal((await get("/api/state", { Origin: "http://evil.example" })).status, 403);
  assert.equal(await socketCode("/live", { origin: "http://evil.example" }), 403);
  assert.equal(await socketCode("/live", { headers: { Host: "evil.example" } }), 421);
  assert.equal(await socketCode("/live", { protocols: ["something.else"] }), 400);
  assert.equal(await socketCode("/nowhere"), 404);
});

test("requests that are none are refused and counted", async () => {
  const before = await refused();
  for (const bytes of ["\0\0\0\0\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/9.9\r\n\r\n", `GET /${"a".repeat(70000)} HTTP/1.1\r\n\r\n`,
    `GET / HTTP/1.1\r\nX: ${"b".repeat(70000)}\r\n\r\n`, "POST /api/login HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999\r\n\r\n",
    "POST /api/login HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nFFFFFFFF\r\n", "\x16\x03\x01\x02\0\x01\0"])
    await raw(bytes);
  await until(async () => await refused() > before, "counted");
});

test("malformed, oversized and text messages end the connection", async () => {
  for (const message of [Buffer.from([255, 255, 255, 255, 255]), Buffer.alloc(2 << 20), "text", Buffer.alloc(0)]) {
    const socket = new WebSocket(`ws://127.0.0.1:${stack.port}/live`, ["isotherm.live.v1"]);
    await new Promise((resolve) => socket.on("open", resolve));
    const closed = new Promise((resolve) => socket.on("close", resolve));
    socket.send(message);
    socket.on("error", () => undefined);
    await Promise.race([closed, sleep(3000).then(() => assert.fail("still open"))]);
  }
});

test("a flood of messages ends the connection", async () => {
  const socket = new WebSocket(`ws://127.0.0.1:${stack.port}/live`, ["isotherm.live.v1"]);
  socket.on("error", () => undefined);
  await new Promise((resolve) => socket.on("open", resolve));
  const closed = new Promise((resolve) => socket.on("close", resolve));
  const hello = Buffer.from([0x12, 0x02, 0x08, 0x01]), view = Buffer.from([0x1a, 0x00]);
  socket.send(hello);
  for (let i = 0; i < 2000; ++i) socket.send(view);
  await Promise.race([closed, sleep(5000).then(() => assert.fail("still open"))]);
});

test("broken Foxglove messages end the connection", async () => {
  for (const message of ["{", "[]", '{"op":"subscribe"}', '{"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]}',
    '{"op":"subscribe","subscriptions":[{"id":1,"channelId":999}]}', Buffer.from([2, 1, 0, 0, 0])]) {
    const socket = new WebSocket(`ws://127.0.0.1:${stack.port}/foxglove`, ["foxglove.sdk.v1"]);
    socket.on("error", () => undefined);
    await new Promise((resolve) => socket.on("open", resolve));
    const closed = new Promise((resolve) => socket.on("close", resolve));
    socket.send(message);
    await Promise.race([closed, sleep(3000).then(() => assert.fail(`still open after ${message}`))]);
  }
});

test("a thousand connections, half-open and silent ones among them, leave room for others after they are gone", async () => {
  const sockets = [];
  for (let i = 0; i < 1000; ++i) {
    const socket = connect(stack.port, "127.0.0.1");
    socket.on("error", () => undefined);
    if (i % 3 === 0) socket.on("connect", () => socket.write("GET / HTTP/1.1\r\nHost: loc"));
    sockets.push(socket);
  }
  await sleep(2000);
  for (const socket of sockets) socket.destroy();
  await until(async () => {
    try {
      return (await get("/")).status === 200;
    } catch {
      return false;
    }
  }, "an answer", 20000);
  assert.ok(await refused() > 100);
});

test("who reads nothing is dropped and holds nobody up", async () => {
  const before = await dropped();
  const socket = connect(stack.port, "127.0.0.1");
  socket.on("error", () => undefined);
  socket.pause();
  socket.write("GET /live HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n" +
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: isotherm.live.v1\r\n\r\n");
  await sleep(200);
  // Hello, masked by zeros.
  socket.write(Buffer.from([0x82, 0x84, 0, 0, 0, 0, 0x12, 0x02, 0x08, 0x01]));
  const first = await received();
  await until(async () => await dropped() > before, "the drop", 90000);
  assert.ok(await received() > first, "the scan went on");
  socket.destroy();
});

test("the scan lost nothing", async () => {
  const state = await stack.state();
  assert.equal(Number(state.depth.missing), 0);
});
