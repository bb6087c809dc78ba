// The 3D view: the surface, the rig with its cameras, its way, where to go next; and how one moves in it.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Camera, Path, Pose, RigPose, Scan } from "./gen/live_pb";
import { Tracking } from "./gen/live_pb";
import type { Look, LookStore } from "./look";
import { SurfaceMaterial } from "./surface_material";
import { SurfaceModel, matrixOf } from "./surface_model";

/** Seen from the depth camera: x right, y down, z forward. */
const behind = new THREE.Vector3(0, -0.22, -0.55);
const ahead = new THREE.Vector3(0, 0, 0.65);

function frustumOf(camera: Camera | undefined, depth_m: number, colour: number, dashed: boolean): THREE.LineSegments {
  const fx = camera?.fx ?? 1, fy = camera?.fy ?? 1, cx = camera?.cx ?? 0, cy = camera?.cy ?? 0;
  const corner = (x: number, y: number): THREE.Vector3 =>
    new THREE.Vector3(depth_m * (x - cx) / fx, depth_m * (y - cy) / fy, depth_m);
  const w = camera?.width ?? 0, height = camera?.height ?? 0;
  const c = [corner(0, 0), corner(w, 0), corner(w, height), corner(0, height)];
  const o = new THREE.Vector3();
  const top = new THREE.Vector3().addVectors(c[0]!, c[1]!).multiplyScalar(0.5);
  top.y -= 0.06 * depth_m;
  const points = [o, c[0]!, o, c[1]!, o, c[2]!, o, c[3]!, c[0]!, c[1]!, c[1]!, c[2]!, c[2]!, c[3]!, c[3]!, c[0]!, c[0]!, top, top, c[1]!];
  const geometry = new THREE.BufferGeometry().setFromPoints(points);
  const material = dashed ? new THREE.LineDashedMaterial({ color: colour, dashSize: 0.02, gapSize: 0.015 })
    : new THREE.LineBasicMaterial({ color: colour });
  const lines = new THREE.LineSegments(geometry, material);
  if (dashed) lines.computeLineDistances();
  lines.matrixAutoUpdate = false;
  lines.visible = false;
  lines.frustumCulled = false;
  return lines;
}

/** A frame that takes longer is one that a person sees the page wait for. */
const slowFrame_ms = 80;

