// The time line of a recording that is played back.
import { create } from "@bufbuild/protobuf";
import { PlaybackControlSchema, type Playback } from "./gen/live_pb";
import type { Connection } from "./connection";
import { h, setText } from "./ui";

function clock(seconds: number): string {
  const whole = Math.max(0, Math.round(seconds));
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}

const speeds = ["0.25", "0.5", "1", "2", "4", "8"] as const;

export class PlaybackBar {
  readonly element: HTMLElement;
  private readonly slider: HTMLInputElement;
  private readonly play: HTMLButtonElement;
  private readonly time = h("span", { class: "time" });
  private readonly speed: HTMLSelectElement;
  private playing = false;
  private dragging = false;

  constructor(private readonly connection: Connection) {
    this.slider = h("input", { type: "range", min: "0", max: "1", step: "0.01", value: "0", "aria-label": "Time of the recording" });
    this.slider.addEventListener("input", () => { this.dragging = true; });
    this.slider.addEventListener("change", () => {
      this.dragging = false;
      void this.send({ positionS: Number(this.slider.value) });
    });
    this.play = h("button", { type: "button", class: "primary", title: "Play or pause (space)", onclick: () => this.toggle() }, "Play");
    this.speed = h("select", { "aria-label": "Speed" }, ...speeds.map((value) => h("option", { value }, `${value}×`)));
    this.speed.value = "1";
    this.speed.addEventListener("change", () => void this.send({ speed: Number(this.speed.value) }));
    this.element = h("div", { class: "playback", role: "group", "aria-label": "Playback", hidden: true }, this.play, this.slider, this.time, this.speed);
  }
  toggle(): void {
    if (!this.element.hidden) void this.send({ playing: !this.playing });
  }
  set(state: Playback): void {
    this.element.hidden = false;
    this.playing = state.playing;
    setText(this.play, state.playing ? "Pause" : "Play");
    this.slider.max = String(state.durationS);
    if (!this.dragging) this.slider.value = String(state.positionS);
    setText(this.time, state.seeking ? "…" : `${clock(state.positionS)} / ${clock(state.durationS)}`);
    this.speed.value = speeds.find((value) => Number(value) === state.speed) ?? "1";
  }
  private async send(control: { positionS?: number; speed?: number; playing?: boolean }): Promise<void> {
    await this.connection.ask({ case: "playback", value: create(PlaybackControlSchema, control) });
  }
}
