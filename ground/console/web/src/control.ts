// Orders to the rig. Each shows the rig's own answer.
import { create } from "@bufbuild/protobuf";
import { Order_Kind, OrderSchema, Role, type State } from "./gen/live_pb";
import type { Connection } from "./connection";
import { add, h, setText } from "./ui";

export class ControlPanel {
  readonly element = h("div", { class: "control" });
  private readonly log = h("ol", { class: "answers", "aria-live": "polite", "aria-label": "Answers of the rig" });
  private readonly buttons: HTMLButtonElement[] = [];
  private readonly policy: HTMLElement;
  private readonly viewer = h("p", { class: "note", hidden: true }, "You may look and measure. Orders need the operator's link.");

  constructor(private readonly connection: Connection) {
    const button = (text: string, kind: Order_Kind, style = "", hold_s = 0): HTMLButtonElement => {
      const element = h("button", { type: "button", class: `order ${style}`, onclick: () => void this.give(text, kind, hold_s) }, text);
      this.buttons.push(element);
      return element;
    };
    this.policy = h("span", { class: "now" });
    add(this.element, this.viewer,
      h("h3", {}, "Scan"), h("div", { class: "grid" }, button("Start scan", Order_Kind.START_SCAN, "go"), button("Stop scan", Order_Kind.STOP_SCAN, "stop")),
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
