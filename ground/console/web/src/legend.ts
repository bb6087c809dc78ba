// What the colours mean, beside the view: the palette with its span, or the classes.
import { classColours, layers, type Look, type LookStore } from "./look";
import { h, setText, show } from "./ui";
import { fromCelsius, fromKelvin, toCelsius, unitSign } from "./units";
import type { Limits } from "./gen/live_pb";

type Row = readonly [string, string, string];

function classRows(look: Look, limits: Limits | undefined): Row[] {
  const { good, acceptable, bad, unchecked, never } = classColours;
  const m = (value: number | undefined): string => value === undefined ? "?" : `${(value * 100).toFixed(0)} cm`;
  const deg = (value: number | undefined): string => value === undefined ? "?" : `${value.toFixed(0)}°`;
  switch (look.layer) {
    case "distance":
      return [[good, "good", `${m(limits?.distanceMinM)} to ${m(limits?.distanceGoodM)}`],
        [acceptable, "acceptable", `up to ${m(limits?.distanceMaxM)}`], [bad, "bad", "nearer or farther"], [never, "not measured", ""]];
    case "angle":
      return [[good, "good", `${deg(limits?.angleMinDeg)} to ${deg(limits?.angleGoodDeg)}`],
        [acceptable, "acceptable", `up to ${deg(limits?.angleMaxDeg)}`], [bad, "bad", "too oblique, or a mirror image"], [never, "not measured", ""]];
    case "motion":
      return [[good, "sharp", ""], [acceptable, "a little smeared", ""], [bad, "smeared", ""], [unchecked, "not checked", ""], [never, "not measured", ""]];
    case "disagreement":
      return [[good, "measurements agree", ""], [acceptable, "differ a little", ""], [bad, "contradict each other", "a reflection, or it changed"],
        [unchecked, "too few to compare", ""], [never, "not measured", ""]];
    case "coverage":
      return [["#bac1c4", "measured well", ""], ["#788c96", "acceptable", ""], [classColours.onlyBad, "only badly", "measure again"],
        [classColours.missing, "not measured", "seen by depth only"]];
    default:
      return [];
  }
}

export class Legend {
  readonly element = h("section", { class: "legend", "aria-label": "Legend" });
  private readonly title = h("h2", {});
  private readonly bar = h("canvas", { width: 1, height: 256, "aria-hidden": "true" });
  private readonly max: HTMLInputElement;
  private readonly min: HTMLInputElement;
  private readonly middle = h("span", { class: "middle" });
  private readonly lock: HTMLButtonElement;
  private readonly rows = h("ul", { class: "rows" });
  private readonly scale: HTMLElement;
  private palettes = new Map<string, Uint8Array>();
  private limits: Limits | undefined;
  private look: Look;
  private shown: [number, number] = [0, 1];
  private hasSpan = false;
  private extremes: Record<"age" | "uncertainty", number> = { age: 60, uncertainty: 2 };

