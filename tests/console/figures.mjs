// Prints the figures of the console: what it costs, how fast the surface is there, what slow viewers change.
//   run.sh figures.mjs BIN WORK
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import protobuf from "protobufjs";
import WebSocket from "ws";
import { Stack, openBrowser, openPage, readJson, sleep, surface, until } from "./stack.mjs";
import { slowProxy } from "./slow_proxy.mjs";

const percentile = (values, p) => values.length === 0 ? NaN : [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(p / 100 * values.length))];

/** Processor seconds of the threads of a process by name. */
function threadSeconds(pid) {
  const seconds = {};
  for (const task of readdirSync(`/proc/${pid}/task`)) {
    try {
      const text = readFileSync(`/proc/${pid}/task/${task}/stat`, "utf8");
      const name = text.slice(text.indexOf("(") + 1, text.lastIndexOf(")"));
      const fields = text.slice(text.lastIndexOf(")") + 2).split(" ");
      seconds[name] = (seconds[name] ?? 0) + (Number(fields[11]) + Number(fields[12])) / 100;
    } catch {
      // It has ended.
    }
  }
  return seconds;
}
const rss_mb = (pid) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]) / 1024;

/** Version and time of the change in a SurfaceGroup (live.proto), null for other messages. */
function groupIn(data) {
  const reader = protobuf.Reader.create(data);
  const tag = reader.uint32();
  if (tag >>> 3 !== 4) return null;
  const group = { key: "", version: 0, changed_ns: 0, vertices: 0 };
  const end = reader.uint32() + reader.pos;
  while (reader.pos < end) {
    const field = reader.uint32();
    if (field >>> 3 === 1) group.key = Buffer.from(reader.bytes()).toString("hex");
    else if (field >>> 3 === 2) group.version = reader.uint32();
    else if (field >>> 3 === 5) group.vertices = reader.uint32();
    else if (field >>> 3 === 10) group.changed_ns = Number(reader.uint64());
    else reader.skipType(field & 7);
  }
  return group;
}

/** A viewer without a page: reads all, draws nothing. */
function reader(port) {
  const socket = new WebSocket(`ws://127.0.0.1:${port}/live`, ["isotherm.live.v1"]);
  socket.binaryType = "nodebuffer";
  const began = performance.now();
  const counts = { bytes: 0, messages: 0, groups: new Set(), latencies_ms: [], first_ms: NaN, last_ms: NaN, close: () => socket.close(), socket };
  socket.on("message", (data) => {
    counts.bytes += data.length;
    ++counts.messages;
    const group = groupIn(data);
    if (!group) return;
    counts.last_ms = performance.now() - began;
    if (counts.groups.size === 0) counts.first_ms = counts.last_ms;
    counts.groups.add(group.key);
    if (group.version === 1 && group.changed_ns > 0) counts.latencies_ms.push(Date.now() - group.changed_ns / 1e6);
  });
  socket.on("open", () => socket.send(Buffer.from([0x12, 0x02, 0x08, 0x01])));
  socket.on("error", () => undefined);
  return counts;
}
const spread = (values) => ({ p50: Math.round(percentile(values, 50)), p95: Math.round(percentile(values, 95)), groups: values.length });

