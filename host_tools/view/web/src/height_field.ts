// A solid from its height map: the stock or the part, in one colour or coloured by the stock left.
import * as THREE from "three";
import type { Stock, Triple } from "./run_data";

const vertexShader = `
in float cell; in float foot; in vec3 side;
uniform highp sampler2D heights; uniform highp sampler2D left;
uniform int nx; uniform int ny; uniform float pitch; uniform float low; uniform float dz;
out vec3 outward; out float shownLeft; out float hole; out float known; out float uncut;
float height(int i, int j) {
  return texelFetch(heights, ivec2(clamp(j, 0, ny - 1), clamp(i, 0, nx - 1)), 0).r;
}
void main() {
  int k = int(cell + 0.5), i = k / ny, j = k - i * ny;
  float z = height(i, j);
  hole = z < -1e29 ? 1.0 : 0.0;
  float over = texelFetch(left, ivec2(j, i), 0).r;
  known = over > -1e29 ? 1.0 : 0.0;
  uncut = over > 1e29 ? 1.0 : 0.0;
  shownLeft = abs(over) < 1e29 ? over : 0.0;
  vec3 slope = vec3(height(i - 1, j) - height(i + 1, j), height(i, j - 1) - height(i, j + 1), 2.0 * pitch);
  outward = dot(side, side) > 0.0 ? side : normalize(slope);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position.xy, foot > 0.5 ? low : z - dz, 1.0);
}`;
const fragmentShader = `
uniform vec3 plain; uniform sampler2D table; uniform float useLeft; uniform float gouge; uniform float scallop;
in vec3 outward; in float shownLeft; in float hole; in float known; in float uncut;
out vec4 colour;
void main() {
  if (hole > 0.01) discard;
  vec3 n = normalize(outward);
  float light = 0.42 + 0.38 * max(dot(n, normalize(vec3(-0.45, -0.55, 0.7))), 0.0) + 0.2 * max(n.z, 0.0);
  vec3 base = plain;
  if (useLeft > 0.5 && known > 0.99) {
    float part = shownLeft < 0.0 ? shownLeft / gouge : shownLeft / scallop;
    base = uncut > 0.5 ? vec3(0.05) : texture(table, vec2(clamp(0.5 + part / 6.0, 0.002, 0.998), 0.5)).rgb;
    light = mix(light, 1.0, 0.35);
  }
  colour = vec4(base * light, 1.0);
}`;

const kNone = -1e30, kFar = 1e30;

function floatTexture(values: Float32Array, width: number, height: number): THREE.DataTexture {
  const texture = new THREE.DataTexture(values, width, height, THREE.RedFormat, THREE.FloatType);
  texture.needsUpdate = true;
  return texture;
}

export class HeightField {
  readonly mesh: THREE.Mesh;
  readonly heights: Float32Array;  // z relative to the centre
  private readonly texture: THREE.DataTexture;
  private readonly material: THREE.ShaderMaterial;

  // foot  z of the lower end
  constructor(private readonly grid: Stock, private readonly centre: Triple, foot: number, table: THREE.Texture, left: Float32Array | null) {
    const { nx, ny, x0, y0, pitch } = grid, size = nx * ny;
    this.heights = new Float32Array(size);
    this.texture = floatTexture(this.heights, ny, nx);
    const leftValues = left ? left.map((v) => Number.isNaN(v) ? kNone : v === Infinity ? kFar : v) : new Float32Array(size).fill(kNone);
    this.material = new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader, fragmentShader, side: THREE.DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2,
      uniforms: {
        heights: { value: this.texture }, left: { value: floatTexture(leftValues, ny, nx) }, table: { value: table },
        nx: { value: nx }, ny: { value: ny }, pitch: { value: pitch }, low: { value: foot - centre[2] }, dz: { value: 0 },
        plain: { value: new THREE.Color(0.6, 0.62, 0.66) }, useLeft: { value: 0 }, gouge: { value: 1 }, scallop: { value: 1 },
      },
    });
    const cells: number[] = [], feet: number[] = [], sides: number[] = [], index: number[] = [];
    for (let k = 0; k < size; ++k) { cells.push(k); feet.push(0); sides.push(0, 0, 0); }
    for (let i = 0; i + 1 < nx; ++i) {
      for (let j = 0; j + 1 < ny; ++j) {
        const a = i * ny + j, b = a + ny;
        index.push(a, b, b + 1, a, b + 1, a + 1);
      }
    }
    const wall = (border: number[], x: number, y: number) => {
      border.forEach((k, n) => {
        const at = cells.length;
        cells.push(k, k); feet.push(0, 1); sides.push(x, y, 0, x, y, 0);
        if (n > 0) index.push(at - 2, at, at + 1, at - 2, at + 1, at - 1);
      });
    };
    const range = (count: number, at: (n: number) => number) => Array.from({ length: count }, (_, n) => at(n));
    wall(range(ny, (j) => j), -1, 0);
    wall(range(ny, (j) => (nx - 1) * ny + j), 1, 0);
    wall(range(nx, (i) => i * ny), 0, -1);
    wall(range(nx, (i) => i * ny + ny - 1), 0, 1);
    const places = new Float32Array(3 * cells.length);
    cells.forEach((k, n) => {
      places[3 * n] = x0 + Math.floor(k / ny) * pitch - centre[0];
      places[3 * n + 1] = y0 + k % ny * pitch - centre[1];
    });
    const geometry = new THREE.BufferGeometry()
      .setAttribute("position", new THREE.BufferAttribute(places, 3))
      .setAttribute("cell", new THREE.Float32BufferAttribute(cells, 1))
      .setAttribute("foot", new THREE.Float32BufferAttribute(feet, 1))
      .setAttribute("side", new THREE.Float32BufferAttribute(sides, 3));
    geometry.setIndex(index);
    this.mesh = new THREE.Mesh(geometry, this.material);
    this.mesh.frustumCulled = false;
  }

  // Sets z of each point; NaN: none.
  set(z: (k: number) => number): void {
    for (let k = 0; k < this.heights.length; ++k) {
      const value = z(k);
      this.heights[k] = Number.isNaN(value) ? kNone : value - this.centre[2];
    }
    this.changed();
  }
  changed(): void { this.texture.needsUpdate = true; }

  // Limits of gouge and stock left, mm; null: one colour.
  showLeft(bounds: { gouge: number; scallop: number } | null): void {
    const { uniforms } = this.material;
    uniforms.useLeft.value = bounds ? 1 : 0;
    if (bounds) [uniforms.gouge.value, uniforms.scallop.value] = [bounds.gouge, bounds.scallop];
  }
  set plain(colour: THREE.Color) { (this.material.uniforms.plain.value as THREE.Color).copy(colour); }
  get size(): [number, number] { return [this.grid.nx, this.grid.ny]; }
}
