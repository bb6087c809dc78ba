// The operator stops a scan from the page, takes the results along, and starts the next one.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { Stack, openBrowser, openPage, until } from "./stack.mjs";

const shots = process.env.CONSOLE_SHOTS;
const stack = new Stack();
let browser, page;

before(async () => {
  await stack.startGround();
  browser = await openBrowser();
  page = await openPage(browser, stack.url, { width: 1440, height: 900 });
});
after(async () => {
  await browser?.close();
  await stack.stop();
});

const phase = (wanted) => until(() => page.evaluate((value) => isotherm.scan?.phase === value, wanted), `phase ${wanted}`, 120000);
const order = async (name) => {
  const before = await page.locator(".answers li").count();
  // Not by mouse: with rendering in software a click waits for frames, and the scan goes on.
  await page.getByRole("button", { name }).evaluate((button) => button.click());
  await until(async () => await page.locator(".answers li").count() > before, "an answer");
  const item = page.locator(".answers li").first();
  return { tone: await item.getAttribute("data-tone"), text: await item.locator("span").textContent() };
};

test("a scan under way is not started again", async () => {
  stack.startEdge({ stays: true });
  await phase(1);
  await page.evaluate(() => isotherm.openTab("Control"));
  await page.getByText("Written when the scan ends").waitFor();
  const answer = await order("Start scan");
  assert.equal(answer.tone, "bad");
  assert.match(answer.text, /a scan is under way; stop it first/);
});

test("it is stopped and its results are there", async () => {
  await new Promise((resolve) => setTimeout(resolve, 5000));
  const answer = await order("Stop and save");
  assert.equal(answer.tone, "good", answer.text);
  await phase(2);
  await page.locator(".files a").first().waitFor();
  if (shots) await page.screenshot({ path: join(shots, "desktop-results.png") });
  const names = await page.locator(".files a").allTextContents();
  for (const name of ["mesh.ply", "cloud.ply", "stats.json", "renders/coverage.png"]) assert.ok(names.includes(name), `${name} in ${names}`);
  assert.ok(!names.includes("scan.mcap"));
  const folder = await stack.scanFolder();
  for (const name of ["mesh.ply", "renders/coverage.png"]) {
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator(".files a", { hasText: name }).first().click()]);
    const [got, kept] = [readFileSync(await download.path()), readFileSync(join(folder, name))];
    assert.ok(got.equals(kept), `${name}: ${got.length} of ${kept.length} bytes`);
  }
  const head = await fetch(`${stack.url}/api/files/mesh.ply`, { method: "HEAD" });
  assert.equal(head.headers.get("content-length"), String(readFileSync(join(folder, "mesh.ply")).length));
  assert.equal((await fetch(`${stack.url}/api/files/scan.mcap`)).status, 404);
});

test("the next scan begins in a folder of its own", async () => {
  const first = await stack.scanFolder();
  const answer = await order("Start scan");
  assert.equal(answer.tone, "good", answer.text);
  await phase(1);
  assert.notEqual(await stack.scanFolder(), first);
  await page.getByText("Written when the scan ends").waitFor();
  assert.equal((await order("Stop and save")).tone, "good");
  await phase(2);
  assert.deepEqual(page.faults, []);
});
