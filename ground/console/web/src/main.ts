// Puts the page together.
import { Connection } from "./connection";
import { ControlPanel } from "./control";
import { Role, Scan_Phase, Tracking, type Scan, type State, type Welcome } from "./gen/live_pb";
import { GuidancePanel } from "./guidance";
import { InputsPanel } from "./inputs";
import { Legend } from "./legend";
import { comeIn } from "./login";
import { layers, LookStore } from "./look";
import { Measure } from "./measure";
import { MeasurePanel } from "./measure_panel";
import { PlaybackBar } from "./playback";
import { Radiance } from "./radiance";
import { add, h, setText, show } from "./ui";
import { bytes } from "./units";
import { View3d } from "./view3d";
import { ViewPanel } from "./view_panel";

const looks = new LookStore();
const connection = new Connection();
const canvas = h("canvas", { class: "scene", tabIndex: 0, role: "application",
  "aria-label": "The scanned surface in three dimensions. Arrow keys turn the view, plus and minus zoom, H shows all, F follows the rig." });
const stage = h("main", { class: "stage" }, canvas);
const guidance = new GuidancePanel();
const legend = new Legend(looks);
const inputs = new InputsPanel(looks);
const control = new ControlPanel(connection);
const viewPanel = new ViewPanel(looks);
const empty = h("div", { class: "empty" }, h("p", { class: "big" }, "No scan yet"),
  h("p", {}, "The surface appears here as soon as the rig sends frames."));
let scan: Scan | undefined;
let state: State | undefined;
let welcome: Welcome | undefined;
let tracking = Tracking.TRACKING_WAITING;
let connected = false;

// The tabs of the side panel.
const tabs: { name: string; content: HTMLElement; button: HTMLButtonElement }[] = [];
const panels = h("div", { class: "panels" });
const tabList = h("div", { class: "tabs", role: "tablist", "aria-label": "Panels" });
const side = h("aside", { class: "side", "aria-label": "Controls" }, tabList, panels);
function addTab(name: string, content: HTMLElement): void {
  const id = name.toLowerCase();
  const button = h("button", { type: "button", role: "tab", id: `tab-${id}`, "aria-controls": `panel-${id}`, onclick: () => openTab(name) }, name);
  const panel = h("div", { class: "panel", role: "tabpanel", id: `panel-${id}`, "aria-labelledby": `tab-${id}`, tabIndex: 0 }, content);
  tabs.push({ name, content: panel, button });
  tabList.append(button);
  panels.append(panel);
}
function openTab(name: string): void {
  const again = tabs.find((tab) => tab.name === name)?.button.getAttribute("aria-selected") === "true";
  // On a phone, a second touch closes the sheet.
  if (again && matchMedia("(max-width: 760px)").matches) side.classList.toggle("closed");
  else side.classList.remove("closed");
  for (const tab of tabs) {
    const on = tab.name === name;
    tab.button.setAttribute("aria-selected", String(on));
    tab.button.tabIndex = on ? 0 : -1;
    show(tab.content, on);
  }
}
tabList.addEventListener("keydown", (event) => {
  const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
  if (step === 0) return;
  const at = tabs.findIndex(({ button }) => button === document.activeElement);
  const next = tabs[(at + step + tabs.length) % tabs.length]!;
  openTab(next.name);
  next.button.focus();
  event.stopPropagation();
});

// The bar at the top.
const chip = (name: string): { element: HTMLElement; set: (text: string, tone: string) => void } => {
  const value = h("span", {}, "–");
  const element = h("span", { class: "chip status", title: name }, h("i", { class: "dot", "aria-hidden": "true" }), h("small", {}, name), value);
  return { element, set: (text, tone) => { setText(value, text); element.dataset["tone"] = tone; } };
};
const chips = { link: chip("Rig"), tracking: chip("Tracking"), nuc: chip("NUC"), rate: chip("Frames"), disk: chip("Disk") };
/** What is shown from files has no rig: only how well it was tracked is of interest. */
function showRig(isThere: boolean): void {
  for (const { element } of [chips.link, chips.nuc, chips.rate, chips.disk]) show(element, isThere);
}
const scanName = h("span", { class: "scan-name" }, "Isotherm");
const offline = h("div", { class: "offline", role: "alert", hidden: true }, "No connection to the ground service. Trying again …");
const header = h("header", { class: "top" }, h("img", { src: "icon.svg", alt: "", width: 32, height: 32 }), scanName,
  h("div", { class: "chips" }, ...Object.values(chips).map(({ element }) => element)), guidance.sound);

const toastBox = h("div", { class: "toast", role: "alert", hidden: true });
let toastTimer = 0;
function toast(text: string): void {
  setText(toastBox, text);
  show(toastBox, true);
  clearTimeout(toastTimer);
  toastTimer = window.setTimeout(() => show(toastBox, false), 5000);
}

