// Temperatures as people read them.

export type Unit = "celsius" | "fahrenheit" | "kelvin";

export const unitNames: readonly (readonly [Unit, string])[] = [["celsius", "°C"], ["fahrenheit", "°F"], ["kelvin", "K"]];

export function unitSign(unit: Unit): string {
  return unitNames.find(([name]) => name === unit)![1];
}

export function fromCelsius(celsius: number, unit: Unit): number {
  if (unit === "fahrenheit") return celsius * 1.8 + 32;
  return unit === "kelvin" ? celsius + 273.15 : celsius;
}

export function toCelsius(value: number, unit: Unit): number {
  if (unit === "fahrenheit") return (value - 32) / 1.8;
  return unit === "kelvin" ? value - 273.15 : value;
}

/** Of a difference: the zero does not count. */
export function fromKelvin(difference: number, unit: Unit): number {
  return unit === "fahrenheit" ? difference * 1.8 : difference;
}

export function temperature(celsius: number | undefined, unit: Unit, digits = 1): string {
  if (celsius === undefined || !Number.isFinite(celsius)) return "–";
  return `${fromCelsius(celsius, unit).toFixed(digits)} ${unitSign(unit)}`;
}

export function difference(kelvin: number | undefined, unit: Unit, digits = 1): string {
  if (kelvin === undefined || !Number.isFinite(kelvin)) return "–";
  return `${fromKelvin(kelvin, unit).toFixed(digits)} ${unit === "fahrenheit" ? "°F" : "K"}`;
}

export function bytes(count: bigint | number | undefined): string {
  if (count === undefined) return "–";
  const value = Number(count);
  if (value >= 1e12) return `${(value / 1e12).toFixed(1)} TB`;
  if (value >= 1e9) return `${(value / 1e9).toFixed(1)} GB`;
  if (value >= 1e6) return `${(value / 1e6).toFixed(0)} MB`;
  return `${(value / 1e3).toFixed(0)} kB`;
}

export function percent(fraction: number | undefined): string {
  if (fraction === undefined || !Number.isFinite(fraction)) return "–";
  return `${(100 * fraction).toFixed(0)} %`;
}
