// The list of what is measured, with its numbers, profile and parameters.
import uPlot from "uplot";
import { clone, create } from "@bufbuild/protobuf";
import { ObjectParametersSchema, Shape_Kind, ShapeSchema, type MeasuredShape, type Measurements, type Shape, type Statistics } from "./gen/measuring_pb";
import type { LookStore } from "./look";
import { describe, headline, kindName, tools, vectorOf, type Measure } from "./measure";
import { h, numberField, select, show } from "./ui";
import { difference, fromCelsius, percent, temperature, toCelsius, unitSign, type Unit } from "./units";

export class MeasurePanel {
  readonly element = h("div", { class: "measure" });
  private readonly toolBar = h("div", { class: "tools", role: "group", "aria-label": "Tools" });
  private readonly list = h("ul", { class: "objects" });
  private readonly detail = h("section", { class: "detail", "aria-label": "Chosen object" });
  private readonly none = h("p", { class: "note" }, "Nothing is measured yet. Choose a tool and touch the surface.");
  private readonly undo: HTMLButtonElement;
  private measurements: Measurements | undefined;
  private materials: string[] = [];
  private chosen = "";
  private shownKey = "";

  constructor(private readonly measure: Measure, private readonly looks: LookStore) {
    for (const [tool, name, text] of tools)
      this.toolBar.append(h("button", { type: "button", title: text, "data-tool": tool, onclick: () => measure.setTool(tool) }, name));
    this.undo = h("button", { type: "button", disabled: true, onclick: () => void measure.change({ case: "undo", value: true }) }, "Undo");
    const clear = h("button", { type: "button", onclick: () => void measure.change({ case: "clear", value: true }) }, "Remove all");
    this.element.append(this.toolBar, h("div", { class: "grid" }, this.undo, clear), this.none, this.list, this.detail);
    measure.onTool = (tool) => {
      for (const button of this.toolBar.querySelectorAll("button")) button.setAttribute("aria-pressed", String(button.dataset["tool"] === tool));
    };
    measure.onSelect = (id) => { this.choose(id); this.onOpen(); };
    measure.onMade = (shape) => this.choose(shape.id);
    measure.setTool("read");
    looks.onChange((_, changed) => { if (changed.has("unit")) this.draw(true); });
  }
  onOpen: () => void = () => undefined;

  setMaterials(names: string[]): void {
    this.materials = names;
  }
  set(measurements: Measurements): void {
    this.measurements = measurements;
    this.undo.disabled = measurements.undoable === 0;
    this.draw(false);
  }
  setEditable(editable: boolean): void {
    this.element.toggleAttribute("data-readonly", !editable);
    for (const button of this.toolBar.querySelectorAll("button")) button.disabled = !editable && button.dataset["tool"] !== "read";
  }

  private choose(id: string): void {
    this.chosen = this.chosen === id ? "" : id;
    this.measure.select(this.chosen);
    this.draw(true);
  }
  private find(id: string): [Shape, MeasuredShape | undefined] | null {
    const i = this.measurements?.shapes.findIndex((shape) => shape.id === id) ?? -1;
    return i < 0 ? null : [this.measurements!.shapes[i]!, this.measurements!.measured[i]];
  }

  private draw(force: boolean): void {
    const { unit } = this.looks.value;
    const shapes = this.measurements?.shapes ?? [];
    show(this.none, shapes.length === 0);
    this.list.replaceChildren(...shapes.map((shape, i) => {
      const measured = this.measurements!.measured[i];
      return h("li", {}, h("button", { type: "button", "aria-pressed": String(shape.id === this.chosen), "data-alarm": measured?.alarm ?? "", onclick: () => this.choose(shape.id) },
        h("span", {}, shape.name || kindName(shape.kind), h("small", {}, kindName(shape.kind))), h("b", {}, headline(shape, measured, unit))));
    }));
    this.drawDetail(force);
  }

  private drawDetail(force: boolean): void {
    const found = this.find(this.chosen);
    if (!found) {
      this.detail.replaceChildren();
      this.shownKey = "";
      return;
    }
    const [shape, measured] = found;
    // A field that somebody types into is not taken away.
    const key = JSON.stringify([shape.id, shape.name, shape.kind, shape.text, shape.parameters, shape.alarmAboveCelsius, shape.alarmBelowCelsius], (_, value: unknown) => typeof value === "bigint" ? String(value) : value);
    const values = h("div", { class: "values" }, ...this.values(shape, measured));
    if (!force && key === this.shownKey && this.detail.firstElementChild) {
      this.detail.querySelector(".values")!.replaceWith(values);
    } else {
      this.shownKey = key;
      this.detail.replaceChildren(this.nameField(shape), values, ...this.parameters(shape), this.actions(shape));
    }
    this.drawProfile(shape, measured, values);
  }