// Beside the view.
const followButton = h("button", { type: "button", title: "Follow the rig (F)", onclick: () => looks.set({ follow: !looks.value.follow }) }, "Follow");
const nav = h("div", { class: "nav", role: "group", "aria-label": "View" }, followButton,
  h("button", { type: "button", title: "Show all (H)", onclick: () => view.home() }, "All"),
  h("button", { type: "button", "aria-label": "Nearer", title: "Nearer (+)", onclick: () => view.nudge(0, 0, 0.8) }, "+"),
  h("button", { type: "button", "aria-label": "Farther", title: "Farther (−)", onclick: () => view.nudge(0, 0, 1.25) }, "−"));
add(stage, empty, guidance.element, legend.element, nav, offline);
add(document.getElementById("app")!, header, stage, side);
const view = new View3d(canvas, looks);
const measure = new Measure(view, connection, looks, (what, text) => toast(`${what}: ${text}`));
const measurePanel = new MeasurePanel(measure, looks);
measurePanel.onOpen = () => openTab("Measure");
const playback = new PlaybackBar(connection);
stage.append(measure.overlay, measure.labels, measure.readout, measure.hint, toastBox, playback.element);
addTab("View", viewPanel.element);
addTab("Measure", measurePanel.element);
addTab("Inputs", inputs.element);
addTab("Control", control.element);
openTab("View");
if (matchMedia("(max-width: 760px)").matches) side.classList.add("closed");

/** The span that is kept, widened in steps to what the model has by now. */
function widened(model: [number, number]): [number, number] {
  const { min_celsius, max_celsius } = looks.value;
  // Colours that change their meaning all the time cannot be read.
  const step = 5;
  const [min, max] = [Math.floor(model[0] / step) * step, Math.ceil(model[1] / step) * step];
  return Number.isFinite(min_celsius) && Number.isFinite(max_celsius) ? [Math.min(min_celsius, min), Math.max(max_celsius, max)] : [min, max];
}
let shownSpan: [number, number] | undefined;
function applySpan(): void {
  const { locked, widens, min_celsius, max_celsius } = looks.value;
  let span: [number, number] | null = [min_celsius, max_celsius];
  const isSet = Number.isFinite(min_celsius) && Number.isFinite(max_celsius);
  if (!locked || widens || !isSet) {
    const model = view.surface.span();
    span = model ?? (isSet ? span : null);
    if (model && locked && view.surface.groups >= 8) {
      span = widened(model);
      looks.set({ min_celsius: span[0], max_celsius: span[1] });
    }
    if (span && span[1] - span[0] < 0.5) span = [span[0] - 0.25, span[1] + 0.25];
  }
  if (!span || (span[0] === shownSpan?.[0] && span[1] === shownSpan[1])) return;
  shownSpan = span;
  view.surfaceMaterial.setSpan(span[0], span[1]);
  legend.setSpan(span[0], span[1]);
  view.invalidate();
}
looks.onChange((look, changed) => {
  followButton.setAttribute("aria-pressed", String(look.follow));
  if (changed.has("palette")) inputs.setColours(coloursOf(look.palette));
  if (["locked", "widens", "min_celsius", "max_celsius"].some((key) => changed.has(key as keyof typeof look))) applySpan();
  if (changed.has("layer") || changed.has("follow")) tellView();
});

function coloursOf(palette: string): Uint8Array | undefined {
  return welcome?.palettes.find(({ name }) => name === palette)?.colours;
}
function tellView(): void {
  connection.post({ case: "view", value: { eye: view.eyeInWorld(), details: looks.value.layer === "uncertainty",
    images: true, maxBytesPerS: 0 } });
}

