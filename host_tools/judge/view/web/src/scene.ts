// The scene: path, stock, part and tool in parallel projection; drawn after each change.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { FieldDetail, HeightField, leftTexture } from "./height_field";
import { PathLines } from "./path_lines";
import { backgroundOf, drawsInSoftware, sizeOf } from "./renderer";
import { StockAtCursor } from "./stock_at_cursor";
import { toolAt, toolGeometry, toolLights, toolMaterial } from "./tool_shape";
import type { Timeline } from "./timeline";
import type { Triple } from "./run_data";
import type { ScaleName } from "./colours";
import { scaleTable } from "./colours";

// Direction and up vector of the views 1 to 7.
const views: [Triple, Triple][] = [
  [[-0.55, -0.75, 0.62], [0, 0, 1]], [[0, 0, 1], [0, 1, 0]], [[0, -1, 0], [0, 0, 1]], [[0, 1, 0], [0, 0, 1]],
  [[-1, 0, 0], [0, 0, 1]], [[1, 0, 0], [0, 0, 1]], [[0, 0, -1], [0, 1, 0]],
];
export const viewNames = ["Corner", "Top", "Front", "Back", "Left", "Right", "Below"];

// Box of the path, and of the stock if there is one.
function boxOf({ run }: Timeline): THREE.Box3 {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let c = 0; c < 3; ++c) {
    const places = run.axes[c];
    for (const tick of run.vertexTick) {
      if (places[tick] < low[c]) low[c] = places[tick];
      if (places[tick] > high[c]) high[c] = places[tick];
    }
  }
  const point = (at: number[]) => new THREE.Vector3().fromArray(at.map((nm, c) => (nm + run.origin[c]) * 1e-6));
  const box = new THREE.Box3(point(low), point(high));
  if (run.stock) {
    const { x0, y0, nx, ny, pitch, low: foot, high: top } = run.stock;
    box.expandByPoint(new THREE.Vector3(x0, y0, foot)).expandByPoint(new THREE.Vector3(x0 + nx * pitch, y0 + ny * pitch, top));
  }
  return box;
}

export interface Shown { stock: boolean; part: boolean; path: boolean; rapids: boolean; tool: boolean }

export class Scene {
  readonly path: PathLines;
  shown: Shown;
  private readonly box: THREE.Box3;
  private readonly camera = new THREE.OrthographicCamera();
  private readonly controls: OrbitControls;
  private readonly world = new THREE.Scene();
  private readonly centre: Triple;
  private readonly extent: number;
  private readonly pathTable = new THREE.DataTexture(new Uint8Array(1024), 256, 1);
  private readonly leftTable = new THREE.DataTexture(new Uint8Array(1024), 256, 1);
  private readonly stock: HeightField | null = null;
  private readonly part: HeightField | null = null;
  private readonly detail: FieldDetail | null = null;
  private readonly cutting: StockAtCursor | null = null;
  private readonly tool = new THREE.Mesh(undefined, toolMaterial());
  private readonly place = new THREE.Mesh(new THREE.TorusGeometry(1, 0.12, 8, 40), new THREE.MeshBasicMaterial({ color: 0xff00aa, depthTest: false }));
  private toolNumber = NaN;
  private asked = false;
  private movedAt = -1e9;
  private readonly drawn: { done: () => void; roughly: boolean }[] = [];
  private readonly slow: boolean;  // no hardware draws

