// The real page in Chromium on real daemons that replay a scan of a furnace door.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { createRequire } from "node:module";
import { Stack, openBrowser, openPage, readJson, sleep, surface, tool, until } from "./stack.mjs";

const require = createRequire(import.meta.url);
const axe = readFileSync(join(dirname(require.resolve("axe-core")), "axe.min.js"), "utf8");
const shots = process.env.CONSOLE_SHOTS;
const sizes = { desktop: { width: 1440, height: 900 }, tablet: { width: 1024, height: 768 }, phone: { width: 390, height: 844 } };

const stack = new Stack();
let browser;
let page;

before(async () => {
  await stack.startGround();
  browser = await openBrowser();
  page = await openPage(browser, stack.url, sizes.desktop);
});
after(async () => {
  await browser?.close();
  await stack.stop();
});

const shoot = async (target, name) => { if (shots) await target.screenshot({ path: join(shots, `${name}.png`) }); };

test("before a scan the page says that it waits", async () => {
  await page.getByText("No scan yet").waitFor();
  await until(() => page.evaluate(() => isotherm.state !== undefined), "the state");
});

test("an order shows the rig's answer", async () => {
  // Before there is much to draw: the recording lasts ten seconds, and then the rig goes.
  stack.startEdge();
  await until(async () => (await stack.state()).link?.rig_present, "the rig");
  await page.getByRole("tab", { name: "Control" }).click();
  await page.getByRole("button", { name: "Hold 30 s" }).click();
  await page.locator(".answers li").first().waitFor();
  const answer = () => page.locator(".answers li span").first().textContent();
  await until(async () => /shutter|source has ended/.test(await answer()), "answer of the rig", 15000)
    .catch(async () => assert.fail(`the page shows: ${await page.locator(".answers").textContent()}`));
  console.log(`# the rig says: ${await answer()}`);
  await shoot(page, "desktop-control");
});

test("the surface appears while the scan runs", async () => {
  await until(async () => (await surface(page)).groups > 20, "surface");
  await page.waitForFunction(() => document.querySelector(".sentence").textContent.length > 5);
  await sleep(4000);
  await shoot(page, "desktop-scanning");
  assert.ok((await surface(page)).triangles > 10000);
});

test("who comes late gets the whole model", async () => {
  const late = await openPage(browser, stack.url, sizes.tablet);
  const first_ms = await late.evaluate(async () => {
    const start = performance.timeOrigin;
    while (isotherm.view.surface.groups === 0) await new Promise((resolve) => setTimeout(resolve, 5));
    return performance.now() + performance.timeOrigin - start;
  });
  console.log(`# first surface after ${first_ms.toFixed(0)} ms`);
  await until(async () => (await surface(late)).groups >= 0.9 * (await surface(page)).groups, "the whole model");
  await shoot(late, "tablet-scanning");
  assert.deepEqual(late.faults, []);
  await late.context().close();
});

test("a connection that breaks comes back and resumes", async () => {
  const before = await surface(page);
  for (let i = 0; i < 5; ++i) {
    await page.evaluate(() => isotherm.connection.drop());
    await until(async () => page.locator(".offline").isHidden(), "the connection");
  }
  assert.ok((await surface(page)).groups >= before.groups);
});

test("images of both cameras are shown", async () => {
  await page.getByRole("tab", { name: "Inputs" }).click();
  await until(() => page.evaluate(() => [...document.querySelectorAll(".camera canvas")].every((canvas) => !/none yet/.test(canvas.getAttribute("aria-label")))), "images");
  await shoot(page, "desktop-inputs");
});

test("the scan ends and stays", async () => {
  await stack.edge.ended;
  await until(() => page.evaluate(() => isotherm.scan.phase === 2), "the end", 120000);
  await sleep(3000);
  await shoot(page, "desktop-ended");
});

test("every layer has a legend", async () => {
  await page.getByRole("tab", { name: "View" }).click();
  await page.evaluate(() => isotherm.view.home());
  for (const layer of ["Coverage", "Distance", "Angle", "Motion", "Disagreement", "NUC age", "Uncertainty", "Geometry", "Temperature"]) {
    await page.getByRole("button", { name: layer, exact: true }).click();
    assert.equal(await page.locator(".legend h2").textContent(), layer);
    await sleep(500);
    await shoot(page, `layer-${layer.toLowerCase().replace(" ", "-")}`);
  }
});

