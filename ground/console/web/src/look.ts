// How the surface is coloured: what all parts of the page that show temperatures share.
import { remember } from "./ui";
import type { Unit } from "./units";

export type Layer = "thermal" | "coverage" | "distance" | "angle" | "motion" | "disagreement" | "age" | "uncertainty" | "geometry";

export const layers: readonly (readonly [Layer, string, string])[] = [
  ["thermal", "Temperature", "Apparent or object temperature"],
  ["coverage", "Coverage", "Measured well, acceptably, badly, or not at all"],
  ["distance", "Distance", "Class of the measurement distance"],
  ["angle", "Angle", "Class of the emission angle"],
  ["motion", "Motion", "Class of the smear while it was measured"],
  ["disagreement", "Disagreement", "How far measurements under good conditions contradict each other"],
  ["age", "NUC age", "Seconds since the camera's correction"],
  ["uncertainty", "Uncertainty", "Standard uncertainty of the temperature"],
  ["geometry", "Geometry", "The surface only"],
];

export interface Look {
  layer: Layer;
  palette: string;
  unit: Unit;
  /** The span is fixed until somebody changes it... */
  locked: boolean;
  /** ... but for what the model has beyond it, until somebody has chosen a span. */
  widens: boolean;
  min_celsius: number;
  max_celsius: number;
  /** In °C. */
  isotherms: number[];
  /** Interpreted: temperatures of objects of this emissivity and surroundings. */
  interpret: boolean;
  emissivity: number;
  reflected_celsius: number;
  material: string;
  shading: boolean;
  showVolume: boolean;
  showPath: boolean;
  showCameras: boolean;
  showNext: boolean;
  follow: boolean;
}

const defaults: Look = {
  layer: "thermal", palette: "iron", unit: "celsius", locked: true, widens: true, min_celsius: NaN, max_celsius: NaN, isotherms: [],
  interpret: false, emissivity: 0.95, reflected_celsius: 23, material: "", shading: true, showVolume: true,
  showPath: true, showCameras: true, showNext: true, follow: true,
};

type Listener = (look: Look, changed: Set<keyof Look>) => void;

/** The look, remembered by the browser. */
export class LookStore {
  private readonly memory = remember<Partial<Look>>("look", {});
  private readonly listeners: Listener[] = [];
  value: Look;

  constructor() {
    const kept = this.memory.get();
    this.value = { ...defaults, ...kept };
    // JSON has no NaN.
    if (typeof this.value.min_celsius !== "number") this.value.min_celsius = NaN;
    if (typeof this.value.max_celsius !== "number") this.value.max_celsius = NaN;
  }
  onChange(listener: Listener): void {
    this.listeners.push(listener);
    listener(this.value, new Set(Object.keys(this.value) as (keyof Look)[]));
  }
  set(change: Partial<Look>): void {
    const changed = new Set((Object.keys(change) as (keyof Look)[]).filter((key) => this.value[key] !== change[key]));
    if (changed.size === 0) return;
    this.value = { ...this.value, ...change };
    this.memory.set(this.value);
    for (const listener of this.listeners) listener(this.value, changed);
  }
}

/** Temperature that stands for a code of a vertex; undefined for none. */
export function celsiusOf(code: number): number | undefined {
  return code === 0 ? undefined : -100 + 0.025 * (code - 1);
}

export const classColours = {
  good: "#3ddc84", acceptable: "#ffd23f", bad: "#ff4d4f", unchecked: "#6b5fa0", never: "#2b313b", missing: "#ff2fb3", onlyBad: "#ff9600",
};
