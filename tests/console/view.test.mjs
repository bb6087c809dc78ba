// `isotherm view`: the page for a finished scan, and for a recording that is played back.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { Stack, openBrowser, openPage, readJson, recording, sleep, surface, tool, until } from "./stack.mjs";

const size = { width: 1280, height: 800 };
const shots = process.env.CONSOLE_SHOTS;
const shoot = async (page, name) => { if (shots) await page.screenshot({ path: join(shots, `${name}.png`) }); };
const json = async (stack, path, body) => (await fetch(`${stack.url}${path}`, body ? { method: "POST", body: JSON.stringify(body) } : {})).json();

const finished = new Stack();
const played = new Stack();
const scan = join(finished.folder, "scan");
let browser;

before(async () => { browser = await openBrowser(); });
after(async () => {
  await browser?.close();
  await finished.stop();
  await played.stop();
});

test("a finished scan is shown with all of its surface", async () => {
  const { code, text } = await tool(["reconstruct", recording, "-o", scan]);
  assert.equal(code, 0, text);
  await finished.startView(scan);
  const page = await openPage(browser, finished.url, size);
  await until(async () => (await surface(page)).groups > 100, "the surface");
  await sleep(3000);
  assert.equal((await json(finished, "/api/scan")).phase, "FINISHED");
  // Its mesh has the triangles of the result, but for those that the borders of groups cut.
  const triangles = Number(/element face (\d+)/.exec(readFileSync(join(scan, "mesh.ply")).subarray(0, 4096).toString("latin1"))[1]);
  assert.ok(Math.abs((await surface(page)).triangles / triangles - 1) < 0.05, `${(await surface(page)).triangles} of ${triangles} triangles`);
  await shoot(page, "view-finished");
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("programs ask for places and get what isotherm measure says", async () => {
  const { volume_min: low, volume_max: high } = await json(finished, "/api/scan");
  let hits = 0;
  for (let i = 0; i < 40; ++i) {
    const x = low.x + (0.3 + 0.4 * (i % 8) / 7) * (high.x - low.x);
    const y = low.y + (0.3 + 0.4 * Math.floor(i / 8) / 4) * (high.y - low.y);
    const ray = { origin: { x, y, z: low.z - 0.2 }, direction: { x: 0, y: 0, z: 1 } };
    const record = await json(finished, "/api/query", { ray });
    const values = join(finished.folder, "place.json");
    const { code, text } = await tool(["measure", scan, "--ray", `${x} ${y} ${low.z - 0.2} 0 0 1`, "--json", values]);
    assert.equal(code, 0, text);
    assert.equal(text.includes("nothing there"), !record.hit, `place ${i}: ${text}`);
    if (!record.hit) continue;
    ++hits;
    const measured = readJson(values).measured[0].record;
    for (const key of ["apparent_celsius", "sigma_k", "distance_m", "angle_deg", "nuc_age_s", "quality"])
      assert.equal(record[key], measured[key], `place ${i}: ${key}`);
    assert.deepEqual(record.point, measured.point);
  }
  assert.ok(hits > 10, `${hits} of 40 rays met the surface`);
});

test("questions that are none are refused in words", async () => {
  const ask = (body) => fetch(`${finished.url}/api/query`, { method: "POST", body });
  for (const body of ["", "{", "[]", '{"ray":{}}', '{"ray":{"origin":{"x":"a"},"direction":{}}}', "x".repeat(100000)]) {
    const reply = await ask(body);
    assert.equal(reply.status, 400, body.slice(0, 40));
    assert.match(await reply.text(), /not a question/);
  }
  const nowhere = await (await ask('{"ray":{"origin":{"x":"NaN"},"direction":{"z":1}}}')).json();
  assert.equal(nowhere.hit, false);
  assert.equal((await fetch(`${finished.url}/api/query`)).status, 405);
});

test("a recording is played, paused, sought and played faster", async () => {
  await played.startView(recording);
  const page = await openPage(browser, played.url, size);
  const position = () => page.evaluate(() => Number(document.querySelector(".playback input").value));
  const seek = (seconds) => page.evaluate((to) => {
    const slider = document.querySelector(".playback input");
    slider.value = String(to);
    slider.dispatchEvent(new Event("input"));
    slider.dispatchEvent(new Event("change"));
  }, seconds);
  const play = page.locator(".playback button.primary");
  await page.locator(".playback").waitFor();
  if (await play.textContent() === "Play") await play.click();
  await until(async () => (await surface(page)).groups > 20, "surface");
  await play.click();
  await until(async () => await play.textContent() === "Play", "the pause");
  await sleep(1000);
  const paused = await position();
  await sleep(1500);
  assert.equal(await position(), paused, "it rests");
  await page.getByLabel("Speed").selectOption("8");
  await seek(7);
  await until(async () => (await page.locator(".playback .time").textContent()).startsWith("0:07"), "the later place", 120000);
  const later = await surface(page);
  await shoot(page, "view-played");
  // Back: a model begins anew and has no more than there was then.
  await seek(1);
  await until(async () => (await surface(page)).model !== later.model, "another model");
  await until(async () => Math.abs(await position() - 1) < 0.2, "the earlier place", 120000);
  await until(async () => (await surface(page)).groups > 0, "the surface of then");
  assert.ok((await surface(page)).groups < later.groups, "less was seen by then");
  await play.click();
  await until(async () => await position() > 9, "the end", 180000);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});
