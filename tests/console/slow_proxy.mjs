// A link of so many bits per second and so many milliseconds one way, for one port on this computer.
import { connect, createServer } from "node:net";

export function slowProxy(target, { bitsPerSecond, delay_ms }) {
  const server = createServer({ allowHalfOpen: false }, (client) => {
    const upstream = connect(target, "127.0.0.1");
    const shape = (from, to) => {
      let free_at = 0;
      let waiting = 0;
      from.on("data", (data) => {
        const now = performance.now();
        free_at = Math.max(now, free_at) + 8000 * data.length / bitsPerSecond;
        waiting += data.length;
        // What a router would buffer.
        if (waiting > 65536) from.pause();
        setTimeout(() => {
          waiting -= data.length;
          if (waiting <= 65536) from.resume();
          if (!to.destroyed) to.write(data);
        }, free_at - now + delay_ms);
      });
      from.on("close", () => setTimeout(() => to.destroy(), delay_ms));
      from.on("error", () => to.destroy());
    };
    shape(client, upstream);
    shape(upstream, client);
  });
  return new Promise((resolve) => server.listen(0, "127.0.0.1", () => resolve({ port: server.address().port, close: () => server.close() })));
}