  constructor(looks: LookStore) {
    this.look = looks.value;
    const edit = (which: "min_celsius" | "max_celsius") => (event: Event): void => {
      const value = Number((event.target as HTMLInputElement).value);
      if (!Number.isFinite(value)) return this.draw();
      const celsius = toCelsius(value, this.look.unit);
      const [min, max] = which === "min_celsius" ? [celsius, this.shown[1]] : [this.shown[0], celsius];
      if (max - min >= 0.1) looks.set({ min_celsius: min, max_celsius: max, locked: true, widens: false });
      this.draw();
    };
    this.max = h("input", { type: "number", step: "0.5", "aria-label": "Highest temperature of the palette", onchange: edit("max_celsius") });
    this.min = h("input", { type: "number", step: "0.5", "aria-label": "Lowest temperature of the palette", onchange: edit("min_celsius") });
    this.lock = h("button", { type: "button", class: "lock", onclick: () => {
      if (looks.value.locked) looks.set({ locked: false });
      else looks.set({ locked: true, widens: false, min_celsius: this.shown[0], max_celsius: this.shown[1] });
    } });
    this.scale = h("div", { class: "scale" }, this.max, this.bar, this.middle, this.min, this.lock);
    this.element.append(this.title, this.scale, this.rows);
    looks.onChange((look) => { this.look = look; this.draw(); });
  }
  setPalettes(palettes: { name: string; colours: Uint8Array }[]): void {
    this.palettes = new Map(palettes.map(({ name, colours }) => [name, colours]));
    this.draw();
  }
  setLimits(limits: Limits | undefined): void {
    this.limits = limits;
    this.draw();
  }
  setSpan(min: number, max: number): void {
    if (this.hasSpan && this.shown[0] === min && this.shown[1] === max) return;
    this.hasSpan = true;
    this.shown = [min, max];
    this.draw();
  }
  setExtremes(age_s: number, sigma_k: number): void {
    this.extremes = { age: age_s, uncertainty: sigma_k };
    this.draw();
  }

  private draw(): void {
    const { layer, unit, locked, widens } = this.look;
    setText(this.title, layers.find(([name]) => name === layer)![1]);
    const hasBar = layer === "thermal" || layer === "age" || layer === "uncertainty";
    show(this.scale, hasBar);
    const isThermal = layer === "thermal";
    this.max.disabled = this.min.disabled = !isThermal;
    show(this.lock, isThermal);
    setText(this.lock, !locked ? "Auto" : widens ? "Widens" : "Fixed");
    this.lock.setAttribute("aria-pressed", String(locked));
    this.lock.title = !locked ? "The span follows the model. Press to fix it."
      : `The span ${widens ? "only widens, in steps of 5 °C; type a limit to fix it" : "is fixed"}. Press to let it follow the model.`;
    if (hasBar) this.drawBar();
    const write = (input: HTMLInputElement, value: string): void => {
      if (document.activeElement !== input) input.value = value;
    };
    if (isThermal) {
      const [min, max] = this.shown.map((celsius) => fromCelsius(celsius, unit)) as [number, number];
      // Before the first temperature there is no span to be told.
      write(this.max, this.hasSpan ? max.toFixed(1) : "");
      write(this.min, this.hasSpan ? min.toFixed(1) : "");
      setText(this.middle, this.hasSpan ? `${((min + max) / 2).toFixed(1)} ${unitSign(unit)}` : unitSign(unit));
    } else if (layer === "age") {
      write(this.max, this.extremes.age.toFixed(0));
      write(this.min, "0");
      setText(this.middle, `${(this.extremes.age / 2).toFixed(0)} s`);
    } else if (layer === "uncertainty") {
      write(this.max, fromKelvin(this.extremes.uncertainty, unit).toFixed(1));
      write(this.min, "0");
      setText(this.middle, `${fromKelvin(this.extremes.uncertainty / 2, unit).toFixed(2)} ${unit === "fahrenheit" ? "°F" : "K"}`);
    }
    const rows = classRows(this.look, this.limits);
    this.rows.replaceChildren(...rows.map(([colour, name, text]) => {
      const swatch = h("span", { class: "swatch" });
      swatch.style.background = colour;
      return h("li", {}, swatch, h("span", {}, name, text === "" ? null : h("small", {}, text)));
    }));
    show(this.rows, rows.length > 0);
  }

  private drawBar(): void {
    const isThermal = this.look.layer === "thermal";
    const colours = this.palettes.get(isThermal ? this.look.palette : "inferno");
    const context = this.bar.getContext("2d")!;
    const image = context.createImageData(1, 256);
    for (let y = 0; y < 256; ++y) {
      const i = isThermal ? 255 - y : y;
      for (let c = 0; c < 3; ++c) image.data[4 * y + c] = colours?.[3 * i + c] ?? i;
      image.data[4 * y + 3] = 255;
    }
    context.putImageData(image, 0, 0);
  }
}
