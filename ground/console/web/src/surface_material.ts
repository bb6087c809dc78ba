// The shader that colours the surface: palette, span, emissivity, isotherms and layers are uniforms, so that nothing has
// to be sent again when they change.
import * as THREE from "three";
import { classColours, layers, type Layer, type Look } from "./look";
import { ratiosOf, type Radiance } from "./radiance";
import type { MaterialTable } from "./gen/live_pb";

export const maxIsotherms = 8;

const vertexShader = /* glsl */ `
in vec2 temperature;
in vec4 conditions;
in vec4 details;
uniform sampler2D radiance;
uniform sampler2D ratios;
uniform vec2 radianceRange;
uniform int radianceSize;
uniform bool interpret;
uniform float emissivity;
uniform float reflectedRadiance;
out vec3 vNormal;
out vec3 vPosition;
out float vCelsius;
out float vMeasured;
out float vAge;
out float vAgeKnown;
out float vSigma;
out float vSigmaKnown;
flat out int vClasses;

float tableAt(sampler2D table, int i) { return texelFetch(table, ivec2(i, 0), 0).r; }

float radianceOf(float celsius) {
  float at = clamp((celsius - radianceRange.x) / (radianceRange.y - radianceRange.x), 0.0, 1.0) * float(radianceSize - 1);
  int first = min(int(at), radianceSize - 2);
  return mix(tableAt(radiance, first), tableAt(radiance, first + 1), at - float(first));
}

float celsiusOf(float value) {
  int low = 0;
  int high = radianceSize - 1;
  for (int i = 0; i < 12; ++i) {
    int middle = (low + high) / 2;
    if (tableAt(radiance, middle) <= value) low = middle; else high = middle;
  }
  high = low + 1;
  float from = tableAt(radiance, low);
  float fraction = (value - from) / (tableAt(radiance, high) - from);
  return mix(radianceRange.x, radianceRange.y, (float(low) + fraction) / float(radianceSize - 1));
}

void main() {
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  vPosition = view.xyz;
  vNormal = normalMatrix * normal;
  vMeasured = temperature.x > 0.0 ? 1.0 : 0.0;
  float celsius = -100.0 + 0.025 * (temperature.x - 1.0);
  if (interpret && vMeasured > 0.5) {
    float degrees = conditions.y >= 255.0 ? 0.0 : 0.5 * conditions.y;
    int whole = min(int(degrees), 89);
    float e = min(1.0, emissivity * mix(tableAt(ratios, whole), tableAt(ratios, whole + 1), degrees - float(whole)));
    float emitted = (radianceOf(celsius) - (1.0 - e) * reflectedRadiance) / e;
    if (emitted < tableAt(radiance, 0)) vMeasured = 0.0; else celsius = celsiusOf(emitted);
  }
  vCelsius = celsius;
  vClasses = int(conditions.x + 0.5);
  vAgeKnown = conditions.w >= 255.0 ? 0.0 : 1.0;
  vAge = 1024.0 * (conditions.w / 254.0) * (conditions.w / 254.0);
  vSigmaKnown = details.x > 0.0 ? 1.0 : 0.0;
  // The upper bits of a single-precision number: four of the exponent, four of the mantissa, beginning at 2^-7.
  float code = details.x - 1.0;
  float step16 = floor(code / 16.0);
  vSigma = exp2(step16 - 7.0) * (1.0 + (code - 16.0 * step16) / 16.0);
  gl_Position = projectionMatrix * view;
}`;

