// Measuring in the view: tools that set points on the surface, and the drawing of what is measured over it.
import * as THREE from "three";
import { create } from "@bufbuild/protobuf";
import { AnchorSchema, ObjectParametersSchema, Shape_Kind, ShapeSchema, type Anchor, type MeasuredShape, type Measurements, type Shape,
  type Vector3, type VoxelRecord } from "./gen/measuring_pb";
import type { Connection } from "./connection";
import type { LookStore } from "./look";
import type { View3d } from "./view3d";
import { h, setText, show } from "./ui";
import { difference, temperature } from "./units";

export type Tool = "read" | "spot" | "line" | "area" | "distance" | "note";

export const tools: readonly (readonly [Tool, string, string, Shape_Kind | null, number, number])[] = [
  ["read", "Read", "Touch the surface to read it", null, 1, 1],
  ["spot", "Spot", "Touch a place on the surface", Shape_Kind.SPOT, 1, 1],
  ["line", "Line", "Touch both ends of a line", Shape_Kind.LINE, 2, 2],
  ["area", "Area", "Touch the corners of an area, then Done", Shape_Kind.AREA, 3, 200],
  ["distance", "Distance", "Touch two places", Shape_Kind.DISTANCE, 2, 2],
  ["note", "Note", "Touch the place of the note", Shape_Kind.NOTE, 1, 1],
];

const svgSpace = "http://www.w3.org/2000/svg";
/** Anchors begin this far in front of the place that was touched, metres. */
const inFront = 0.03;

