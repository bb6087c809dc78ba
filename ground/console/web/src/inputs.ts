// What comes in: both cameras' images as received, rates, drops, correction, clock, disks.
import { CameraImage_Sensor, type CameraImage, type State, type Stream } from "./gen/live_pb";
import type { LookStore } from "./look";
import { add, h, setText } from "./ui";
import { bytes, fromCelsius, temperature, unitSign } from "./units";

/** An image in grey, coloured by a palette, with what its ends stand for. */
class ImageView {
  readonly element: HTMLElement;
  private readonly canvas: HTMLCanvasElement;
  private readonly caption = h("span", { class: "range" });
  private readonly badge = h("span", { class: "badge bad", hidden: true }, "Shutter or settling: no temperatures");
  private colours: Uint8Array | undefined;
  private image: CameraImage | undefined;
  private grey: Uint8ClampedArray | undefined;

  constructor(title: string, private readonly text: (image: CameraImage) => string) {
    this.canvas = h("canvas", { width: 320, height: 240, role: "img", "aria-label": `${title} image: none yet` });
    this.element = h("figure", { class: "camera" }, h("figcaption", {}, h("strong", {}, title), this.caption), this.canvas, this.badge);
  }
  setColours(colours: Uint8Array | undefined): void {
    this.colours = colours;
    this.draw();
  }
  async set(image: CameraImage): Promise<void> {
    if (image.png.length === 0) return;
    const bitmap = await createImageBitmap(new Blob([image.png as Uint8Array<ArrayBuffer>], { type: "image/png" }), { colorSpaceConversion: "none" });
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext("2d")!;
    context.drawImage(bitmap, 0, 0);
    this.grey = context.getImageData(0, 0, bitmap.width, bitmap.height).data;
    if (this.canvas.width !== bitmap.width || this.canvas.height !== bitmap.height) {
      this.canvas.width = bitmap.width;
      this.canvas.height = bitmap.height;
    }
    bitmap.close();
    this.image = image;
    this.draw();
  }
  redraw(): void {
    this.draw();
  }
  private draw(): void {
    if (!this.image || !this.grey) return;
    const context = this.canvas.getContext("2d")!;
    const out = context.createImageData(this.canvas.width, this.canvas.height);
    for (let i = 0; i < this.grey.length; i += 4) {
      const value = this.grey[i]!;
      if (value > 0) {
        const c = 3 * Math.round((value - 1) * 255 / 254);
        out.data[i] = this.colours?.[c] ?? value;
        out.data[i + 1] = this.colours?.[c + 1] ?? value;
        out.data[i + 2] = this.colours?.[c + 2] ?? value;
      }
      out.data[i + 3] = 255;
    }
    context.putImageData(out, 0, 0);
    const text = this.text(this.image);
    setText(this.caption, text);
    this.canvas.setAttribute("aria-label", text);
    this.badge.hidden = this.image.valid;
  }
}

function row(name: string): { element: HTMLElement; set: (text: string, tone?: string) => void } {
  const value = h("dd", {}, "–");
  return { element: h("div", {}, h("dt", {}, name), value), set: (text, tone = "") => {
    setText(value, text);
    value.dataset["tone"] = tone;
  } };
}

export class InputsPanel {
  readonly element = h("div", { class: "inputs" });
  private readonly depth: ImageView;
  private readonly thermal: ImageView;
  private readonly rows = {
    link: row("Rig"), depth: row("Depth"), thermal: row("Thermal"), dropped: row("Dropped"), missing: row("Missing"),
    backlog: row("Backlog"), nuc: row("Correction"), temperatures: row("Camera"), clock: row("Clock"), age: row("Feedback age"),
    rigDisk: row("Rig's disk"), disk: row("Disk here"), recording: row("Recording"), load: row("Ground"), calibration: row("Calibration"), page: row("This page"),
  };