const fragmentShader = /* glsl */ `
precision highp float;
uniform int layer;
uniform sampler2D palette;
uniform sampler2D inferno;
uniform vec2 span;
uniform float isotherms[${maxIsotherms}];
uniform int isothermCount;
uniform bool shading;
uniform float largestAge;
uniform float largestSigma;
uniform vec2 alarm;
uniform vec3 goodColour, acceptableColour, badColour, uncheckedColour, neverColour, missingColour, onlyBadColour;
in vec3 vNormal;
in vec3 vPosition;
in float vCelsius;
in float vMeasured;
in float vAge;
in float vAgeKnown;
in float vSigma;
in float vSigmaKnown;
flat in int vClasses;
out vec4 colour;

vec3 classColour(int condition, vec3 unknown) {
  return condition == 3 ? goodColour : condition == 2 ? acceptableColour : condition == 1 ? badColour : unknown;
}

/// A hatching that stands for "never measured": it cannot be taken for a temperature.
vec3 never() {
  float stripe = mod(gl_FragCoord.x + gl_FragCoord.y, 12.0) < 6.0 ? 1.0 : 0.0;
  return mix(vec3(0.145, 0.165, 0.2), vec3(0.205, 0.23, 0.275), stripe);
}

vec3 coverage() {
  int d = vClasses & 3;
  int a = (vClasses >> 2) & 3;
  int m = (vClasses >> 4) & 3;
  if (d == 0 || a == 0) return missingColour;
  int worst = min(d, a);
  if (m != 0) worst = min(worst, m);
  return worst == 3 ? vec3(0.73, 0.755, 0.77) : worst == 2 ? vec3(0.47, 0.55, 0.59) : onlyBadColour;
}

vec3 along(float value, float largest) {
  return texture(inferno, vec2(clamp(1.0 - value / largest, 0.002, 0.998), 0.5)).rgb;
}

void main() {
  bool measured = vMeasured > 0.999;
  vec3 base;
  float light = 1.0;
  if (layer == 0) {
    float fraction = (vCelsius - span.x) / (span.y - span.x);
    base = measured ? texture(palette, vec2(clamp(fraction, 0.002, 0.998), 0.5)).rgb : never();
    if (measured && (vCelsius > alarm.y || vCelsius < alarm.x)) {
      float pulse = mod(gl_FragCoord.x - gl_FragCoord.y, 10.0) < 5.0 ? 1.0 : 0.0;
      base = mix(base, vCelsius > alarm.y ? vec3(1.0, 0.1, 0.1) : vec3(0.1, 0.5, 1.0), 0.35 + 0.4 * pulse);
    }
  } else if (layer == 1) base = coverage();
  else if (layer == 2) base = classColour(vClasses & 3, neverColour);
  else if (layer == 3) base = classColour((vClasses >> 2) & 3, neverColour);
  else if (layer == 4) base = classColour((vClasses >> 4) & 3, (vClasses & 3) == 0 ? neverColour : uncheckedColour);
  else if (layer == 5) base = classColour((vClasses >> 6) & 3, (vClasses & 3) == 0 ? neverColour : uncheckedColour);
  else if (layer == 6) base = !measured ? never() : vAgeKnown > 0.999 ? along(vAge, largestAge) : uncheckedColour;
  else if (layer == 7) base = !measured ? never() : vSigmaKnown > 0.999 ? along(vSigma, largestSigma) : uncheckedColour;
  else base = vec3(0.88, 0.886, 0.9);
  if (layer == 0 && measured) {
    float slope = max(fwidth(vCelsius), 1e-4);
    for (int i = 0; i < isothermCount; ++i) {
      float off = abs(vCelsius - isotherms[i]) / slope;
      base = mix(vec3(0.06, 0.07, 0.086), base, smoothstep(1.3, 2.2, off));
      base = mix(vec3(1.0), base, smoothstep(0.6, 1.2, off));
    }
  }
  if (shading || layer == 8) {
    vec3 n = normalize(vNormal);
    float facing = abs(dot(n, normalize(-vPosition)));
    light = layer == 8 ? 0.25 + 0.75 * facing : 0.62 + 0.38 * facing;
  }
  colour = vec4(base * light, 1.0);
}`;

