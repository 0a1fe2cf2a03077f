// A solid from its height map: the stock or the part, in one colour or coloured by the stock left.
import * as THREE from "three";
import type { Stock, Triple } from "./run_data";

const vertexShader = `
in float cell; in float foot; in vec3 side;
uniform highp sampler2D heights; uniform highp sampler2D left;
uniform int nx; uniform int ny; uniform float pitch; uniform float low; uniform float dz;
out vec3 outward; out float shownLeft; out float hole; out float known; out float uncut; out vec3 place; out vec2 at; out float border;
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
  border = dot(side, side);
  at = vec2(float(i), float(j));
  place = vec3(position.xy, foot > 0.5 ? low : z - dz);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(place, 1.0);
}`;
const fragmentShader = `
uniform vec3 plain; uniform sampler2D table; uniform float useLeft; uniform float gouge; uniform float scallop;
uniform highp sampler2D heights; uniform int nx; uniform int ny; uniform float pitch;
in vec3 outward; in float shownLeft; in float hole; in float known; in float uncut; in vec3 place; in vec2 at; in float border;
out vec4 colour;
float height(ivec2 cell) { return max(texelFetch(heights, ivec2(clamp(cell.y, 0, ny - 1), clamp(cell.x, 0, nx - 1)), 0).r, -1e4); }
// The way a wall faces, from heights some cells away: between two cells it would change from triangle to triangle.
vec3 wall() {
  const int k = 4;
  ivec2 cell = ivec2(at + 0.5);
  vec2 fall = vec2(height(cell - ivec2(k, 0)) - height(cell + ivec2(k, 0)), height(cell - ivec2(0, k)) - height(cell + ivec2(0, k)));
  return normalize(vec3(fall, 0.2 * pitch));
}
void main() {
  if (hole > 0.01) discard;
  vec3 n = normalize(outward), facet = cross(dFdx(place), dFdy(place));
  float level = abs(facet.z) / max(length(facet), 1e-20);
  if (border < 0.5 && level < 0.45) n = normalize(mix(wall(), n, smoothstep(0.25, 0.45, level)));
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

// The stock that is left, by cells, for HeightField.
export function leftTexture({ nx, ny }: Stock, left: Float32Array): THREE.DataTexture {
  return floatTexture(left.map((v) => Number.isNaN(v) ? kNone : v === Infinity ? kFar : v), ny, nx);
}

export function fieldMaterial(): THREE.ShaderMaterial {
  const uniforms: Record<string, THREE.IUniform> = {
    heights: { value: null }, left: { value: null }, table: { value: null },
    nx: { value: 1 }, ny: { value: 1 }, pitch: { value: 1 }, low: { value: 0 }, dz: { value: 0 },
    plain: { value: new THREE.Color(0.6, 0.62, 0.66) }, useLeft: { value: 0 }, gouge: { value: 1 }, scallop: { value: 1 },
  };
  return new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3, vertexShader, fragmentShader, uniforms, side: THREE.DoubleSide,
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2,
  });
}

// Top and walls of any solid on this grid; the shader adds the heights. The cells' points come first, then two for each
// cell of the border.
function fieldGeometry({ nx, ny, x0, y0, pitch }: Stock, centre: Triple): THREE.BufferGeometry {
  const size = nx * ny, points = size + 4 * (nx + ny);
  const places = new Float32Array(3 * points), cells = new Float32Array(points), feet = new Float32Array(points), sides = new Float32Array(3 * points);
  const index = new Uint32Array(6 * ((nx - 1) * (ny - 1) + 2 * (nx - 1) + 2 * (ny - 1)));
  let used = 0;
  const triangles = (a: number, b: number, c: number, d: number, e: number, f: number) => {
    index[used++] = a; index[used++] = b; index[used++] = c;
    index[used++] = d; index[used++] = e; index[used++] = f;
  };
  const put = (at: number, i: number, j: number) => {
    cells[at] = i * ny + j;
    places[3 * at] = x0 + i * pitch - centre[0];
    places[3 * at + 1] = y0 + j * pitch - centre[1];
  };
  for (let i = 0; i < nx; ++i) {
    for (let j = 0; j < ny; ++j) {
      const a = i * ny + j, b = a + ny;
      put(a, i, j);
      if (i + 1 < nx && j + 1 < ny) triangles(a, b, b + 1, a, b + 1, a + 1);
    }
  }
  let at = size;
  const wall = (count: number, i0: number, j0: number, along: 0 | 1, x: number, y: number) => {
    for (let n = 0; n < count; ++n, at += 2) {
      for (let foot = 0; foot < 2; ++foot) {
        put(at + foot, along ? i0 : i0 + n, along ? j0 + n : j0);
        feet[at + foot] = foot;
        sides[3 * (at + foot)] = x;
        sides[3 * (at + foot) + 1] = y;
      }
      if (n > 0) triangles(at - 2, at, at + 1, at - 2, at + 1, at - 1);
    }
  };
  wall(ny, 0, 0, 1, -1, 0);
  wall(ny, nx - 1, 0, 1, 1, 0);
  wall(nx, 0, 0, 0, 0, -1);
  wall(nx, 0, ny - 1, 0, 0, 1);
  return new THREE.BufferGeometry()
    .setAttribute("position", new THREE.BufferAttribute(places, 3))
    .setAttribute("cell", new THREE.BufferAttribute(cells, 1))
    .setAttribute("foot", new THREE.BufferAttribute(feet, 1))
    .setAttribute("side", new THREE.BufferAttribute(sides, 3))
    .setIndex(new THREE.BufferAttribute(index, 1));
}

// The triangles of every second row and column, and the walls: a quarter of the work.
function halfIndex(whole: THREE.BufferAttribute, { nx, ny }: Stock): THREE.BufferAttribute {
  const walls = whole.array.subarray(6 * (nx - 1) * (ny - 1)), rows = Math.ceil((nx - 1) / 2), columns = Math.ceil((ny - 1) / 2);
  const index = new Uint32Array(6 * rows * columns + walls.length);
  let used = 0;
  for (let i = 0; i + 1 < nx; i += 2) {
    for (let j = 0; j + 1 < ny; j += 2) {
      const i1 = Math.min(i + 2, nx - 1), j1 = Math.min(j + 2, ny - 1);
      for (const k of [i * ny + j, i1 * ny + j, i1 * ny + j1, i * ny + j, i1 * ny + j1, i * ny + j1]) index[used++] = k;
    }
  }
  index.set(walls, used);
  return new THREE.BufferAttribute(index, 1);
}

// Geometry of a grid in whole and half detail.
export class FieldDetail {
  readonly geometry: THREE.BufferGeometry;
  private readonly whole: THREE.BufferAttribute;
  private half: THREE.BufferAttribute | null = null;
  constructor(private readonly grid: Stock, centre: Triple) {
    this.geometry = fieldGeometry(grid, centre);
    this.whole = this.geometry.getIndex()!;
  }
  set halved(on: boolean) {
    this.geometry.setIndex(on ? this.half ??= halfIndex(this.whole, this.grid) : this.whole);
  }
}

export class HeightField {
  readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>;
  readonly heights: Float32Array;  // z relative to the centre
  private readonly texture: THREE.DataTexture;

  // foot  z of the lower end, relative to the centre, mm
  constructor({ nx, ny, pitch }: Stock, foot: number, geometry: THREE.BufferGeometry, table: THREE.Texture, left: THREE.Texture) {
    this.heights = new Float32Array(nx * ny);
    this.texture = floatTexture(this.heights, ny, nx);
    this.mesh = new THREE.Mesh(geometry, fieldMaterial());
    this.mesh.frustumCulled = false;
    const values = { heights: this.texture, left, table, nx, ny, pitch, low: foot };
    for (const [name, value] of Object.entries(values)) this.mesh.material.uniforms[name].value = value;
  }

  changed(): void { this.texture.needsUpdate = true; }

  // Limits of gouge and stock left, mm; null: one colour.
  showLeft(bounds: { gouge: number; scallop: number } | null): void {
    const { uniforms } = this.mesh.material;
    uniforms.useLeft.value = bounds ? 1 : 0;
    if (bounds) [uniforms.gouge.value, uniforms.scallop.value] = [bounds.gouge, bounds.scallop];
  }
  set plain(colour: THREE.Color) { (this.mesh.material.uniforms.plain.value as THREE.Color).copy(colour); }

  // Sets z of each point; NaN: none.
  set(z: Float32Array, centre: number): void {
    for (let k = 0; k < z.length; ++k) this.heights[k] = Number.isNaN(z[k]) ? kNone : z[k] - centre;
    this.changed();
  }
}
