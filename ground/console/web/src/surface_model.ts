// The surface as it is held here: groups by their key, as they come, and where sub-maps are.
import * as THREE from "three";
import type { GroupDetails, GroupKey, Maps, Pose, SurfaceGroup } from "./gen/live_pb";
import type { DecodedDetails, DecodedGroup, Done, Task } from "./decode_worker";
import type { Held } from "./connection";

export function idOf(key: GroupKey): string {
  return `${key.map}/${key.x}/${key.y}/${key.z}`;
}

export function matrixOf(pose: Pose): THREE.Matrix4 {
  return new THREE.Matrix4().compose(new THREE.Vector3(pose.x, pose.y, pose.z),
    new THREE.Quaternion(pose.qx, pose.qy, pose.qz, pose.qw), new THREE.Vector3(1, 1, 1));
}

interface Shown { key: GroupKey; version: number; mesh: THREE.Mesh; measured: number[] }

export class SurfaceModel {
  readonly root = new THREE.Group();
  private readonly worker = new Worker("decode.js", { type: "module" });
  private readonly mapRoots: THREE.Group[] = [];
  private readonly shown = new Map<string, Shown>();
  private readonly waiting = new Map<string, SurfaceGroup>();
  private readonly early = new Map<string, DecodedDetails>();
  model = 0n;
  triangles = 0;
  /** null: to be found anew, after a change. */
  private spanShown: [number, number] | null = null;
  /** Codes of temperatures, thinned out, for spans that follow the model. */
  onChange: () => void = () => undefined;
  onFirst: () => void = () => undefined;
  /** Of groups that were new: from the capture of their newest depth frame to their triangles, milliseconds. */
  readonly latencies_ms: number[] = [];

  constructor(private readonly material: THREE.Material) {
    this.worker.addEventListener("message", (event: MessageEvent<Done>) => this.take(event.data));
  }

  held(): Held {
    return { model: this.model, groups: [...this.shown.values()].map(({ key, version }) => ({ key, version })) };
  }
  get groups(): number {
    return this.shown.size;
  }

  begin(model: bigint): void {
    if (model === this.model) return;
    this.model = model;
    for (const id of [...this.shown.keys()]) this.remove(id);
    this.waiting.clear();
    this.early.clear();
    this.onChange();
  }

  setMaps(maps: Maps): void {
    maps.maps.forEach((map, i) => {
      const root = this.rootOf(i);
      if (map.TWorldMap) {
        root.matrix.copy(matrixOf(map.TWorldMap));
        root.matrixWorldNeedsUpdate = true;
      }
      // What nothing connects with the rest would lie anywhere.
      root.visible = map.joined || maps.active === i;
    });
  }
  mapMatrix(map: number): THREE.Matrix4 {
    return this.rootOf(map).matrix;
  }

  add(group: SurfaceGroup): void {
    const id = idOf(group.key!);
    if (group.vertexCount === 0) {
      this.waiting.delete(id);
      this.remove(id);
      this.onChange();
      return;
    }
    this.waiting.set(id, group);
    this.post({ kind: "group", group: { id, version: group.version, vertexCount: group.vertexCount,
      indexCount: group.indexCount, vertices: group.vertices, indices: group.indices } });
  }
  addDetails(details: GroupDetails): void {
    this.post({ kind: "details", details: { id: idOf(details.key!), version: details.version,
      vertexCount: details.vertexCount, details: details.details } });
  }

  /** Span of the apparent temperatures: the middle 98 %. */
  span(): [number, number] | null {
    this.spanShown ??= this.spanOfAll();
    return this.spanShown;
  }
  private spanOfAll(): [number, number] | null {
    const all: number[] = [];
    for (const { measured } of this.shown.values()) all.push(...measured);
    if (all.length === 0) return null;
    all.sort((a, b) => a - b);
    const at = (fraction: number): number => -100 + 0.025 * (all[Math.round(fraction * (all.length - 1))]! - 1);
    return [at(0.01), at(0.99)];
  }

  private post(task: Task): void {
    this.worker.postMessage(task);
  }
  private rootOf(map: number): THREE.Group {
    let root = this.mapRoots[map];
    if (!root) {
      root = new THREE.Group();
      root.matrixAutoUpdate = false;
      this.mapRoots[map] = root;
      this.root.add(root);
    }
    return root;
  }
  private take(done: Done): void {
    if (done.kind === "group") this.show(done.group);
    else if (done.kind === "details") this.detail(done.details);
  }

  private show(decoded: DecodedGroup): void {
    const group = this.waiting.get(decoded.id);
    if (!group || group.version !== decoded.version) return;  // A newer one is on its way, or none any more.
    this.waiting.delete(decoded.id);
    const isFirst = this.shown.size === 0;
    this.remove(decoded.id);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(decoded.positions, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(decoded.normals, 4, true));
    geometry.setAttribute("temperature", new THREE.BufferAttribute(decoded.temperatures, 2));
    geometry.setAttribute("conditions", new THREE.BufferAttribute(decoded.conditions, 4));
    geometry.setIndex(new THREE.BufferAttribute(decoded.indices, 1));
    const half = 32767.5;
    geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(half, half, half), half * Math.sqrt(3));
    const mesh = new THREE.Mesh(geometry, this.material);
    mesh.matrixAutoUpdate = false;
    const scale = group.scale;
    mesh.matrix.makeScale(scale, scale, scale).setPosition(group.origin!.x, group.origin!.y, group.origin!.z);
    this.rootOf(group.key!.map).add(mesh);
    const measured: number[] = [];
    const stride = 2 * Math.max(1, Math.floor(decoded.temperatures.length / 2 / 50));
    for (let i = 0; i < decoded.temperatures.length; i += stride)
      if (decoded.temperatures[i]! > 0) measured.push(decoded.temperatures[i]!);
    this.spanShown = null;
    this.shown.set(decoded.id, { key: group.key!, version: group.version, mesh, measured });
    this.triangles += decoded.indices.length / 3;
    const early = this.early.get(decoded.id);
    if (early) this.detail(early);
    if (group.version === 1 && group.changedTimeNs > 0n && this.latencies_ms.length < 5000)
      this.latencies_ms.push(Date.now() - Number(group.changedTimeNs / 1000000n));
    if (isFirst) this.onFirst();
    this.onChange();
  }

  private detail(details: DecodedDetails): void {
    const shown = this.shown.get(details.id);
    if (shown?.version !== details.version) {
      this.early.set(details.id, details);
      return;
    }
    this.early.delete(details.id);
    shown.mesh.geometry.setAttribute("details", new THREE.BufferAttribute(details.details, 4));
    this.onChange();
  }

  private remove(id: string): void {
    const shown = this.shown.get(id);
    if (!shown) return;
    this.triangles -= (shown.mesh.geometry.index?.count ?? 0) / 3;
    shown.mesh.removeFromParent();
    shown.mesh.geometry.dispose();
    this.shown.delete(id);
    this.spanShown = null;
  }
}