test("picks at 200 random places equal isotherm measure, bit for bit", async () => {
  const picks = await page.evaluate(async () => {
    const box = isotherm.view.canvas.getBoundingClientRect();
    const found = [];
    let seed = 1;
    const random = () => (seed = seed * 16807 % 2147483647) / 2147483647;
    while (found.length < 200) {
      const x = box.left + random() * box.width, y = box.top + random() * box.height;
      const picked = await isotherm.measure.pick(x, y);
      await new Promise((resolve) => setTimeout(resolve, 10));
      if (picked) found.push(picked);
    }
    const plain = ({ x, y, z }) => ({ x, y, z });
    return found.map(({ anchor, record }) => ({ anchor: { origin: plain(anchor.origin), direction: plain(anchor.direction) }, apparent: record.apparentCelsius,
      object: record.objectCelsius, sigma: record.sigmaK, distance: record.distanceM, angle: record.angleDeg, age: record.nucAgeS, count: record.observations,
      quality: record.quality }));
  });
  const shapes = { shapes: picks.map(({ anchor }, i) => ({ id: `p${i}`, kind: "SPOT", anchors: [anchor] })) };
  const { writeFileSync } = await import("node:fs");
  const file = join(stack.folder, "picks.json"), values = join(stack.folder, "values.json");
  writeFileSync(file, JSON.stringify(shapes));
  const folder = await stack.scanFolder();
  const { code, text } = await tool(["measure", folder, "--shapes", file, "--json", values]);
  assert.equal(code, 0, text);
  const { measured } = readJson(values);
  picks.forEach((pick, i) => {
    const record = measured[i].record;
    // The anchor begins 3 cm before the place on the same ray, so the place is the same to rounding, and its voxel is the same.
    assert.equal(record.apparent_celsius, pick.apparent, `place ${i}`);
    assert.equal(record.sigma_k, pick.sigma);
    assert.equal(record.distance_m, pick.distance);
    assert.equal(record.nuc_age_s, pick.age);
    assert.equal(record.observations ?? 0, pick.count);
    assert.equal(record.quality, pick.quality);
  });
});

test("an area is measured by touching its corners, and isotherm measure gives the same numbers", async () => {
  await page.getByRole("tab", { name: "Measure" }).click();
  await page.getByRole("button", { name: "Area", exact: true }).click();
  const box = await page.locator("canvas.scene").boundingBox();
  const at = (x, y) => page.mouse.click(box.x + x * box.width, box.y + y * box.height);
  for (const [x, y] of [[0.42, 0.45], [0.55, 0.45], [0.55, 0.6], [0.42, 0.6]]) {
    await at(x, y);
    await sleep(300);
  }
  await page.getByRole("button", { name: "Done" }).click();
  await page.locator(".objects li").first().waitFor();
  await page.getByRole("button", { name: "Spot", exact: true }).click();
  await at(0.48, 0.5);
  await page.locator(".objects li").nth(1).waitFor();
  await page.getByRole("button", { name: "Line", exact: true }).click();
  await at(0.4, 0.4);
  await sleep(300);
  await at(0.6, 0.62);
  await page.locator(".objects li").nth(2).waitFor();
  await sleep(1500);
  await shoot(page, "desktop-measure");
  const shown = await (await fetch(`${stack.url}/api/measurements`)).json();
  const folder = await stack.scanFolder();
  const values = join(stack.folder, "objects.json");
  const { code, text } = await tool(["measure", folder, "--json", values]);
  assert.equal(code, 0, text);
  const measured = readJson(values).measured;
  shown.measured.forEach((entry, i) => {
    for (const key of ["mean_celsius", "max_celsius", "deviation_k"]) assert.equal(entry.object?.[key], measured[i].object?.[key]);
    assert.equal(entry.area_m2, measured[i].area_m2 ?? 0);
    assert.equal(entry.heat_flow?.total_w, measured[i].heat_flow?.total_w);
  });
});