connection.held = () => view.surface.held();
connection.onState = (isOpen) => {
  connected = isOpen;
  show(offline, !isOpen);
  if (isOpen) tellView();
};
connection.on("welcome", (value) => {
  welcome = value;
  const radiance = new Radiance(value.radiance!);
  view.surfaceMaterial.setTables(value.palettes, radiance, value.materials);
  view.surfaceMaterial.apply(looks.value);
  legend.setPalettes(value.palettes);
  viewPanel.setTables(value.palettes.map(({ name }) => name), value.materials);
  inputs.setColours(coloursOf(looks.value.palette));
  control.setRole(value.role);
  measurePanel.setEditable(value.role === Role.OPERATOR);
  measurePanel.setMaterials(value.materials.map(({ name }) => name));
  document.documentElement.dataset["role"] = value.role === Role.OPERATOR ? "operator" : "viewer";
});
const phases: Record<number, string> = { [Scan_Phase.RUNNING]: "running", [Scan_Phase.ENDED]: "ended", [Scan_Phase.FINISHED]: "from files" };
connection.on("scan", (value) => {
  const isNew = value.model !== scan?.model;
  scan = value;
  view.setScan(value);
  legend.setLimits(value.limits);
  setText(scanName, value.name === "" ? "Isotherm" : value.name);
  scanName.title = [value.folder, phases[value.phase] ?? ""].filter((text) => text !== "").join(" · ");
  document.title = value.name === "" ? "Isotherm" : `${value.name} · Isotherm`;
  show(empty, value.phase === Scan_Phase.WAITING);
  show(guidance.element, value.phase !== Scan_Phase.FINISHED);
  show(chips.tracking.element, value.phase !== Scan_Phase.FINISHED);
  if (value.phase === Scan_Phase.FINISHED) showRig(false);
  if (isNew) {
    if (value.phase === Scan_Phase.FINISHED) looks.set({ follow: false });
    tracking = Tracking.TRACKING_WAITING;
    // A span belongs to the scan for which it was chosen.
    if (value.phase === Scan_Phase.RUNNING) looks.set({ widens: true, min_celsius: NaN, max_celsius: NaN });
    guidance.clear(value.phase === Scan_Phase.WAITING ? "Waiting for a scan" : "The scan begins");
  }
  if (value.phase === Scan_Phase.ENDED) guidance.end("The scan has ended", "Its results are written; the surface stays here until the next scan begins");
  control.setScan(value);
});
connection.on("maps", (maps) => view.surface.setMaps(maps));
connection.on("group", (group) => view.surface.add(group));
connection.on("details", (details) => view.surface.addDetails(details));
connection.on("pose", (pose) => {
  view.setPose(pose);
  tracking = pose.tracking;
  const names: Record<number, [string, string]> = { [Tracking.TRACKED]: ["good", "good"], [Tracking.DEGRADED]: ["degraded", "warn"],
    [Tracking.LOST]: ["lost", "bad"] };
  const [text, tone] = names[tracking] ?? ["waiting", ""];
  chips.tracking.set(text, tone);
});
connection.on("measurements", (value) => {
  measure.set(value);
  measurePanel.set(value);
});
connection.on("playback", (value) => {
  playback.set(value);
  showRig(false);
});
connection.on("path", (path) => view.setPath(path));
connection.on("guidance", (value) => {
  if (scan?.phase === Scan_Phase.ENDED) return;
  guidance.set(value, state);
  view.setNext(value.done ? undefined : value.TWorldDepthNext);
});
connection.on("image", (image) => inputs.setImage(image));
connection.on("state", (value) => {
  state = value;
  inputs.setState(value, looks.value.unit);
  control.setState(value);
  guidance.update(value);
  const { link, nuc, disk } = value;
  chips.link.set(link?.problem ? "trouble" : link?.rigPresent ? value.scanState || "there" : "none", link?.problem ? "bad" : link?.rigPresent ? "good" : "bad");
  chips.nuc.set(nuc?.state ?? "–", nuc?.state === "idle" ? "good" : nuc?.state ? "warn" : "");
  chips.rate.set(`${(value.depth?.rateHz ?? 0).toFixed(0)} / ${(value.thermal?.rateHz ?? 0).toFixed(0)}`, value.load?.behind ? "warn" : "");
  chips.disk.set(disk?.text ? disk.text.replace(/^disk: /, "") : bytes(disk?.freeBytes), disk?.paused ? "bad" : "");
});

setInterval(() => {
  if (connected) tellView();
  applySpan();
  const times = view.frameTimes;
  const mean = times.reduce((sum, value) => sum + value, 0) / Math.max(1, times.length);
  inputs.setPage(`${view.surface.triangles.toLocaleString()} triangles, ${view.drawCalls} draw calls, ${mean.toFixed(1)} ms a frame, ${bytes(connection.takeReceivedBytes())}/s`);
}, 1000);

addEventListener("keydown", (event) => {
  const target = event.target as HTMLElement;
  if (/^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName) || event.ctrlKey || event.metaKey || event.altKey) return;
  const turn = 0.12;
  const keys: Record<string, () => void> = {
    ArrowLeft: () => view.nudge(turn, 0, 1), ArrowRight: () => view.nudge(-turn, 0, 1),
    ArrowUp: () => view.nudge(0, turn, 1), ArrowDown: () => view.nudge(0, -turn, 1),
    "+": () => view.nudge(0, 0, 0.85), "=": () => view.nudge(0, 0, 0.85), "-": () => view.nudge(0, 0, 1.18),
    f: () => looks.set({ follow: !looks.value.follow }), h: () => view.home(), s: () => guidance.toggleSound(),
    " ": () => playback.toggle(), Enter: () => measure.touchMiddle(), Escape: () => { measure.setTool("read"); measure.closeReadout(); },
  };
  if ((event.key === "Enter" || event.key === " ") && target !== canvas && target !== document.body) return;
  const digit = Number(event.key);
  if (digit >= 1 && digit <= layers.length) looks.set({ layer: layers[digit - 1]![0] });
  else if (keys[event.key]) keys[event.key]!();
  else return;
  event.preventDefault();
});

// A screen that turns dark is of no use during a scan.
async function keepAwake(): Promise<void> {
  try {
    await navigator.wakeLock.request("screen");
  } catch {
    // Not everywhere allowed.
  }
}
document.addEventListener("visibilitychange", () => { if (document.visibilityState === "visible") void keepAwake(); });
void keepAwake();
void comeIn(stage).then(() => connection.open());

// For tests.
Object.assign(window, { isotherm: { view, looks, connection, measure, get scan() { return scan; }, get state() { return state; }, openTab } });