export class View3d {
  readonly surface: SurfaceModel;
  readonly surfaceMaterial = new SurfaceMaterial();
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(50, 1, 0.01, 100);
  readonly controls: OrbitControls;
  readonly overlay = new THREE.Group();
  private readonly renderer: THREE.WebGLRenderer;
  private readonly path = new THREE.Group();
  private readonly volume = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0x3a4656 }));
  private depth = frustumOf(undefined, 0.2, 0x4cc2ff, false);
  private thermal = frustumOf(undefined, 0.2, 0xff9d45, false);
  private next = frustumOf(undefined, 0.16, 0x7dffb2, true);
  private readonly arrow = new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), 0.1, 0x7dffb2, 0.05, 0.03);
  private T_thermal_depth: Pose | undefined;
  private rigMatrix = new THREE.Matrix4();
  private hasRig = false;
  private isLost = false;
  private nextPose: Pose | undefined;
  private scan: Scan | undefined;
  private needsFrame = true;
  private look: Look;
  private readonly eye = new THREE.Vector3();
  private readonly target = new THREE.Vector3();
  private lastFrame = 0;
  private framed = false;
  frameTimes: number[] = [];
  /** When the frame before this one was drawn, if it was. */
  private drawnAt: number | undefined;
  private restUntil = 0;
  onMoved: () => void = () => undefined;
  onFrame: () => void = () => undefined;

  constructor(readonly canvas: HTMLCanvasElement, private readonly looks: LookStore) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, powerPreference: "high-performance", preserveDrawingBuffer: true });
    this.renderer.setClearColor(0x0b0e13);
    this.surface = new SurfaceModel(this.surfaceMaterial.material);
    this.surface.onChange = () => this.invalidate();
    this.look = looks.value;
    this.camera.up.set(0, -1, 0);
    this.camera.position.set(0, -0.4, -1.2);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.zoomToCursor = true;
    this.controls.minDistance = 0.02;
    this.controls.addEventListener("start", () => looks.set({ follow: false }));
    this.controls.addEventListener("change", () => { this.invalidate(); this.onMoved(); });
    this.scene.add(this.surface.root, this.path, this.volume, this.depth, this.thermal, this.next, this.arrow, this.overlay);
    this.arrow.visible = false;
    this.volume.visible = false;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    this.resize();
    looks.onChange((look) => {
      this.look = look;
      this.surfaceMaterial.apply(look);
      this.arrange();
    });
    this.renderer.setAnimationLoop((time) => this.frame(time));
  }

  invalidate(): void {
    this.needsFrame = true;
  }

  setScan(scan: Scan): void {
    const isNew = scan.model !== this.scan?.model;
    this.scan = scan;
    this.surface.begin(scan.model);
    if (isNew) {
      this.hasRig = false;
      this.framed = false;
      this.path.clear();
      this.nextPose = undefined;
    }
    this.T_thermal_depth = scan.TThermalDepth;
    this.scene.remove(this.depth, this.thermal, this.next);
    this.depth = frustumOf(scan.depth, 0.22, 0x4cc2ff, false);
    this.thermal = frustumOf(scan.thermal, 0.2, 0xff9d45, false);
    this.next = frustumOf(scan.depth, 0.18, 0x7dffb2, true);
    this.scene.add(this.depth, this.thermal, this.next);
    if (scan.volumeMin && scan.volumeMax) {
      const min = new THREE.Vector3(scan.volumeMin.x, scan.volumeMin.y, scan.volumeMin.z);
      const max = new THREE.Vector3(scan.volumeMax.x, scan.volumeMax.y, scan.volumeMax.z);
      const size = new THREE.Vector3().subVectors(max, min);
      this.volume.geometry.dispose();
      this.volume.geometry = new THREE.EdgesGeometry(new THREE.BoxGeometry(size.x, size.y, size.z));
      this.volume.position.addVectors(min, max).multiplyScalar(0.5);
      if (!this.framed && !this.hasRig) this.home();
    }
    this.arrange();
  }

  setPose(pose: RigPose): void {
    this.isLost = pose.tracking === Tracking.LOST || pose.tracking === Tracking.TRACKING_WAITING;
    if (pose.TMapDepth) {
      this.rigMatrix = this.surface.mapMatrix(pose.map).clone().multiply(matrixOf(pose.TMapDepth));
      if (!this.hasRig) this.jumpToRig();
      this.hasRig = true;
    }
    this.arrange();
  }

  setPath(path: Path): void {
    this.path.clear();
    for (const part of path.parts) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(part.positions), 3));
      const line = new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: 0x8fb4d9, transparent: true, opacity: 0.8 }));
      line.matrixAutoUpdate = false;
      line.matrix.copy(this.surface.mapMatrix(part.map));
      line.frustumCulled = false;
      this.path.add(line);
    }
    this.invalidate();
  }

  setNext(pose: Pose | undefined): void {
    this.nextPose = pose;
    this.arrange();
  }

  /** The whole volume from the side where the rig began. */
  home(): void {
    if (!this.scan?.volumeMin || !this.scan.volumeMax) return;
    const { volumeMin: a, volumeMax: b } = this.scan;
    this.target.set((a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2);
    const size = Math.max(b.x - a.x, b.y - a.y, b.z - a.z);
    this.eye.set(this.target.x + 0.35 * size, this.target.y - 0.45 * size, this.target.z - 1.45 * size);
    this.camera.position.copy(this.eye);
    this.controls.target.copy(this.target);
    this.framed = true;
    this.looks.set({ follow: false });
    this.invalidate();
  }

  /** Turns and moves as keys ask: radians, and a fraction of the distance to what is looked at. */
  nudge(yaw: number, pitch: number, zoom: number): void {
    this.looks.set({ follow: false });
    const offset = new THREE.Vector3().subVectors(this.camera.position, this.controls.target);
    const up = this.camera.up.clone().normalize();
    offset.applyAxisAngle(up, yaw);
    const right = new THREE.Vector3().crossVectors(up, offset).normalize();
    const tilted = offset.clone().applyAxisAngle(right, pitch);
    if (Math.abs(tilted.clone().normalize().dot(up)) < 0.995) offset.copy(tilted);
    offset.multiplyScalar(zoom);
    this.camera.position.addVectors(this.controls.target, offset);
    this.invalidate();
  }

  eyeInWorld(): { x: number; y: number; z: number } {
    const { x, y, z } = this.look.follow && this.hasRig
      ? new THREE.Vector3().setFromMatrixPosition(this.rigMatrix) : this.camera.position;
    return { x, y, z };
  }

  get drawCalls(): number {
    return this.renderer.info.render.calls;
  }

  /** The ray through a point of the canvas, in `world`. */
  rayAt(clientX: number, clientY: number): THREE.Ray {
    const box = this.canvas.getBoundingClientRect();
    const caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2(2 * (clientX - box.left) / box.width - 1, 1 - 2 * (clientY - box.top) / box.height), this.camera);
    return caster.ray;
  }

  /** Where a point in `world` is on the canvas, pixels of the page; null behind the eye. */
  project(point: THREE.Vector3): { x: number; y: number } | null {
    const p = point.clone().project(this.camera);
    if (p.z > 1 || p.z < -1) return null;
    const box = this.canvas.getBoundingClientRect();
    return { x: box.left + (p.x + 1) / 2 * box.width, y: box.top + (1 - p.y) / 2 * box.height };
  }

  private arrange(): void {
    const { showCameras, showVolume, showPath, showNext } = this.look;
    this.depth.visible = showCameras && this.hasRig && this.scan?.depth !== undefined;
    this.depth.matrix.copy(this.rigMatrix);
    this.depth.matrixWorldNeedsUpdate = true;
    (this.depth.material as THREE.LineBasicMaterial).color.set(this.isLost ? 0xff5c5c : 0x4cc2ff);
    this.thermal.visible = showCameras && this.hasRig && this.scan?.thermal !== undefined && this.T_thermal_depth !== undefined;
    if (this.T_thermal_depth) {
      this.thermal.matrix.copy(this.rigMatrix).multiply(matrixOf(this.T_thermal_depth).invert());
      this.thermal.matrixWorldNeedsUpdate = true;
    }
    this.volume.visible = showVolume && this.scan?.volumeMin !== undefined;
    this.path.visible = showPath;
    const hasNext = showNext && this.nextPose !== undefined && this.hasRig;
    this.next.visible = hasNext && this.scan?.depth !== undefined;
    this.arrow.visible = hasNext;
    if (hasNext) {
      this.next.matrix.copy(matrixOf(this.nextPose!));
      this.next.matrixWorldNeedsUpdate = true;
      const from = new THREE.Vector3().setFromMatrixPosition(this.rigMatrix);
      const way = new THREE.Vector3(this.nextPose!.x, this.nextPose!.y, this.nextPose!.z).sub(from);
      const length = way.length();
      this.arrow.visible = length > 0.03;
      this.arrow.position.copy(from);
      this.arrow.setDirection(way.normalize());
      this.arrow.setLength(length, Math.min(0.06, 0.4 * length), Math.min(0.035, 0.2 * length));
    }
    this.invalidate();
  }

  private followTargets(): void {
    this.eye.copy(behind).applyMatrix4(this.rigMatrix);
    this.target.copy(ahead).applyMatrix4(this.rigMatrix);
  }
  private jumpToRig(): void {
    this.followTargets();
    if (!this.look.follow) return;
    this.camera.position.copy(this.eye);
    this.controls.target.copy(this.target);
  }

  private frame(time: number): void {
    const elapsed_s = Math.min(0.1, (time - this.lastFrame) / 1000);
    this.lastFrame = time;
    if (this.look.follow && this.hasRig) {
      this.followTargets();
      const step = 1 - Math.exp(-elapsed_s / 0.35);
      if (this.camera.position.distanceTo(this.eye) > 1e-4 || this.controls.target.distanceTo(this.target) > 1e-4) {
        this.camera.position.lerp(this.eye, step);
        this.controls.target.lerp(this.target, step);
        this.needsFrame = true;
      }
    }
    this.controls.update();
    // Where a frame takes long (no GPU), drawing gets half of the time: messages, buttons and the scan beside it want the rest.
    if (this.drawnAt !== undefined && time - this.drawnAt > slowFrame_ms) this.restUntil = time + (time - this.drawnAt);
    this.drawnAt = undefined;
    if (!this.needsFrame || time < this.restUntil) return;
    this.needsFrame = false;
    this.drawnAt = time;
    const start = performance.now();
    this.renderer.render(this.scene, this.camera);
    this.frameTimes.push(performance.now() - start);
    if (this.frameTimes.length > 120) this.frameTimes.shift();
    this.onFrame();
  }

  private resize(): void {
    const box = this.canvas.parentElement!.getBoundingClientRect();
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.renderer.setSize(Math.max(1, box.width), Math.max(1, box.height), false);
    this.camera.aspect = Math.max(1, box.width) / Math.max(1, box.height);
    this.camera.updateProjectionMatrix();
    this.invalidate();
  }
}
