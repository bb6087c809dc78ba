// Object temperatures on the page, from the band radiance of the service: the same table goes into the shader.
import type { MaterialTable, RadianceTable } from "./gen/live_pb";

export class Radiance {
  readonly values: Float32Array;
  readonly min: number;
  readonly max: number;

  constructor(table: RadianceTable) {
    this.values = Float32Array.from(table.radiance);
    this.min = table.minCelsius;
    this.max = table.maxCelsius;
  }
  ofCelsius(celsius: number): number {
    const at = (celsius - this.min) / (this.max - this.min) * (this.values.length - 1);
    if (!(at >= 0) || at > this.values.length - 1) return NaN;
    const first = Math.min(Math.floor(at), this.values.length - 2);
    return this.values[first]! + (at - first) * (this.values[first + 1]! - this.values[first]!);
  }
  toCelsius(radiance: number): number {
    const values = this.values;
    if (!(radiance >= values[0]!) || radiance > values[values.length - 1]!) return NaN;
    let low = 0, high = values.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (values[middle]! <= radiance) low = middle; else high = middle;
    }
    const fraction = (radiance - values[low]!) / (values[high]! - values[low]!);
    return this.min + (low + fraction) / (values.length - 1) * (this.max - this.min);
  }
  objectCelsius(apparent: number, emissivity: number, reflected: number): number {
    return this.toCelsius((this.ofCelsius(apparent) - (1 - emissivity) * this.ofCelsius(reflected)) / emissivity);
  }
}

/** Emissivity as a ratio to that along the normal, for 0 to 90 degrees. */
export function ratiosOf(material: MaterialTable | undefined): Float32Array {
  const ratios = new Float32Array(91).fill(1);
  if (material) ratios.set(material.byAngle.slice(0, 91));
  return ratios;
}