/** `pages`: how many of the viewers are pages, which draw. */
async function scan(name, viewers, body, { pages = Math.min(viewers, 1) } = {}) {
  const stack = new Stack();
  await stack.startGround();
  const browser = await openBrowser();
  const page = pages > 0 ? await openPage(browser, stack.url, { width: 1280, height: 800 }) : null;
  const readers = Array.from({ length: viewers - pages }, () => reader(stack.port));
  await sleep(500);
  const before = threadSeconds(stack.ground.pid);
  const start = Date.now();
  stack.startEdge();
  const extra = body ? await body(stack, page, browser, readers) : {};
  await stack.edge.ended;
  const after = threadSeconds(stack.ground.pid);
  const seconds = (Date.now() - start) / 1000;
  const folder = await stack.scanFolder();
  await until(() => readJson(join(folder, "stats.json")), "the results", 120000);
  const stats = readJson(join(folder, "stats.json"));
  const latencies = page ? await page.evaluate(() => isotherm.view.surface.latencies_ms) : [];
  const shown = page ? await surface(page) : {};
  const frame = page ? await page.evaluate(() => { const t = isotherm.view.frameTimes; return t.reduce((a, b) => a + b, 0) / t.length; }) : NaN;
  console.log(`${name}: ${JSON.stringify({
    viewers, seconds: Number(seconds.toFixed(1)),
    copying_ms: stats.console && { p50: stats.console.p50_ms, p95: stats.console.p95_ms, p99: stats.console.p99_ms },
    cores: { io: ((after["console-io"] - before["console-io"]) / seconds).toFixed(3), mesh: ((after.console - before.console) / seconds).toFixed(3) },
    depth_frame_ms: stats.stages?.depth_frame, tracked: stats.frames?.depth, thermal: stats.frames?.thermal,
    new_surface_ms: spread(latencies), new_surface_of_readers_ms: readers.slice(0, 3).map(({ latencies_ms }) => spread(latencies_ms)),
    triangles: shown.triangles, groups: shown.groups, draw_calls: shown.calls, frame_ms: Number(frame.toFixed(1)), rss_mb: Math.round(rss_mb(stack.ground.pid)),
    reader_mbytes: readers.map(({ bytes }) => (bytes / 1e6).toFixed(1)), ...extra,
  })}`);
  for (const { close } of readers) close();
  await browser.close();
  await stack.stop();
}

const wanted = process.env.CONSOLE_FIGURES?.split(",") ?? ["none", "reader", "three", "slow", "ten", "reconnect", "finished"];
if (wanted.includes("none")) await scan("nobody looks", 0);
if (wanted.includes("reader")) await scan("one viewer that does not draw", 1, async (stack, page, browser, [early]) => {
  await sleep(10000);
  const late = reader(stack.port);
  await until(() => late.groups.size >= early.groups.size, "the whole model", 20000);
  const figures = { late_first_ms: Math.round(late.first_ms), late_whole_ms: Math.round(late.last_ms), late_groups: late.groups.size };
  late.close();
  return figures;
}, { pages: 0 });
if (wanted.includes("three")) await scan("three viewers", 3);
if (wanted.includes("slow")) await scan("a fast viewer beside one with 200 ms and 2 Mbit/s", 1, async (stack) => {
  const proxy = await slowProxy(stack.port, { bitsPerSecond: 2e6, delay_ms: 100 });
  const slow = reader(proxy.port);
  await stack.edge.ended;
  slow.close();
  return { slow_new_surface_ms: spread(slow.latencies_ms), slow_mbytes: (slow.bytes / 1e6).toFixed(1) };
}, { pages: 0 });
if (wanted.includes("ten")) await scan("ten viewers", 10);
if (wanted.includes("reconnect")) await scan("fifty reconnects", 1, async (stack) => {
  // Before that, the model grows, too.
  await stack.edge.ended;
  await until(async () => (await (await fetch(`${stack.url}/api/scan`)).json()).phase === "ENDED", "the end", 120000);
  const one = async () => { const r = reader(stack.port); await sleep(60); r.close(); await sleep(20); };
  for (let i = 0; i < 5; ++i) await one();
  const before = rss_mb(stack.ground.pid);
  for (let i = 0; i < 50; ++i) await one();
  await sleep(1000);
  return { viewers_after: (await stack.state()).console.viewers, rss_growth_mb: Number((rss_mb(stack.ground.pid) - before).toFixed(1)) };
});
if (wanted.includes("finished")) await scan("a page after the scan, nothing else runs", 0, async (stack, page, browser) => {
  await stack.edge.ended;
  await until(async () => (await (await fetch(`${stack.url}/api/scan`)).json()).phase === "ENDED", "the end", 120000);
  const first_ms = [];
  for (let i = 0; i < 5; ++i) {
    const late = await openPage(browser, stack.url, { width: 1280, height: 800 });
    first_ms.push(await late.evaluate(async () => {
      while (isotherm.view.surface.groups === 0) await new Promise((resolve) => setTimeout(resolve, 5));
      return performance.now();
    }));
    await late.context().close();
  }
  return { first_surface_ms: first_ms.map(Math.round) };
});
