// The advice in one large sentence, how far the scan is, and sounds for who looks at the machine and not at the screen.
import type { Fractions, Guidance, State } from "./gen/live_pb";
import { Tracking } from "./gen/live_pb";
import { h, remember, setText, show } from "./ui";
import { percent } from "./units";

const icons: Record<string, string> = {
  closer: "⇥", farther: "⇤", less_oblique: "∡", more_oblique: "∠", slower: "◴", hold_for_nuc: "❚❚", go_back: "↶", done: "✓",
};

/** Short patterns of tones, hertz: different ones for what is to be done. */
const tones: Record<string, readonly number[]> = {
  closer: [660, 880], farther: [880, 660], less_oblique: [660, 660], more_oblique: [550, 550], slower: [440, 330, 440],
  hold_for_nuc: [520, 0, 520], go_back: [330, 262, 220], done: [523, 659, 784, 1047],
};

class Bar {
  readonly element: HTMLElement;
  private readonly parts: HTMLElement[];
  private readonly text = h("strong", {}, "–");
  private readonly meter: HTMLElement;
  constructor(private readonly name: string, title: string) {
    this.parts = ["good", "acceptable", "bad", "never"].map((part) => h("span", { class: part }));
    this.meter = h("div", { class: "bar", role: "img", "aria-label": `${name}: nothing seen yet` }, ...this.parts);
    this.element = h("div", { class: "coverage", title }, h("span", { class: "name" }, name), this.meter, this.text);
  }
  set(fractions: Fractions | undefined): void {
    const values = fractions ? [fractions.good, fractions.acceptable, fractions.bad, fractions.neverMeasured] : [0, 0, 0, 0];
    this.parts.forEach((part, i) => { part.style.width = `${(100 * values[i]!).toFixed(1)}%`; });
    setText(this.text, fractions ? percent(fractions.good) : "–");
    this.meter.setAttribute("aria-label", fractions
      ? `${this.name}: ${percent(fractions.good)} measured well, ${percent(fractions.acceptable)} acceptably, ${percent(fractions.bad)} badly, ${percent(fractions.neverMeasured)} never`
      : `${this.name}: nothing seen yet`);
  }
}

export class GuidancePanel {
  readonly element: HTMLElement;
  readonly sound: HTMLButtonElement;
  private readonly icon = h("span", { class: "icon", "aria-hidden": "true" });
  private readonly sentence = h("p", { class: "sentence" }, "Waiting for a scan");
  private readonly reason = h("p", { class: "reason" });
  private readonly view = new Bar("View", "The surface in view, by how well it was measured");
  private readonly model = new Bar("Model", "The whole surface so far, by how well it was measured");
  private readonly area = h("span", { class: "area" });
  private readonly bars = h("div", { class: "bars" });
  private readonly memory = remember("sound", false);
  private audio: AudioContext | null = null;
  private kind = "";
  private guidance: Guidance | undefined;

  constructor() {
    this.sound = h("button", { type: "button", class: "chip", "aria-pressed": String(this.memory.get()), title: "Sounds for advice (S)",
      onclick: () => this.toggleSound() }, "Sound");
    this.element = h("section", { class: "guidance", "aria-label": "Guidance" },
      h("div", { class: "advice", role: "status", "aria-live": "polite" }, this.icon, h("div", {}, this.sentence, this.reason)),
      this.bars);
    this.bars.append(this.view.element, this.model.element, this.area);
    show(this.bars, false);
  }

  toggleSound(): void {
    const on = !this.memory.get();
    this.memory.set(on);
    this.sound.setAttribute("aria-pressed", String(on));
    if (on) this.play([660]);
  }

  /** Advises nothing any more; the coverage that was reached stays. */
  end(text: string, reason: string): void {
    this.guidance = undefined;
    this.say("", text, reason, "idle");
  }

  clear(text: string, reason = ""): void {
    this.end(text, reason);
    this.view.set(undefined);
    this.model.set(undefined);
    setText(this.area, "");
    show(this.bars, false);  // Nothing is known.
  }

  set(guidance: Guidance, state: State | undefined): void {
    show(this.bars, true);
    this.guidance = guidance;
    this.view.set(guidance.view);
    this.model.set(guidance.model);
    setText(this.area, guidance.surfaceM2 > 0 ? `${guidance.surfaceM2.toFixed(2)} m²` : "");
    this.update(state);
  }

  update(state: State | undefined): void {
    const { guidance } = this;
    if (!guidance) return;
    const kind = guidance.kinds[0] ?? "";
    const isLost = guidance.tracking === Tracking.LOST;
    const goOn = guidance.TWorldDepthNext && guidance.nextGainM2 > 0
      ? `the next view would add ${(guidance.nextGainM2 * 1e4).toFixed(0)} cm²` : "";
    const text = guidance.advice !== "" ? sentenceOf(guidance.advice) : isLost ? "Tracking is lost" : "Go on scanning";
    const reason = guidance.reason !== "" ? guidance.reason : goOn;
    const tone = guidance.done || kind === "done" ? "done" : isLost || kind === "go_back" ? "alarm"
      : guidance.advice !== "" ? "advise" : "fine";
    this.say(kind, text, state?.load?.behind === true ? `${reason}${reason === "" ? "" : " · "}the ground is behind` : reason, tone);
    if (kind !== this.kind) {
      this.kind = kind;
      if (this.memory.get() && tones[kind]) this.play(tones[kind]);
    }
  }

  private say(kind: string, text: string, reason: string, tone: string): void {
    setText(this.icon, icons[kind] ?? "");
    show(this.icon, icons[kind] !== undefined);
    setText(this.sentence, text);
    setText(this.reason, reason);
    this.element.dataset["tone"] = tone;
  }

  private play(pattern: readonly number[]): void {
    this.audio ??= new AudioContext();
    void this.audio.resume();
    let at = this.audio.currentTime + 0.02;
    for (const hertz of pattern) {
      if (hertz > 0) {
        const tone = this.audio.createOscillator();
        const volume = this.audio.createGain();
        tone.frequency.value = hertz;
        volume.gain.setValueAtTime(0.0001, at);
        volume.gain.exponentialRampToValueAtTime(0.25, at + 0.02);
        volume.gain.exponentialRampToValueAtTime(0.0001, at + 0.16);
        tone.connect(volume).connect(this.audio.destination);
        tone.start(at);
        tone.stop(at + 0.17);
      }
      at += 0.18;
    }
  }
}

export function sentenceOf(text: string): string {
  return text === "" ? "" : text[0]!.toUpperCase() + text.slice(1);
}
