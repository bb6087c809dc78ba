// The WebSocket: keeps trying, resumes, hands each message to who asked for it.
import { create, fromBinary, toBinary, type MessageInitShape } from "@bufbuild/protobuf";
import { ClientMessageSchema, ServerMessageSchema, type Answer, type GroupKey, type ServerMessage } from "./gen/live_pb";

type Content = ServerMessage["content"];
export type Case = Exclude<Content["case"], undefined>;
type ValueOf<C extends Case> = Extract<Content, { case: C }>["value"];
type ClientContent = NonNullable<MessageInitShape<typeof ClientMessageSchema>["content"]>;

export const protocol = 1;

export interface Held { model: bigint; groups: { key: GroupKey; version: number }[] }

export class Connection {
  private socket: WebSocket | null = null;
  private readonly handlers = new Map<Case, ((value: never) => void)[]>();
  private readonly waiting = new Map<bigint, (answer: Answer | null) => void>();
  private nextNumber = 1n;
  private retry_ms = 250;
  private received_bytes = 0;
  private stopped = false;
  /** What the page has already, for a connection that comes back. */
  held: () => Held = () => ({ model: 0n, groups: [] });
  onState: (connected: boolean) => void = () => undefined;

  on<C extends Case>(name: C, handler: (value: ValueOf<C>) => void): void {
    const list = this.handlers.get(name) ?? [];
    list.push(handler as (value: never) => void);
    this.handlers.set(name, list);
  }

  open(): void {
    const url = new URL("live", location.href);
    url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(url, "isotherm.live.v1");
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.addEventListener("open", () => {
      this.retry_ms = 250;
      const held = this.held();
      this.post({ case: "hello", value: { protocol, model: held.model, groups: held.groups } });
      this.onState(true);
    });
    socket.addEventListener("message", (event: MessageEvent<ArrayBuffer>) => this.take(event.data));
    socket.addEventListener("close", () => this.closed());
  }

  /** Sends without waiting for an answer. False if there is no connection. */
  post(content: ClientContent): boolean {
    return this.sendWith(0n, content);
  }

  /** Asks; null if the connection is gone before there is an answer. */
  ask(content: ClientContent): Promise<Answer | null> {
    const number = this.nextNumber++;
    return new Promise((resolve) => {
      if (!this.sendWith(number, content)) resolve(null);
      else this.waiting.set(number, resolve);
    });
  }

  takeReceivedBytes(): number {
    const bytes = this.received_bytes;
    this.received_bytes = 0;
    return bytes;
  }

  /** For tests: breaks the connection; it comes back by itself. */
  drop(): void {
    this.socket?.close();
  }

  private sendWith(number: bigint, content: ClientContent): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(toBinary(ClientMessageSchema, create(ClientMessageSchema, { number, content })) as Uint8Array<ArrayBuffer>);
    return true;
  }

  private take(data: ArrayBuffer): void {
    this.received_bytes += data.byteLength;
    const { content } = fromBinary(ServerMessageSchema, new Uint8Array(data));
    if (content.case === undefined) return;
    if (content.case === "welcome" && content.value.protocol !== protocol) {
      this.stopped = true;
      location.reload();
      return;
    }
    if (content.case === "answer") {
      this.waiting.get(content.value.number)?.(content.value);
      this.waiting.delete(content.value.number);
    }
    for (const handler of this.handlers.get(content.case) ?? []) handler(content.value as never);
  }

  private closed(): void {
    for (const resolve of this.waiting.values()) resolve(null);
    this.waiting.clear();
    this.onState(false);
    if (this.stopped) return;
    setTimeout(() => this.open(), this.retry_ms);
    this.retry_ms = Math.min(4000, this.retry_ms * 2);
  }
}