  constructor(private readonly renderer: THREE.WebGLRenderer, private readonly timeline: Timeline) {
    const { run } = timeline;
    this.slow = drawsInSoftware(renderer);
    this.box = boxOf(timeline);
    this.centre = this.box.getCenter(new THREE.Vector3()).toArray();
    this.extent = Math.max(this.box.getSize(new THREE.Vector3()).length(), 1e-3);
    this.shown = { stock: run.stock !== null, part: false, path: true, rapids: true, tool: true };
    this.path = new PathLines(timeline, this.centre, this.pathTable);
    this.world.add(this.path.group);
    if (run.stock && run.left) {
      const foot = run.stock.low - 0.04 * Math.max(this.extent, 1) - this.centre[2];
      const left = leftTexture(run.stock, run.left.left), { geometry } = this.detail = new FieldDetail(run.stock, this.centre);
      this.stock = new HeightField(run.stock, foot, geometry, this.leftTable, left);
      this.part = new HeightField(run.stock, foot, geometry, this.leftTable, left);
      this.part.set(run.left.part, this.centre[2]);
      this.cutting = new StockAtCursor(timeline, run.stock, this.stock, this.centre[2]);
      this.world.add(this.stock.mesh, this.part.mesh);
    }
    this.world.add(...toolLights(), this.tool, this.place);
    this.tool.renderOrder = 3;
    this.place.visible = false;
    this.place.renderOrder = 4;
    this.camera.near = -20 * this.extent;
    this.camera.far = 20 * this.extent;
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", () => this.moved());
    const bounds = this.leftBounds();
    if (bounds) this.part?.showLeft(bounds);
    timeline.onChange(() => this.ask());
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement!);
    this.resize();
    this.view(0);
  }

  private get canvas(): HTMLCanvasElement { return this.renderer.domElement; }

  // mm: limits of gouge and stock left.
  leftBounds(): { gouge: number; scallop: number } | null {
    const v = this.timeline.facts.verification;
    if (!v || !this.timeline.run.left) return null;
    const scallop = v.scallop_bound_mm ?? Math.max(v.scallop_p99_mm, 1e-3);
    return { gouge: v.floor_tolerance > 0 ? v.floor_tolerance : scallop, scallop };
  }

  // Sets the colours of path and surfaces.
  dress(scale: ScaleName, look: { dark: boolean; safe: boolean }, left: boolean): void {
    this.pathTable.image.data!.set(scaleTable(scale, look));
    this.leftTable.image.data!.set(scaleTable("left", look));
    this.pathTable.needsUpdate = this.leftTable.needsUpdate = true;
    this.world.background = backgroundOf(look.dark);
    this.path.plain = new THREE.Color(look.dark ? 0x9aa3ad : 0x77808a);
    if (this.stock && this.part) {
      this.stock.plain = new THREE.Color(look.dark ? 0x7d8794 : 0xc9d0d8);
      this.part.plain = new THREE.Color(look.dark ? 0x6f8398 : 0xb9cadb);
      this.stock.showLeft(left ? this.leftBounds() : null);
    }
    (this.tool.material).color.set(look.dark ? 0xd8b25a : 0xc8952c);
    this.path.faint = left;
    this.ask();
  }

  view(k: number): void {
    const [from, up] = views[k];
    this.controls.target.set(0, 0, 0);
    this.camera.zoom = 1;
    this.look(from, up);
    this.fit();
  }

  private look(from: Triple, up: Triple): void {
    this.camera.up.set(...up);
    this.camera.position.copy(this.controls.target).addScaledVector(new THREE.Vector3(...from).normalize(), 4 * this.extent);
    this.camera.lookAt(this.controls.target);
    this.controls.update();
    this.moved();
  }

  // Zooms so that the box fills the canvas.
  fit(): void {
    const box = this.box.clone().translate(new THREE.Vector3(...this.centre).negate());
    this.camera.updateMatrixWorld();
    const shape = new THREE.Box3();
    for (let k = 0; k < 8; ++k) {
      shape.expandByPoint(new THREE.Vector3(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z)
        .applyMatrix4(this.camera.matrixWorldInverse));
    }
    const size = shape.getSize(new THREE.Vector3());
    const width = this.camera.right - this.camera.left, height = this.camera.top - this.camera.bottom;
    this.camera.zoom = 0.9 * Math.min(width / Math.max(size.x, 1e-6), height / Math.max(size.y, 1e-6));
    this.camera.updateProjectionMatrix();
    this.moved();
  }

  // Turns the view around the target, radians.
  turn(aside: number, up: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target), z = new THREE.Vector3(0, 0, 1);
    offset.applyAxisAngle(z, aside);
    const across = new THREE.Vector3().crossVectors(offset, z);
    const tilted = across.lengthSq() > 1e-9 ? offset.clone().applyAxisAngle(across.normalize(), up) : offset;
    if (Math.hypot(tilted.x, tilted.y) > 0.02 * tilted.length()) offset.copy(tilted);
    this.look(offset.toArray(), [0, 0, 1]);
  }

  zoom(factor: number): void {
    this.camera.zoom *= factor;
    this.camera.updateProjectionMatrix();
    this.moved();
  }

  // Moves the view to a point and marks it.
  flyTo(at: Triple): void {
    const target = new THREE.Vector3(...at).sub(new THREE.Vector3(...this.centre));
    const from = this.controls.target.clone(), zoom = this.camera.zoom;
    const near = Math.max(zoom, 12), direction = this.camera.position.clone().sub(from);
    this.place.position.copy(target);
    this.place.visible = true;
    const start = performance.now(), length = matchMedia("(prefers-reduced-motion: reduce)").matches ? 1 : 500;
    const step = () => {
      const share = Math.min((performance.now() - start) / length, 1), eased = share * share * (3 - 2 * share);
      this.controls.target.lerpVectors(from, target, eased);
      this.camera.position.copy(this.controls.target).add(direction);
      this.camera.zoom = zoom * (near / zoom) ** eased;
      this.camera.updateProjectionMatrix();
      this.controls.update();
      this.moved();
      if (share < 1) requestAnimationFrame(step);
    };
    step();
  }

  private resize(): void {
    const { width, height } = sizeOf(this.canvas), ratio = Math.min(devicePixelRatio, 2), now = this.renderer.getSize(new THREE.Vector2());
    if (now.x !== width || now.y !== height || this.renderer.getPixelRatio() !== ratio) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
    }
    const half = this.extent / 2;
    [this.camera.left, this.camera.right] = [-half * width / height, half * width / height];
    [this.camera.top, this.camera.bottom] = [half, -half];
    this.camera.updateProjectionMatrix();
    this.ask();
  }

  get millimetresPerPixel(): number {
    return (this.camera.top - this.camera.bottom) / this.camera.zoom / Math.max(this.canvas.clientHeight, 1);
  }

  private moved(): void {
    this.movedAt = performance.now();
    this.ask();
    setTimeout(() => this.ask(), 300);  // at full detail once the view is at rest
  }

  ask(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.draw();
    });
  }

  // Resolves when the present state is drawn. roughly: in software, solids may be at half detail, until 300 ms later.
  whenDrawn(roughly = false): Promise<void> {
    return new Promise((done) => {
      this.drawn.push({ done, roughly });
      this.ask();
    });
  }

  private draw(): void {
    const moving = this.timeline.playing || performance.now() - this.movedAt < 250;
    if (this.detail) {
      const halved = this.slow && this.drawn.every(({ roughly }) => roughly) && (moving || this.drawn.length > 0);
      this.detail.halved = halved;
      if (halved) setTimeout(() => this.ask(), 300);
    }
    this.path.refine(this.millimetresPerPixel * (moving ? 2 : 1), moving);
    this.path.cursor = this.timeline.tick;
    this.path.group.visible = this.shown.path;
    this.path.rapids = this.shown.rapids;
    this.path.calm = this.stock !== null && this.shown.stock;
    if (this.stock && this.part) {
      this.stock.mesh.visible = this.shown.stock;
      this.part.mesh.visible = this.shown.part;
      if (this.shown.stock) this.cutting!.update();
    }
    this.placeTool();
    this.place.quaternion.copy(this.camera.quaternion);
    this.place.scale.setScalar(9 * this.millimetresPerPixel);
    this.renderer.render(this.world, this.camera);
    for (const { done } of this.drawn.splice(0)) done();
  }

  private placeTool(): void {
    const cutter = toolAt(this.timeline, this.timeline.tick), number = cutter?.number ?? -1;
    if (number !== this.toolNumber) {
      this.toolNumber = number;
      this.tool.geometry.dispose();
      this.tool.geometry = toolGeometry(cutter, this.extent);
    }
    const place = this.timeline.place(this.timeline.tick);
    this.tool.position.set(place[0] - this.centre[0], place[1] - this.centre[1], place[2] - this.centre[2]);
    this.tool.visible = this.shown.tool;
  }

  // Returns the projection of points in mm to page pixels and depth; one matrix serves many points.
  toPixels(): (at: Triple) => Triple {
    this.camera.updateMatrixWorld();
    const m = new THREE.Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse).elements;
    const box = this.canvas.getBoundingClientRect(), [cx, cy, cz] = this.centre;
    const left = box.left + scrollX, top = box.top + scrollY;
    return ([px, py, pz]) => {
      const x = px - cx, y = py - cy, z = pz - cz;
      return [
        left + (m[0] * x + m[4] * y + m[8] * z + m[12] + 1) / 2 * box.width,
        top + (1 - (m[1] * x + m[5] * y + m[9] * z + m[13])) / 2 * box.height,
        m[2] * x + m[6] * y + m[10] * z + m[14],
      ];
    };
  }
}
