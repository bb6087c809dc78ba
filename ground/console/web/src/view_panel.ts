// How the surface is shown: layer, palette, unit, isotherms, interpretation, what is drawn beside it.
import { layers, type Layer, type LookStore } from "./look";
import { h, numberField, segmented, select, show, toggle } from "./ui";
import { fromCelsius, toCelsius, unitNames, unitSign, type Unit } from "./units";

export class ViewPanel {
  readonly element = h("div", { class: "view-panel" });
  private readonly layerButtons = new Map<Layer, HTMLButtonElement>();
  private readonly paletteSelect: HTMLSelectElement;
  private readonly materialSelect: HTMLSelectElement;
  private readonly isotherms: HTMLInputElement;
  private readonly interpretation: HTMLElement;

  constructor(private readonly looks: LookStore) {
    const look = looks.value;
    const grid = h("div", { class: "layer-grid", role: "group", "aria-label": "Layer" });
    layers.forEach(([layer, name, text], i) => {
      const button = h("button", { type: "button", title: `${text} (${i + 1})`, onclick: () => looks.set({ layer }) }, name);
      this.layerButtons.set(layer, button);
      grid.append(button);
    });
    const palette = select("Palette", [[look.palette, look.palette]], look.palette, (value) => looks.set({ palette: value }));
    this.paletteSelect = palette.input;
    const unit = segmented<Unit>("Unit", unitNames, look.unit, (value) => looks.set({ unit: value }));
    this.isotherms = h("input", { type: "text", inputMode: "decimal", placeholder: "for example 60 80 100", "aria-label": "Isotherms",
      onchange: () => this.readIsotherms() });
    const material = select("Material", [["", "none: the same at every angle"]], look.material, (value) => this.setMaterial(value));
    this.materialSelect = material.input;
    const emissivity = numberField("Emissivity", "", look.emissivity, 0.01, (value) => looks.set({ emissivity: value }), { min: 0.05, max: 1 });
    const reflected = numberField("Reflected", unitSign(look.unit), look.reflected_celsius, 1,
      (value) => looks.set({ reflected_celsius: toCelsius(value, looks.value.unit) }));
    this.interpretation = h("div", { class: "sub" }, material.element, emissivity.element, reflected.element);
    const interpret = toggle("Object temperatures", look.interpret, (on) => looks.set({ interpret: on }));
    const drawn = h("div", { class: "toggles" },
      toggle("Shading", look.shading, (on) => looks.set({ shading: on })).element,
      toggle("Cameras", look.showCameras, (on) => looks.set({ showCameras: on })).element,
      toggle("Path", look.showPath, (on) => looks.set({ showPath: on })).element,
      toggle("Next view", look.showNext, (on) => looks.set({ showNext: on })).element,
      toggle("Scan volume", look.showVolume, (on) => looks.set({ showVolume: on })).element);
    this.element.append(h("h3", {}, "Layer"), grid, palette.element, h("div", { class: "field" }, h("span", {}, "Unit"), unit.element),
      h("label", { class: "field" }, h("span", {}, "Isotherms"), this.isotherms),
      interpret.element, this.interpretation, h("h3", {}, "Drawn"), drawn);
    looks.onChange((value, changed) => {
      for (const [layer, button] of this.layerButtons) button.setAttribute("aria-pressed", String(layer === value.layer));
      show(this.interpretation, value.interpret);
      if (changed.has("emissivity")) emissivity.input.value = String(value.emissivity);
      if (changed.has("unit") || changed.has("isotherms")) {
        this.isotherms.value = value.isotherms.map((celsius) => Number(fromCelsius(celsius, value.unit).toFixed(2))).join(" ");
        reflected.input.value = String(Number(fromCelsius(value.reflected_celsius, value.unit).toFixed(1)));
        reflected.element.querySelector(".unit")!.textContent = unitSign(value.unit);
      }
    });
  }

  setTables(palettes: string[], materials: { name: string; emissivity: number }[]): void {
    this.materials = materials;
    const fill = (input: HTMLSelectElement, choices: [string, string][], current: string): void => {
      input.replaceChildren(...choices.map(([value, text]) => h("option", { value, selected: value === current }, text)));
    };
    fill(this.paletteSelect, palettes.map((name) => [name, name]), this.looks.value.palette);
    fill(this.materialSelect, [["", "none: the same at every angle"], ...materials.map(({ name, emissivity }): [string, string] =>
      [name, `${name} (${emissivity.toFixed(2)})`])], this.looks.value.material);
  }
  private materials: { name: string; emissivity: number }[] = [];

  private setMaterial(name: string): void {
    const found = this.materials.find((material) => material.name === name);
    this.looks.set(found ? { material: name, emissivity: Number(found.emissivity.toFixed(3)) } : { material: "" });
  }
  private readIsotherms(): void {
    const numbers = this.isotherms.value.split(/[\s;,]+/).filter((text) => text !== "").map(Number);
    if (numbers.some((value) => !Number.isFinite(value))) {
      this.isotherms.setCustomValidity("numbers, separated by spaces");
      this.isotherms.reportValidity();
      return;
    }
    this.isotherms.setCustomValidity("");
    this.looks.set({ isotherms: numbers.slice(0, 8).map((value) => toCelsius(value, this.looks.value.unit)) });
  }
}