  private nameField(shape: Shape): HTMLElement {
    const input = h("input", { type: "text", value: shape.name, maxLength: 60, "aria-label": "Name", onchange: () => void this.change(shape, (s) => { s.name = input.value; }) });
    const text = h("input", { type: "text", value: shape.text, maxLength: 500, placeholder: "Remark", "aria-label": "Remark", onchange: () => void this.change(shape, (s) => { s.text = text.value; }) });
    return h("div", { class: "names" }, input, text);
  }

  private values(shape: Shape, measured: MeasuredShape | undefined): HTMLElement[] {
    const { unit } = this.looks.value;
    if (!measured) return [];
    if (measured.problem !== "") return [h("p", { class: "why" }, measured.problem)];
    const rows: [string, string][] = [];
    const statistics = (name: string, s: Statistics | undefined): void => {
      if (!s) return;
      rows.push([`${name} maximum`, temperature(s.maxCelsius, unit)], [`${name} mean`, temperature(s.meanCelsius, unit)],
        [`${name} minimum`, temperature(s.minCelsius, unit)], [`${name} deviation`, difference(s.deviationK, unit, 2)]);
      if (s.sigmaK !== undefined) rows.push([`${name} uncertainty`, `± ${difference(s.sigmaK, unit, 2)}`]);
    };
    if (shape.kind === Shape_Kind.AREA) rows.push(["area", measured.areaM2 < 0.1 ? `${(1e4 * measured.areaM2).toFixed(1)} cm²` : `${measured.areaM2.toFixed(3)} m²`]);
    if (shape.kind === Shape_Kind.LINE) rows.push(["length, straight", `${(1e3 * measured.lengthM).toFixed(1)} mm`], ["along the surface", `${(1e3 * measured.surfaceLengthM).toFixed(1)} mm`]);
    if (shape.kind === Shape_Kind.DISTANCE) rows.push(["distance", `${(1e3 * measured.lengthM).toFixed(1)} mm`]);
    if (measured.differenceK !== undefined) rows.push(["difference", difference(measured.differenceK, unit, 2)]);
    if (measured.differenceSigmaK !== undefined) rows.push(["uncertainty", `± ${difference(measured.differenceSigmaK, unit, 2)}`]);
    statistics("object", measured.object);
    const { quality, heatFlow: flow } = measured;
    if (quality) rows.push(["measured well", percent(quality.good)], ["acceptable", percent(quality.acceptable)], ["badly", percent(quality.bad)], ["never", percent(quality.never)]);
    if (flow && flow.measuredM2 > 0) {
      rows.push(["heat flow", `${flow.totalW.toFixed(2)} W`], ["by radiation", `${flow.radiationW.toFixed(2)} W`], ["by the air", `${flow.convectionW.toFixed(2)} W`]);
      if (flow.measuredM2 < 0.98 * measured.areaM2) rows.push(["for the whole area", `${flow.extrapolatedW.toFixed(2)} W`]);
    }
    return [...(measured.record ? [h("div", { class: "record" }, ...describe(measured.record, unit))] : []),
      h("dl", { class: "facts" }, ...rows.map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value)))), h("div", { class: "profile" })];
  }

  private parameters(shape: Shape): HTMLElement[] {
    if (shape.kind === Shape_Kind.DISTANCE || shape.kind === Shape_Kind.NOTE) return [];
    const { unit } = this.looks.value;
    const own = shape.parameters;
    const set = (change: (p: NonNullable<Shape["parameters"]>) => void): void => void this.change(shape, (s) => {
      s.parameters ??= create(ObjectParametersSchema);
      change(s.parameters);
    });
    const fields: HTMLElement[] = [];
    if (shape.kind !== Shape_Kind.DIFFERENCE) {
      const material = select("Material", [["", "the same at every angle"], ...this.materials.map((name): [string, string] => [name, name])], own?.material ?? "",
        (value) => set((p) => { if (value === "") delete p.material; else p.material = value; }));
      fields.push(material.element,
        numberField("Emissivity", "", own?.emissivity ?? this.looks.value.emissivity, 0.01, (value) => set((p) => { p.emissivity = value; }), { min: 0.05, max: 1 }).element,
        numberField("Reflected", unitSign(unit), Number(fromCelsius(own?.reflectedCelsius ?? 23, unit).toFixed(1)), 0.5, (value) => set((p) => { p.reflectedCelsius = toCelsius(value, unit); })).element);
    }
    if (shape.kind === Shape_Kind.AREA) {
      fields.push(numberField("Air", unitSign(unit), Number(fromCelsius(own?.airCelsius ?? own?.reflectedCelsius ?? 23, unit).toFixed(1)), 0.5, (value) => set((p) => { p.airCelsius = toCelsius(value, unit); })).element,
        numberField("Film coefficient", "W/m²K", own?.filmCoefficientWM2k ?? 8, 0.5, (value) => set((p) => { p.filmCoefficientWM2k = value; }), { min: 0 }).element);
    }
    return [h("details", {}, h("summary", {}, "Parameters and alarms"), ...fields, this.alarm(shape, unit, "above"), this.alarm(shape, unit, "below"))];
  }

  private alarm(shape: Shape, unit: Unit, which: "above" | "below"): HTMLElement {
    const isDifference = shape.kind === Shape_Kind.DIFFERENCE;
    const current = which === "above" ? shape.alarmAboveCelsius : shape.alarmBelowCelsius;
    const input = h("input", { type: "number", step: "0.5", value: current === undefined ? "" : String(Number((isDifference ? current : fromCelsius(current, unit)).toFixed(2))), placeholder: "none",
      onchange: () => void this.change(shape, (s) => {
        const value = input.value === "" ? undefined : isDifference ? Number(input.value) : toCelsius(Number(input.value), unit);
        const field = which === "above" ? "alarmAboveCelsius" as const : "alarmBelowCelsius" as const;
        s[field] = value !== undefined && Number.isFinite(value) ? value : undefined;
      }) });
    return h("label", { class: "field" }, h("span", {}, `Alarm ${which}`), h("span", { class: "with-unit" }, input, h("span", { class: "unit" }, isDifference ? "K" : unitSign(unit))));
  }

  private actions(shape: Shape): HTMLElement {
    const others = (this.measurements?.shapes ?? []).filter(({ id, kind }) => id !== shape.id && (kind === Shape_Kind.SPOT || kind === Shape_Kind.LINE || kind === Shape_Kind.AREA));
    const canCompare = shape.kind === Shape_Kind.SPOT || shape.kind === Shape_Kind.LINE || shape.kind === Shape_Kind.AREA;
    const compare = canCompare && others.length > 0
      ? select("Compare with", [["", "choose …"], ...others.map(({ id, name }): [string, string] => [id, name])], "", (id) => {
        const other = others.find((entry) => entry.id === id);
        if (other) void this.measure.put(create(ShapeSchema, { id: `${shape.id}-${id}`, name: `${shape.name} − ${other.name}`, kind: Shape_Kind.DIFFERENCE, first: shape.id, second: id }));
      }).element : null;
    return h("div", { class: "actions" }, compare, h("button", { type: "button", class: "order stop", onclick: () => void this.measure.change({ case: "remove", value: shape.id }) }, `Remove ${shape.name}`));
  }

  private async change(shape: Shape, change: (shape: Shape) => void): Promise<void> {
    const changed = clone(ShapeSchema, shape);
    change(changed);
    await this.measure.put(changed);
  }

  private drawProfile(shape: Shape, measured: MeasuredShape | undefined, values: HTMLElement): void {
    const place = values.querySelector<HTMLElement>(".profile");
    if (!place || shape.kind !== Shape_Kind.LINE || !measured || measured.profile.length < 2) {
      return;
    }
    const { unit } = this.looks.value;
    const { profile } = measured;
    const along = profile.map(({ alongM }) => 1000 * alongM);
    const object = profile.map(({ objectCelsius }) => objectCelsius === undefined ? null : fromCelsius(objectCelsius, unit));
    const axis = { stroke: "#a9b8c8", grid: { stroke: "#2b3747" }, ticks: { stroke: "#2b3747" } };
    new uPlot({
      width: Math.max(240, this.detail.clientWidth - 4), height: 190, legend: { show: false }, scales: { x: { time: false } },
      axes: [{ ...axis, label: "mm along the surface", labelSize: 18, size: 34 }, { ...axis, size: 52, label: unitSign(unit), labelSize: 16 }],
      series: [{}, { stroke: "#ffb14c", width: 2, spanGaps: false, points: { show: false } }],
      cursor: { y: false, points: { size: 9 } },
      hooks: { setCursor: [(plot) => {
        const at = plot.cursor.idx;
        this.measure.mark(at === null || at === undefined || plot.cursor.left! < 0 ? null : vectorOf(profile[at]?.point));
      }] },
    }, [along, object as number[]], place);
  }
}
