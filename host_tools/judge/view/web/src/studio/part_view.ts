// The part and its stock in space, before anything is planned: triangles, the box of the stock, the axes at the origin.
import { signal } from "@preact/signals";
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Stock } from "../engine/engine";
import { isDark } from "../frame";
import { backgroundOf, rendererOn, sizeOf } from "../renderer";

/** Of the part as its file has it, nine numbers a triangle, mm. */
export const partFacets = signal<Float32Array | null>(null);

// The stock's box, which is the part's where the job has no other; null: nothing is known of it.
function boxOf({ x, y, top, bottom }: Stock, part: THREE.Box3): THREE.Box3 | null {
  if (part.isEmpty() && (!x || !y)) return null;
  const [x0, x1] = x ?? [part.min.x, part.max.x], [y0, y1] = y ?? [part.min.y, part.max.y];
  return new THREE.Box3(new THREE.Vector3(x0, y0, bottom ?? Math.min(part.isEmpty() ? top : part.min.z, top)), new THREE.Vector3(x1, y1, top));
}

export class PartView {
  private readonly renderer: THREE.WebGLRenderer;
  private readonly camera = new THREE.OrthographicCamera();
  private readonly controls: OrbitControls;
  private readonly world = new THREE.Scene();
  private readonly part = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshLambertMaterial({ side: THREE.DoubleSide, flatShading: true }));
  private readonly stock = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial());
  private readonly axes = new THREE.AxesHelper(1);
  private asked = false;

  /** Throws without WebGL. */
  constructor(private readonly host: HTMLElement, canvas: HTMLCanvasElement) {
    this.renderer = rendererOn(canvas);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(-0.55, -0.75, 0.62);
    const light = new THREE.DirectionalLight(0xffffff, 2.2), back = new THREE.DirectionalLight(0xffffff, 0.7);
    light.position.set(-0.4, -0.6, 1);
    back.position.set(0.6, 0.8, 0.4);
    this.world.add(light, back, new THREE.AmbientLight(0xffffff, 0.9), this.part, this.stock, this.axes);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.ask());
    new ResizeObserver(() => this.ask()).observe(host);
  }

  show(facets: Float32Array | null, stock: Stock | null): void {
    this.part.geometry.dispose();
    this.stock.geometry.dispose();
    this.part.geometry = new THREE.BufferGeometry();
    this.stock.geometry = new THREE.BufferGeometry();
    const all = new THREE.Box3();
    if (facets && facets.length > 0) {
      this.part.geometry.setAttribute("position", new THREE.BufferAttribute(facets, 3));
      this.part.geometry.computeBoundingBox();
      all.copy(this.part.geometry.boundingBox!);
    }
    const box = stock ? boxOf(stock, all) : null;
    if (box) {
      const size = box.getSize(new THREE.Vector3());
      this.stock.geometry = new THREE.EdgesGeometry(new THREE.BoxGeometry(size.x, size.y, size.z));
      box.getCenter(this.stock.position);
      all.union(box);
    }
    this.axes.visible = !all.isEmpty();
    if (!all.isEmpty()) this.frame(all);
    this.ask();
  }

  private frame(box: THREE.Box3): void {
    const extent = Math.max(box.getSize(new THREE.Vector3()).length(), 1e-3), from = this.camera.position.clone().sub(this.controls.target).normalize();
    box.getCenter(this.controls.target);
    this.camera.position.copy(this.controls.target).addScaledVector(from, 4 * extent);
    [this.camera.near, this.camera.far] = [-20 * extent, 20 * extent];
    [this.camera.top, this.camera.bottom] = [extent * 0.55, -extent * 0.55];
    this.axes.scale.setScalar(extent * 0.12);
    this.camera.zoom = 1;
    this.controls.update();
  }

  ask(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.draw();
    });
  }

  private draw(): void {
    const { width, height } = sizeOf(this.renderer.domElement), now = this.renderer.getSize(new THREE.Vector2());
    if (!this.host.isConnected) return;
    if (now.x !== width || now.y !== height) this.renderer.setSize(width, height, false);
    [this.camera.left, this.camera.right] = [this.camera.bottom * width / height, this.camera.top * width / height];
    this.camera.updateProjectionMatrix();
    const dark = isDark();
    this.world.background = backgroundOf(dark);
    this.part.material.color.set(dark ? 0x7d92ab : 0x8fa6bf);
    this.stock.material.color.set(dark ? 0xd8b25a : 0x9a6c00);
    this.renderer.render(this.world, this.camera);
  }

  close(): void {
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }
}