  constructor(looks: LookStore) {
    this.depth = new ImageView("Depth", (image) => `${image.min.toFixed(2)} to ${image.max.toFixed(2)} m`);
    this.thermal = new ImageView("Thermal", (image) => {
      const { unit } = looks.value;
      return `${fromCelsius(image.min, unit).toFixed(1)} to ${fromCelsius(image.max, unit).toFixed(1)} ${unitSign(unit)}`;
    });
    this.element.append(h("div", { class: "cameras" }, this.thermal.element, this.depth.element));
    const list = h("dl", { class: "facts" });
    for (const entry of Object.values(this.rows)) list.append(entry.element);
    add(this.element, list);
    looks.onChange(() => this.thermal.redraw());
  }
  setColours(thermal: Uint8Array | undefined): void {
    this.thermal.setColours(thermal);
  }
  setImage(image: CameraImage): void {
    void (image.sensor === CameraImage_Sensor.DEPTH ? this.depth : this.thermal).set(image);
  }
  setPage(text: string): void {
    this.rows.page.set(text);
  }

  setState(state: State, unit: Parameters<typeof temperature>[1]): void {
    const { rows } = this;
    const { link, nuc, disk, load } = state;
    rows.link.set(link?.problem ? link.problem : link?.rigPresent ? `connected, ${state.scanState || "idle"}, ${link.publishPolicy}` : "not there",
      link?.problem || !link?.rigPresent ? "bad" : "good");
    const rate = (stream: Stream | undefined): string => stream?.present
      ? `${stream.rateHz.toFixed(1)} per second, ${stream.received} of ${stream.captured}` : "none";
    rows.depth.set(rate(state.depth));
    rows.thermal.set(rate(state.thermal));
    const drops = [...(state.depth?.dropped ?? []), ...(state.thermal?.dropped ?? [])].filter(({ frames }) => frames > 0n);
    rows.dropped.set(drops.length === 0 ? "none" : drops.map(({ reason, frames }) => `${frames} ${reason}`).join(", "), drops.length > 0 ? "warn" : "");
    const missing = Number(state.depth?.missing ?? 0n) + Number(state.thermal?.missing ?? 0n);
    rows.missing.set(missing === 0 ? "none" : String(missing), missing > 0 ? "warn" : "");
    rows.backlog.set(link ? `${link.backlogFrames} frames` : "–", Number(link?.backlogFrames ?? 0n) > 100 ? "warn" : "");
    rows.nuc.set(nuc ? `${nuc.state}${nuc.secondsSince === undefined ? "" : `, ${nuc.secondsSince.toFixed(0)} s ago`}${nuc.reason ? ` (${nuc.reason})` : ""}, ${nuc.policy}` : "–",
      nuc?.storm ? "bad" : "");
    rows.temperatures.set(nuc ? `detector ${temperature(nuc.fpaCelsius, unit)}, housing ${temperature(nuc.housingCelsius, unit)}${nuc.warmingUp ? ", warming up" : ""}` : "–",
      nuc?.warmingUp ? "warn" : "");
    rows.clock.set(link?.clock ? link.clock : "–", link && !link.clockSynchronised ? "warn" : "");
    rows.age.set(link?.feedbackP50S === undefined ? "–" : `${(link.feedbackP50S * 1000).toFixed(0)} ms`);
    rows.rigDisk.set(disk?.rigFreeBytes === undefined ? "–" : `${bytes(disk.rigFreeBytes)} free`, Number(disk?.rigFreeBytes ?? 1e12) < 4e9 ? "warn" : "");
    rows.disk.set(disk?.freeBytes === undefined ? "–" : `${bytes(disk.freeBytes)} free${disk.text ? `, ${disk.text.replace(/^disk: /, "")}` : ""}`);
    rows.recording.set(disk?.recording ? `${bytes(disk.recordingBytes)}${disk.paused ? ", paused" : ""}${disk.leftOut > 0n ? `, lacks ${disk.leftOut} frames` : ""}` : "none",
      disk?.paused || (disk?.leftOut ?? 0n) > 0n ? "bad" : "");
    rows.load.set(load?.problem ? load.problem : load?.behind ? `behind: ${load.thermalLeftOut} thermal frames left out` : "keeps up",
      load?.problem ? "bad" : load?.behind ? "warn" : "good");
    rows.calibration.set(state.movedCalibration || "–", state.movedCalibration ? "bad" : "");
  }
}