function paletteTexture(colours: Uint8Array): THREE.DataTexture {
  const rgba = new Uint8Array(4 * 256);
  for (let i = 0; i < 256; ++i) {
    rgba.set(colours.subarray(3 * i, 3 * i + 3), 4 * i);
    rgba[4 * i + 3] = 255;
  }
  const texture = new THREE.DataTexture(rgba, 256, 1);
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

function tableTexture(values: Float32Array): THREE.DataTexture {
  const texture = new THREE.DataTexture(values, values.length, 1, THREE.RedFormat, THREE.FloatType);
  texture.needsUpdate = true;
  return texture;
}

export class SurfaceMaterial {
  readonly material: THREE.ShaderMaterial;
  private readonly palettes = new Map<string, THREE.DataTexture>();
  private radiance: Radiance | null = null;
  private materials: MaterialTable[] = [];

  constructor() {
    const grey = paletteTexture(Uint8Array.from({ length: 768 }, (_, i) => Math.floor(i / 3)));
    const rgb = (hex: string): THREE.Vector3 => {
      const c = new THREE.Color().setStyle(hex, THREE.LinearSRGBColorSpace);
      return new THREE.Vector3(c.r, c.g, c.b);
    };
    this.material = new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader, fragmentShader, side: THREE.DoubleSide,
      uniforms: {
        layer: { value: 0 }, palette: { value: grey }, inferno: { value: grey }, span: { value: new THREE.Vector2(0, 1) },
        isotherms: { value: new Array(maxIsotherms).fill(0) }, isothermCount: { value: 0 }, shading: { value: true },
        largestAge: { value: 60 }, largestSigma: { value: 2 },
        alarm: { value: new THREE.Vector2(-1e9, 1e9) },
        radiance: { value: tableTexture(new Float32Array([0, 1])) }, radianceRange: { value: new THREE.Vector2(-100, 1500) },
        radianceSize: { value: 2 }, ratios: { value: tableTexture(new Float32Array(91).fill(1)) },
        interpret: { value: false }, emissivity: { value: 1 }, reflectedRadiance: { value: 0 },
        goodColour: { value: rgb(classColours.good) }, acceptableColour: { value: rgb(classColours.acceptable) },
        badColour: { value: rgb(classColours.bad) }, uncheckedColour: { value: rgb(classColours.unchecked) },
        neverColour: { value: rgb(classColours.never) }, missingColour: { value: rgb(classColours.missing) },
        onlyBadColour: { value: rgb(classColours.onlyBad) },
      },
    });
  }
  setTables(palettes: { name: string; colours: Uint8Array }[], radiance: Radiance, materials: MaterialTable[]): void {
    for (const { name, colours } of palettes) this.palettes.set(name, paletteTexture(colours));
    this.radiance = radiance;
    this.materials = materials;
    const u = this.material.uniforms;
    u["radiance"]!.value = tableTexture(radiance.values);
    (u["radianceRange"]!.value as THREE.Vector2).set(radiance.min, radiance.max);
    u["radianceSize"]!.value = radiance.values.length;
    u["inferno"]!.value = this.palettes.get("inferno") ?? u["inferno"]!.value;
  }
  apply(look: Look): void {
    const u = this.material.uniforms;
    u["layer"]!.value = layers.findIndex(([name]) => name === look.layer);
    u["palette"]!.value = this.palettes.get(look.palette) ?? u["palette"]!.value;
    u["isothermCount"]!.value = Math.min(maxIsotherms, look.isotherms.length);
    u["isotherms"]!.value = Array.from({ length: maxIsotherms }, (_, i) => look.isotherms[i] ?? 0);
    u["shading"]!.value = look.shading;
    u["interpret"]!.value = look.interpret && (look.emissivity < 1 || look.material !== "");
    u["emissivity"]!.value = look.emissivity;
    u["reflectedRadiance"]!.value = this.radiance?.ofCelsius(look.reflected_celsius) ?? 0;
    u["ratios"]!.value = tableTexture(ratiosOf(this.materials.find(({ name }) => name === look.material)));
  }
  setSpan(min: number, max: number): void {
    (this.material.uniforms["span"]!.value as THREE.Vector2).set(min, max);
  }
  setLargest(age_s: number, sigma_k: number): void {
    this.material.uniforms["largestAge"]!.value = age_s;
    this.material.uniforms["largestSigma"]!.value = sigma_k;
  }
  setAlarm(below: number | undefined, above: number | undefined): void {
    (this.material.uniforms["alarm"]!.value as THREE.Vector2).set(below ?? -1e9, above ?? 1e9);
  }
}

export type { Layer };
