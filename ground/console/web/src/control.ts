// Orders to the rig. Each shows the rig's own answer.
import { create } from "@bufbuild/protobuf";
import { Order_Kind, OrderSchema, Role, Scan_Phase, type Scan, type State } from "./gen/live_pb";
import type { Connection } from "./connection";
import { add, h, setText } from "./ui";
import { bytes } from "./units";

/** What /api/files says. */
interface Results { written: boolean; files: { name: string; bytes: number }[] }

const contents: Record<string, string> = {
  "mesh.ply": "mesh, coloured and with temperatures", "cloud.ply": "points with all that is known of each",
  "model.iso": "model, for isotherm view, measure, render and export", "stats.json": "figures of the scan", "trajectory.txt": "path of the rig",
};

export class ControlPanel {
  readonly element = h("div", { class: "control" });
  private readonly log = h("ol", { class: "answers", "aria-live": "polite", "aria-label": "Answers of the rig" });
  private readonly buttons: HTMLButtonElement[] = [];
  private readonly policy: HTMLElement;
  private readonly results = h("div", { class: "results" });
  private readonly viewer = h("p", { class: "note", hidden: true }, "You may look and measure. Orders need the operator's link.");

  constructor(private readonly connection: Connection) {
    const button = (text: string, kind: Order_Kind, style = "", hold_s = 0): HTMLButtonElement => {
      const element = h("button", { type: "button", class: `order ${style}`, onclick: () => void this.give(text, kind, hold_s) }, text);
      this.buttons.push(element);
      return element;
    };
    this.policy = h("span", { class: "now" });
    add(this.element, this.viewer,
      h("h3", {}, "Scan"), h("div", { class: "grid" }, button("Start scan", Order_Kind.START_SCAN, "go"), button("Stop and save", Order_Kind.STOP_SCAN, "stop")),
      h("h3", {}, "Results"), this.results,
      h("h3", {}, "Correction (NUC) ", this.policy),
      h("div", { class: "grid" }, button("Correct now", Order_Kind.NUC_NOW), button("Hold 30 s", Order_Kind.HOLD_NUC, "", 30),
        button("Hold 2 min", Order_Kind.HOLD_NUC, "", 120), button("End hold", Order_Kind.HOLD_NUC, "", 0)),
      h("div", { class: "grid three" }, button("Automatic", Order_Kind.NUC_AUTOMATIC), button("Manual", Order_Kind.NUC_MANUAL),
        button("Camera", Order_Kind.NUC_CAMERA)),
      h("h3", {}, "Answers"), this.log);
  }
  setRole(role: Role): void {
    this.viewer.hidden = role === Role.OPERATOR;
    for (const button of this.buttons) button.disabled = role !== Role.OPERATOR;
  }
  /** Offers the results for download once they are written. */
  setScan(scan: Scan): void {
    const say = (text: string): void => this.results.replaceChildren(h("p", { class: "note" }, text));
    if (scan.phase !== Scan_Phase.ENDED && scan.phase !== Scan_Phase.FINISHED) return say("Written when the scan ends, then to be had here.");
    void fetch("api/files").then(async (reply) => await reply.json() as Results).then(({ files }) => {
      if (files.length === 0) return say("There are none in this folder.");
      const link = ({ name, bytes: size }: Results["files"][number]): HTMLElement =>
        h("li", {}, h("a", { href: `api/files/${name}`, download: name.split("/").at(-1)! }, name), h("small", {}, [contents[name] ?? "rendering", bytes(size)].join(", ")));
      // Renderings are many, and on the page already.
      const order = (name: string): number => Number(name.includes("/"));
      this.results.replaceChildren(h("ul", { class: "files" }, ...files.sort((a, b) => order(a.name) - order(b.name)).map(link)));
      return undefined;
    }).catch(() => say("The list of files could not be fetched."));
  }
  setState(state: State): void {
    setText(this.policy, state.nuc?.policy ? state.nuc.policy : "");
  }
  tell(what: string, text: string, tone: "" | "good" | "bad"): void {
    const time = new Date().toLocaleTimeString();
    this.log.prepend(h("li", { "data-tone": tone }, h("strong", {}, what), h("span", {}, text), h("time", {}, time)));
    while (this.log.children.length > 12) this.log.lastChild!.remove();
  }

  private async give(text: string, kind: Order_Kind, hold_s: number): Promise<void> {
    const answer = await this.connection.ask({ case: "order", value: create(OrderSchema, { kind, holdS: hold_s }) });
    if (!answer) this.tell(text, "the connection is gone: not sent, or the answer was lost", "bad");
    else this.tell(text, answer.text !== "" ? answer.text : answer.done ? "done" : "refused", answer.done ? "good" : "bad");
  }
}