function svg(tag: string, attributes: Record<string, string>): SVGElement {
  const element = document.createElementNS(svgSpace, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}

export function vectorOf(v: Vector3 | undefined): THREE.Vector3 {
  return new THREE.Vector3(v?.x ?? 0, v?.y ?? 0, v?.z ?? 0);
}

function newId(): string {
  return [...crypto.getRandomValues(new Uint8Array(9))].map((byte) => byte.toString(36).padStart(2, "0")).join("").slice(0, 12);
}

const kindNames: Record<number, string> = { [Shape_Kind.SPOT]: "Spot", [Shape_Kind.LINE]: "Line", [Shape_Kind.AREA]: "Area",
  [Shape_Kind.DIFFERENCE]: "Difference", [Shape_Kind.DISTANCE]: "Distance", [Shape_Kind.NOTE]: "Note" };
export function kindName(kind: Shape_Kind): string {
  return kindNames[kind] ?? "Object";
}

/** The number that stands for a shape, in few words. */
export function headline(shape: Shape, measured: MeasuredShape | undefined, unit: Parameters<typeof temperature>[1]): string {
  if (!measured) return "–";
  if (measured.problem !== "") return "not there";
  switch (shape.kind) {
    case Shape_Kind.SPOT:
      return temperature(measured.record?.objectCelsius, unit);
    case Shape_Kind.LINE:
    case Shape_Kind.AREA:
      return measured.object ? `max ${temperature(measured.object.maxCelsius, unit)}` : "not measured";
    case Shape_Kind.DIFFERENCE:
      return difference(measured.differenceK, unit);
    case Shape_Kind.DISTANCE:
      return `${(1000 * measured.lengthM).toFixed(1)} mm`;
    default:
      return "";
  }
}

interface Pending { anchor: Anchor; point: THREE.Vector3 }

export class Measure {
  readonly overlay = svg("svg", { class: "overlay", "aria-hidden": "true" });
  readonly labels = h("div", { class: "labels", "aria-hidden": "true" });
  readonly hint: HTMLElement;
  readonly readout: HTMLElement;
  private readonly hintText = h("span", {});
  private readonly done: HTMLButtonElement;
  private readonly back: HTMLButtonElement;
  private tool: Tool = "read";
  private pending: Pending[] = [];
  private shapes: Shape[] = [];
  private measured = new Map<string, MeasuredShape>();
  private place: { point: THREE.Vector3; record: VoxelRecord } | null = null;
  private marker: THREE.Vector3 | null = null;
  private asking = false;
  private counter = 0;
  selected = "";
  onTool: (tool: Tool) => void = () => undefined;
  onSelect: (id: string) => void = () => undefined;
  onMade: (shape: Shape) => void = () => undefined;

  constructor(private readonly view: View3d, private readonly connection: Connection, private readonly looks: LookStore,
      private readonly tell: (what: string, text: string) => void) {
    this.done = h("button", { type: "button", class: "primary", onclick: () => void this.finish() }, "Done");
    this.back = h("button", { type: "button", onclick: () => { this.pending.pop(); this.refresh(); } }, "Undo point");
    this.hint = h("div", { class: "hint", role: "status", hidden: true }, this.hintText, this.back,
      h("button", { type: "button", onclick: () => this.setTool("read") }, "Cancel"), this.done);
    this.readout = h("div", { class: "readout", role: "status", "aria-live": "polite", hidden: true });
    view.onFrame = () => this.draw();
    let down: { x: number; y: number; id: number } | null = null;
    view.canvas.addEventListener("pointerdown", (event) => { down = event.isPrimary ? { x: event.clientX, y: event.clientY, id: event.pointerId } : null; });
    view.canvas.addEventListener("pointerup", (event) => {
      if (down?.id === event.pointerId && Math.hypot(event.clientX - down.x, event.clientY - down.y) < 8)
        void this.touch(event.clientX, event.clientY);
      down = null;
    });
    view.canvas.addEventListener("pointermove", (event) => {
      if (event.pointerType === "mouse" && event.buttons === 0) void this.hover(event.clientX, event.clientY);
    });
    view.canvas.addEventListener("pointerleave", () => { if (this.tool === "read" && !this.sticky) this.showPlace(null); });
  }
  private sticky = false;

  setTool(tool: Tool): void {
    this.tool = tool;
    this.pending = [];
    this.view.canvas.dataset["tool"] = tool;
    this.onTool(tool);
    this.refresh();
  }
  get current(): Tool {
    return this.tool;
  }

  set(measurements: Measurements): void {
    this.shapes = measurements.shapes;
    this.measured = new Map(measurements.measured.map((entry) => [entry.id, entry]));
    this.view.invalidate();
  }

  select(id: string): void {
    this.selected = id;
    this.view.invalidate();
  }
  /** A place that something outside points at, such as a profile's cursor. */
  mark(point: THREE.Vector3 | null): void {
    this.marker = point;
    this.view.invalidate();
  }

  /** Asks the service what is where a point of the screen shows. */
  async pick(clientX: number, clientY: number): Promise<{ anchor: Anchor; record: VoxelRecord } | null> {
    const ray = this.view.rayAt(clientX, clientY);
    const look = this.looks.value;
    const parameters = look.interpret ? create(ObjectParametersSchema, { emissivity: look.emissivity,
      reflectedCelsius: look.reflected_celsius, material: look.material }) : create(ObjectParametersSchema);
    const answer = await this.connection.ask({ case: "pick", value: { ray: { origin: { ...ray.origin }, direction: { ...ray.direction } }, parameters } });
    if (answer?.result.case !== "record" || !answer.result.value.hit) return null;
    const record = answer.result.value;
    const origin = vectorOf(record.point).addScaledVector(ray.direction, -inFront);
    return { anchor: create(AnchorSchema, { origin: { x: origin.x, y: origin.y, z: origin.z }, direction: { ...ray.direction } }), record };
  }

  /** For the keyboard: what lies in the middle of the view. */
  touchMiddle(): void {
    const box = this.view.canvas.getBoundingClientRect();
    void this.touch(box.left + box.width / 2, box.top + box.height / 2);
  }

  private async hover(x: number, y: number): Promise<void> {
    if (this.asking || this.sticky || this.tool !== "read" || this.view.surface.groups === 0) return;
    this.asking = true;
    const picked = await this.pick(x, y);
    if (!this.sticky) this.showPlace(picked ? { point: vectorOf(picked.record.point), record: picked.record } : null);
    setTimeout(() => { this.asking = false; }, 90);
  }

  private async touch(x: number, y: number): Promise<void> {
    const picked = await this.pick(x, y);
    if (!picked) {
      this.sticky = false;
      this.showPlace(null);
      if (this.tool !== "read") this.tell("There is no surface", "Touch a place where the surface is drawn");
      return;
    }
    const place = { point: vectorOf(picked.record.point), record: picked.record };
    if (this.tool === "read") {
      this.sticky = true;
      this.showPlace(place);
      return;
    }
    this.pending.push({ anchor: picked.anchor, point: place.point });
    const [, , , , , most] = tools.find(([name]) => name === this.tool)!;
    if (this.pending.length >= most) await this.finish();
    else this.refresh();
  }

  async finish(): Promise<void> {
    const [, name, , kind, least] = tools.find(([tool]) => tool === this.tool)!;
    if (kind === null || this.pending.length < least) return;
    const number = this.shapes.filter((shape) => shape.kind === kind).length + 1;
    const shape = create(ShapeSchema, { id: newId(), name: `${name} ${number}`, kind, anchors: this.pending.map(({ anchor }) => anchor) });
    const look = this.looks.value;
    if (look.interpret) shape.parameters = create(ObjectParametersSchema, { emissivity: look.emissivity, reflectedCelsius: look.reflected_celsius,
      ...(look.material === "" ? {} : { material: look.material }) });
    ++this.counter;
    if (await this.put(shape)) {
      this.setTool("read");
      this.onMade(shape);
    }
  }

  async put(shape: Shape): Promise<boolean> {
    const answer = await this.connection.ask({ case: "edit", value: { change: { case: "put", value: shape } } });
    if (answer?.done !== true) this.tell("Not measured", answer?.text ?? "the connection is gone");
    return answer?.done === true;
  }
  async change(change: { case: "remove"; value: string } | { case: "clear"; value: boolean } | { case: "undo"; value: boolean }): Promise<void> {
    const answer = await this.connection.ask({ case: "edit", value: { change } });
    if (answer?.done !== true) this.tell("Not changed", answer?.text ?? "the connection is gone");
  }

  closeReadout(): void {
    this.sticky = false;
    this.showPlace(null);
  }

  private refresh(): void {
    const [, , text, , least] = tools.find(([name]) => name === this.tool)!;
    show(this.hint, this.tool !== "read");
    setText(this.hintText, this.pending.length > 0 && this.tool === "area" ? `${this.pending.length} corners` : text);
    show(this.back, this.pending.length > 0);
    this.done.disabled = this.pending.length < least;
    if (this.tool !== "read") this.closeReadout();
    this.view.invalidate();
  }

  private showPlace(place: { point: THREE.Vector3; record: VoxelRecord } | null): void {
    this.place = place;
    show(this.readout, place !== null);
    if (place) this.readout.replaceChildren(...describe(place.record, this.looks.value.unit), this.sticky
      ? h("button", { type: "button", class: "close", "aria-label": "Close", onclick: () => this.closeReadout() }, "×") : "");
    this.view.invalidate();
  }

  private draw(): void {
    const box = this.view.canvas.getBoundingClientRect();
    const at = (point: THREE.Vector3): { x: number; y: number } | null => {
      const p = this.view.project(point);
      return p ? { x: p.x - box.left, y: p.y - box.top } : null;
    };
    const lines: SVGElement[] = [];
    const labels: HTMLElement[] = [];
    const cross = (point: THREE.Vector3, style: string): void => {
      const p = at(point);
      if (!p) return;
      lines.push(svg("circle", { cx: String(p.x), cy: String(p.y), r: "9", class: `ring ${style}` }),
        svg("path", { d: `M${p.x - 15} ${p.y}H${p.x - 4}M${p.x + 4} ${p.y}H${p.x + 15}M${p.x} ${p.y - 15}V${p.y - 4}M${p.x} ${p.y + 4}V${p.y + 15}`, class: `cross ${style}` }));
    };
    const stroke = (points: THREE.Vector3[], closed: boolean, style: string): void => {
      const shown = points.map(at);
      if (shown.length < 2 || shown.some((p) => p === null)) return;
      lines.push(svg("path", { d: `M${shown.map((p) => `${p!.x.toFixed(1)} ${p!.y.toFixed(1)}`).join("L")}${closed ? "Z" : ""}`, class: `stroke ${style}` }));
    };
    const label = (point: THREE.Vector3, name: string, value: string, id: string, alarm: string): void => {
      const p = at(point);
      if (!p || p.x < -40 || p.y < -40 || p.x > box.width + 40 || p.y > box.height + 40) return;
      const element = h("button", { type: "button", class: `label${alarm === "" ? "" : ` alarm-${alarm}`}${id === this.selected ? " selected" : ""}`, tabIndex: -1,
        onclick: () => this.onSelect(id) }, h("small", {}, name), value === "" ? null : h("b", {}, value));
      element.style.transform = `translate(${p.x + 16}px, ${p.y - 14}px)`;
      labels.push(element);
    };
    const { unit } = this.looks.value;
    for (const shape of this.shapes) {
      const measured = this.measured.get(shape.id);
      const corners = (measured?.corners.length ?? 0) > 0 ? measured!.corners.map(vectorOf) : shape.anchors.map(({ origin }) => vectorOf(origin));
      if (corners.length === 0) continue;
      const style = `${shape.id === this.selected ? "selected" : ""} ${measured?.alarm ? `alarm-${measured.alarm}` : ""}`;
      if (shape.kind === Shape_Kind.AREA) stroke(corners, true, style);
      else if (shape.kind === Shape_Kind.LINE && measured && measured.profile.length > 1) stroke(measured.profile.map(({ point }) => vectorOf(point)), false, style);
      else if (corners.length > 1) stroke(corners, false, style);
      if (corners.length === 1) cross(corners[0]!, style);
      const hottest = measured?.object?.hottest;
      if (hottest && (shape.kind === Shape_Kind.AREA || shape.kind === Shape_Kind.LINE)) {
        const p = at(vectorOf(hottest));
        if (p) lines.push(svg("path", { d: `M${p.x - 7} ${p.y + 5}h14l-7-13z`, class: "hot" }));
      }
      label(corners[0]!, shape.name, headline(shape, measured, unit), shape.id, measured?.alarm ?? "");
    }
    if (this.pending.length > 0) {
      stroke(this.pending.map(({ point }) => point), this.tool === "area" && this.pending.length > 2, "pending");
      for (const { point } of this.pending) cross(point, "pending");
    }
    if (this.place) cross(this.place.point, "cursor");
    if (this.marker) cross(this.marker, "cursor");
    this.overlay.replaceChildren(...lines);
    this.labels.replaceChildren(...labels);
  }
}

const conditionNames = ["not checked", "bad", "acceptable", "good"];

/** A voxel's record for people. */
export function describe(record: VoxelRecord, unit: Parameters<typeof temperature>[1]): HTMLElement[] {
  const rows: [string, string][] = [];
  const { objectCelsius, apparentCelsius } = record;
  if (objectCelsius !== undefined && apparentCelsius !== undefined && Math.abs(objectCelsius - apparentCelsius) > 0.004)
    rows.push(["apparent", temperature(apparentCelsius, unit, 2)]);
  const sigma = record.objectSigmaK ?? record.sigmaK;
  if (sigma !== undefined) rows.push(["uncertainty", `± ${difference(sigma, unit, 2)}`]);
  if (record.distanceM !== undefined) rows.push(["distance", `${(100 * record.distanceM).toFixed(0)} cm, ${conditionNames[record.distanceClass]}`]);
  if (record.angleDeg !== undefined) rows.push(["angle", `${record.angleDeg.toFixed(0)}°, ${conditionNames[record.angleClass]}`]);
  if (record.nucAgeS !== undefined) rows.push(["after NUC", `${record.nucAgeS.toFixed(0)} s`]);
  if (record.observations > 0) rows.push(["good views", String(record.observations)]);
  if (record.disagreementK !== undefined) rows.push(["spread", difference(record.disagreementK, unit, 2)]);
  return [
    h("p", { class: `value quality-${record.quality}` }, temperature(objectCelsius ?? apparentCelsius, unit), h("span", { class: "quality" }, record.quality === "never" ? "not measured" : record.quality)),
    h("dl", {}, ...rows.map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value)))),
    ...record.reasons.map((reason) => h("p", { class: "why" }, reason)),
  ];
}