test("objects can be renamed, taken back and removed", async () => {
  await page.getByRole("textbox", { name: "Name" }).fill("Seam");
  await page.getByRole("textbox", { name: "Name" }).press("Tab");
  await until(async () => (await page.locator(".objects").textContent()).includes("Seam"), "the name");
  await page.getByRole("button", { name: "Undo", exact: true }).click();
  await until(async () => !(await page.locator(".objects").textContent()).includes("Seam"), "the old name");
});

test("a report has views, objects and coverage", async () => {
  const folder = await stack.scanFolder();
  const pdf = join(shots ?? stack.folder, "report.pdf");
  const { code, text } = await tool(["report", folder, "-o", pdf, "--place", "Furnace door"]);
  assert.equal(code, 0, text);
  assert.ok(readFileSync(pdf).subarray(0, 5).toString() === "%PDF-");
  assert.ok(readJson(pdf.replace(".pdf", ".json")).coverage_m2.total > 0.1);
});

test("the page can be used by keyboard only", async () => {
  await page.locator("canvas.scene").focus();
  const eye = () => page.evaluate(() => isotherm.view.camera.position.toArray());
  const from = await eye();
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("+");
  assert.notDeepEqual(await eye(), from);
  await page.keyboard.press("2");
  assert.equal(await page.evaluate(() => isotherm.looks.value.layer), "coverage");
  await page.keyboard.press("1");
  await page.keyboard.press("Tab");
  const reached = new Set();
  for (let i = 0; i < 80; ++i) {
    reached.add(await page.evaluate(() => document.activeElement?.textContent?.trim().slice(0, 20) || document.activeElement?.getAttribute("aria-label")));
    await page.keyboard.press("Tab");
  }
  for (const name of ["Follow", "All"]) assert.ok(reached.has(name), `${name} among ${[...reached].join("|")}`);
});

test("a page that is closed leaves", async () => {
  await page.context().close();  // What software draws for a page takes the time of the next.
  await until(async () => (await stack.state()).console.viewers === 0, "no viewer");
});

for (const [name, viewport] of Object.entries(sizes)) {
  test(`on a ${name} it is accessible and its targets are large enough`, async () => {
    const other = await openPage(browser, stack.url, viewport, name === "desktop" ? {} : { hasTouch: true });
    await until(async () => (await surface(other)).groups > 20, "surface");
    for (const tab of ["View", "Measure", "Inputs", "Control"]) {
      await other.evaluate((which) => isotherm.openTab(which), tab);
      await sleep(400);
      await shoot(other, `${name}-${tab.toLowerCase()}`);
      const small = await other.evaluate(() => [...document.querySelectorAll("button, select, input:not([type=checkbox])")]
        .filter((element) => element.offsetParent !== null && !element.classList.contains("label"))
        .map((element) => ({ text: element.textContent || element.getAttribute("aria-label"), box: element.getBoundingClientRect() }))
        .filter(({ box }) => box.height < 43.5 || box.width < 36).map(({ text, box }) => `${text} ${box.width.toFixed(0)}x${box.height.toFixed(0)}`));
      assert.deepEqual(small, [], `${name} ${tab}`);
    }
    const violations = await runAxe(other);
    assert.deepEqual(violations, []);
    assert.deepEqual(other.faults, []);
    await other.context().close();
  });
}

/** Serious findings. The page's policy forbids foreign scripts, so axe runs in a world of its own. */
async function runAxe(target) {
  const client = await target.context().newCDPSession(target);
  const { frameTree } = await client.send("Page.getFrameTree");
  const { executionContextId } = await client.send("Page.createIsolatedWorld", { frameId: frameTree.frame.id });
  await client.send("Runtime.evaluate", { expression: axe, contextId: executionContextId });
  const { result } = await client.send("Runtime.evaluate", { contextId: executionContextId, awaitPromise: true, returnByValue: true,
    expression: "axe.run(document).then((r) => r.violations.filter((v) => v.impact === 'serious' || v.impact === 'critical').map((v) => v.id + ': ' + v.nodes.map((n) => n.html.slice(0, 120)).join(' | ')))" });
  return result.value;
}

test("nothing was asked of other hosts and no policy was violated", () => {
  assert.deepEqual(page.faults, []);
});
