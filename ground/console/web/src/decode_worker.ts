// Unpacks surface groups beside the page's thread, and finds the normals of their vertices.
import { MeshoptDecoder } from "meshoptimizer/decoder";

export interface PackedGroup {
  id: string; version: number; vertexCount: number; indexCount: number;
  vertices: Uint8Array; indices: Uint8Array;
}
export interface PackedDetails { id: string; version: number; vertexCount: number; details: Uint8Array }
export interface DecodedGroup {
  id: string; version: number;
  positions: Uint16Array; temperatures: Uint16Array; conditions: Uint8Array; normals: Int8Array; indices: Uint16Array | Uint32Array;
}
export interface DecodedDetails { id: string; version: number; details: Uint8Array }
export type Task = { kind: "group"; group: PackedGroup } | { kind: "details"; details: PackedDetails };
export type Done = { kind: "group"; group: DecodedGroup } | { kind: "details"; details: DecodedDetails } |
  { kind: "broken"; id: string; why: string };

const vertexBytes = 12;
const worker = self as unknown as { postMessage(message: Done, transfer: Transferable[]): void; onmessage: ((event: MessageEvent<Task>) => void) | null };

/** The area-weighted mean of the normals of the triangles around each vertex, in 127ths. */
function normalsOf(positions: Uint16Array, indices: Uint16Array | Uint32Array, count: number): Int8Array {
  const sums = new Float32Array(3 * count);
  for (let i = 0; i < indices.length; i += 3) {
    const a = 3 * indices[i]!, b = 3 * indices[i + 1]!, c = 3 * indices[i + 2]!;
    const ux = positions[b]! - positions[a]!, uy = positions[b + 1]! - positions[a + 1]!, uz = positions[b + 2]! - positions[a + 2]!;
    const vx = positions[c]! - positions[a]!, vy = positions[c + 1]! - positions[a + 1]!, vz = positions[c + 2]! - positions[a + 2]!;
    const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    for (const corner of [a, b, c]) {
      sums[corner]! += x;
      sums[corner + 1]! += y;
      sums[corner + 2]! += z;
    }
  }
  const normals = new Int8Array(4 * count);
  for (let i = 0; i < count; ++i) {
    const x = sums[3 * i]!, y = sums[3 * i + 1]!, z = sums[3 * i + 2]!;
    const scale = 127 / (Math.hypot(x, y, z) || 1);
    normals[4 * i] = Math.round(scale * x);
    normals[4 * i + 1] = Math.round(scale * y);
    normals[4 * i + 2] = Math.round(scale * z);
  }
  return normals;
}

function decodeGroup(group: PackedGroup): DecodedGroup {
  const count = group.vertexCount;
  const bytes = new Uint8Array(count * vertexBytes);
  MeshoptDecoder.decodeVertexBuffer(bytes, count, vertexBytes, group.vertices);
  const small = count <= 65535;
  const indices = small ? new Uint16Array(group.indexCount) : new Uint32Array(group.indexCount);
  MeshoptDecoder.decodeIndexBuffer(new Uint8Array(indices.buffer), group.indexCount, small ? 2 : 4, group.indices);
  const words = new Uint16Array(bytes.buffer);
  const positions = new Uint16Array(3 * count);
  const temperatures = new Uint16Array(2 * count);
  const conditions = new Uint8Array(4 * count);
  for (let i = 0; i < count; ++i) {
    positions[3 * i] = words[6 * i]!;
    positions[3 * i + 1] = words[6 * i + 1]!;
    positions[3 * i + 2] = words[6 * i + 2]!;
    temperatures[2 * i] = words[6 * i + 3]!;
    conditions.set(bytes.subarray(12 * i + 8, 12 * i + 12), 4 * i);
  }
  return { id: group.id, version: group.version, positions, temperatures, conditions,
    normals: normalsOf(positions, indices, count), indices };
}

function handle(task: Task): void {
  const id = task.kind === "group" ? task.group.id : task.details.id;
  try {
    if (task.kind === "group") {
      const group = decodeGroup(task.group);
      worker.postMessage({ kind: "group", group }, [group.positions.buffer, group.temperatures.buffer,
        group.conditions.buffer, group.normals.buffer, group.indices.buffer]);
      return;
    }
    const details = new Uint8Array(4 * task.details.vertexCount);
    MeshoptDecoder.decodeVertexBuffer(details, task.details.vertexCount, 4, task.details.details);
    worker.postMessage({ kind: "details", details: { id, version: task.details.version, details } }, [details.buffer]);
  } catch (error) {
    worker.postMessage({ kind: "broken", id, why: String(error) }, []);
  }
}

const early: Task[] = [];
worker.onmessage = (event) => early.push(event.data);
await MeshoptDecoder.ready;
worker.onmessage = (event) => handle(event.data);
early.forEach(handle);
