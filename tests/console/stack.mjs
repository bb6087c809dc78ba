// Real daemons over DDS on loopback, and a browser that looks at them.
import { spawn } from "node:child_process";
import { mkdtempSync, mkdirSync, rmSync, readFileSync, existsSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

export const programs = process.env.CONSOLE_BIN;
export const recording = process.env.CONSOLE_RECORDING;
export const work = process.env.CONSOLE_WORK;

export const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Waits until `probe` gives something true, and returns it. */
export async function until(probe, what, patience_ms = 60000) {
  const end = Date.now() + patience_ms;
  for (;;) {
    const value = await probe();
    if (value) return value;
    if (Date.now() > end) throw new Error(`there was no ${what}`);
    await sleep(50);
  }
}

export function freePort() {
  return new Promise((resolve) => {
    const server = createServer();
    server.listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}

function start(name, args, log) {
  const child = spawn(join(programs, name), args, { stdio: ["ignore", "pipe", "pipe"] });
  child.text = "";
  for (const stream of [child.stdout, child.stderr]) stream.on("data", (data) => { child.text += data; });
  child.ended = new Promise((resolve) => child.on("exit", (code) => resolve(code)));
  if (log) child.ended.then((code) => { if (process.env.CONSOLE_VERBOSE) console.error(name, "ended", code, child.text.slice(-2000)); });
  return child;
}

/** A ground service with its console and, when asked, an edge that plays the recording. */
export class Stack {
  constructor() {
    this.folder = mkdtempSync(join(work ?? tmpdir(), "console-"));
    this.domain = 102 + Math.floor(Math.random() * 100); // The other tests take those below.
    this.edgeId = `console-${process.pid}`;
    this.children = [];
  }
  async startGround(options = []) {
    this.port = await freePort();
    this.output = join(this.folder, "scans");
    mkdirSync(this.output, { recursive: true });
    this.ground = start("isotherm-ground", ["--output", this.output, "--edge-id", this.edgeId, "--domain", String(this.domain),
      "--set", `console.port=${this.port}`, ...options.flatMap((option) => ["--set", option])], true);
    this.children.push(this.ground);
    this.url = `http://127.0.0.1:${this.port}`;
    await until(async () => {
      try {
        return (await fetch(`${this.url}/api/scan`)).ok;
      } catch {
        return false;
      }
    }, `the console: ${this.ground.text}`);
  }
  startEdge({ stays = false } = {}) {
    this.edge = start("isotherm-edge", ["--recording", recording, "--edge-id", this.edgeId, "--domain", String(this.domain), "--rate", "1",
      "--record", "off", ...(stays ? ["--set", "source.loops=0"] : ["--exit-at-end"])], true);
    this.children.push(this.edge);
    return this.edge;
  }
  async scanFolder() {
    return (await (await fetch(`${this.url}/api/scan`)).json()).folder;
  }
  async state() {
    return (await fetch(`${this.url}/api/state`)).json();
  }
  /** Starts `isotherm view` instead. */
  async startView(scan, options = []) {
    this.port = await freePort();
    this.url = `http://127.0.0.1:${this.port}`;
    this.ground = start("isotherm", ["view", scan, "--port", String(this.port), "--no-browser", ...options], true);
    this.children.push(this.ground);
    await until(async () => {
      try {
        return (await fetch(`${this.url}/api/scan`)).ok;
      } catch {
        return false;
      }
    }, "the view");
  }
  async stop() {
    for (const child of this.children) child.kill("SIGTERM");
    const codes = await Promise.all(this.children.map((child) => child.ended));
    rmSync(this.folder, { recursive: true, force: true });
    return codes;
  }
}

export function tool(args) {
  return new Promise((resolve) => {
    const child = start("isotherm", args);
    child.ended.then((code) => resolve({ code, text: child.text }));
  });
}

export async function openBrowser() {
  return chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync", "--use-gl=angle", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader"] });
}

/** A page that notes what must not happen: errors, refused content, requests to elsewhere. */
export async function openPage(browser, url, viewport, options = {}) {
  const context = await browser.newContext({ viewport, deviceScaleFactor: 1, ignoreHTTPSErrors: true, ...options });
  const page = await context.newPage();
  page.faults = [];
  page.on("pageerror", (error) => page.faults.push(`error: ${error}`));
  page.on("console", (message) => { if (message.type() === "error") page.faults.push(`console: ${message.text()}`); });
  page.on("request", (request) => { if (!request.url().startsWith(url) && !/^(data|blob):/.test(request.url())) page.faults.push(`foreign: ${request.url()}`); });
  await page.addInitScript(() => document.addEventListener("securitypolicyviolation", (event) => console.error("CSP", event.violatedDirective, event.blockedURI)));
  await page.goto(url);
  return page;
}

export const surface = (page) => page.evaluate(() => ({ groups: isotherm.view.surface.groups, triangles: isotherm.view.surface.triangles,
  model: String(isotherm.view.surface.model), calls: isotherm.view.drawCalls }));

export function readJson(path) {
  return existsSync(path) ? JSON.parse(readFileSync(path, "utf8")) : undefined;
}
