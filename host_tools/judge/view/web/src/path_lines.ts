// The path as lines: levels of detail, coloured by a value of each vertex; and picking.
import * as THREE from "three";
import type { Timeline } from "./timeline";
import type { Triple } from "./run_data";
import { upperBound } from "./run_data";

const vertexShader = `
in float tick; in float value;
uniform float cursor; uniform float recent;
out float shownValue; out float ahead; out float old;
void main() {
  shownValue = value;
  ahead = tick > cursor ? 1.0 : 0.0;
  old = tick < cursor - recent ? 1.0 : 0.0;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;
const fragmentShader = `
uniform sampler2D table; uniform vec3 plain; uniform float usePlain; uniform float strength; uniform float strengthAhead; uniform float calm;
in float shownValue; in float ahead; in float old;
out vec4 colour;
void main() {
  vec3 scaled = texture(table, vec2((shownValue * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  colour = vec4(mix(scaled, plain, usePlain), mix(strength * mix(1.0, calm, step(0.5, old)), strengthAhead * calm, step(0.5, ahead)));
}`;

const kLevels = 10;
const kFinest = 0.001;  // mm: deviation of level 0; four times more at each further level
const kRecent = 10_000;  // ticks: the last ten seconds stay bright on a shaded stock
const kCalm = 0.25;
const kMostWhileMoving = 150000, kMostAtRest = 1200000;

export function pathMaterial(rapid: number, table: THREE.Texture | null): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3, vertexShader, fragmentShader, transparent: true, depthWrite: false,
    uniforms: {
      cursor: { value: 0 }, table: { value: table }, plain: { value: new THREE.Color(0.5, 0.5, 0.5) },
      usePlain: { value: rapid }, strength: { value: rapid ? 0.55 : 1 }, strengthAhead: { value: rapid ? 0.3 : 0.35 },
      recent: { value: kRecent }, calm: { value: 1 },
    },
  });
}

export class PathLines {
  readonly group = new THREE.Group();
  private readonly values: THREE.BufferAttribute;
  private readonly geometries: THREE.BufferGeometry[];
  private readonly materials: THREE.ShaderMaterial[];
  private readonly indices: (THREE.BufferAttribute[] | null)[] = new Array<null>(kLevels).fill(null);
  private readonly counts = new Array<number>(kLevels).fill(0);
  readonly rapidVertex: Uint8Array;
  private level = -1;

  constructor(private readonly timeline: Timeline, centre: Triple, table: THREE.Texture) {
    const { run } = timeline, count = run.vertexTick.length;
    const places = new Float32Array(3 * count), ticks = new Float32Array(count);
    this.rapidVertex = new Uint8Array(count);
    for (let k = 0; k < count; ++k) {
      const tick = run.vertexTick[k];
      for (let c = 0; c < 3; ++c) places[3 * k + c] = (run.axes[c][tick] + run.origin[c]) * 1e-6 - centre[c];
      ticks[k] = tick;
      ++this.counts[run.vertexLevel[k]];
    }
    for (let level = kLevels - 2; level >= 0; --level) this.counts[level] += this.counts[level + 1];
    for (let k = 0, r = 0; k < count; ++k) {  // both ascend: one pass
      while (run.runStart[r + 1] < run.vertexTick[k]) ++r;
      this.rapidVertex[k] = run.rapid[run.runLine[r]] ?? 0;
    }
    this.values = new THREE.BufferAttribute(new Uint8Array(count), 1, true);
    const position = new THREE.BufferAttribute(places, 3), tick = new THREE.BufferAttribute(ticks, 1);
    this.geometries = [0, 1].map(() => new THREE.BufferGeometry().setAttribute("position", position)
      .setAttribute("tick", tick).setAttribute("value", this.values));
    this.materials = [0, 1].map((rapid) => pathMaterial(rapid, table));
    this.geometries.forEach((geometry, k) => {
      const lines = new THREE.LineSegments(geometry, this.materials[k]);
      lines.frustumCulled = false;
      lines.renderOrder = 2;
      this.group.add(lines);
    });
  }

  set cursor(tick: number) { for (const material of this.materials) material.uniforms.cursor.value = tick; }
  set rapids(on: boolean) { this.group.children[1].visible = on; }
  // Leaves the shaded stock to be seen: what was cut earlier is dim.
  set calm(on: boolean) { for (const material of this.materials) material.uniforms.calm.value = on ? kCalm : 1; }
  // Dims the path while surfaces are coloured.
  set faint(on: boolean) {
    this.materials[0].uniforms.strength.value = on ? 0.12 : 1;
    this.materials[0].uniforms.strengthAhead.value = on ? 0.06 : 0.35;
    this.materials[1].uniforms.strength.value = on ? 0.12 : 0.55;
  }
  set plain(colour: THREE.Color) { (this.materials[1].uniforms.plain.value as THREE.Color).copy(colour); }

  // value: fraction of the scale, 0 to 1, of each vertex.
  colour(value: (vertex: number) => number): void {
    const array = this.values.array as Uint8Array;
    for (let k = 0; k < array.length; ++k) array[k] = Math.min(Math.max(value(k), 0), 1) * 255;
    this.values.needsUpdate = true;
  }

  // Selects the coarsest lines that are exact to half a pixel, or those that can be drawn in time.
  refine(millimetresPerPixel: number, moving: boolean): void {
    let level = 0;
    while (level < kLevels - 1 && kFinest * 4 ** (level + 1) < millimetresPerPixel / 2) ++level;
    const most = moving ? kMostWhileMoving : kMostAtRest;
    while (level < kLevels - 1 && this.counts[level] > most) ++level;
    if (level === this.level) return;
    this.level = level;
    const [cuts, rapids] = this.indices[level] ??= this.indexOf(level);
    this.geometries[0].setIndex(cuts);
    this.geometries[1].setIndex(rapids);
  }

  private indexOf(level: number): THREE.BufferAttribute[] {
    const { vertexLevel } = this.timeline.run;
    const out = [new Uint32Array(2 * this.counts[level]), new Uint32Array(2 * this.counts[level])], used = [0, 0];
    for (let k = 1, last = 0; k < vertexLevel.length; ++k) {
      if (vertexLevel[k] < level) continue;
      const kind = this.rapidVertex[k];
      out[kind][used[kind]++] = last;
      out[kind][used[kind]++] = k;
      last = k;
    }
    return out.map((array, kind) => new THREE.BufferAttribute(array.slice(0, used[kind]), 1));
  }

  // The tick whose point is drawn nearest to a pixel, within `reach` pixels. Of about equally near ones, the one at the
  // cursor, then the one in front. `toPixels` returns x, y and depth.
  tickAt(px: number, py: number, reach: number, toPixels: (place: Triple) => Triple): number | null {
    const { run } = this.timeline, { vertexTick } = run;
    const hits: { begin: number; end: number }[] = [];
    const first = toPixels(this.timeline.place(0));
    for (let k = 1, ax = first[0], ay = first[1]; k < vertexTick.length; ++k) {
      const [bx, by] = toPixels(this.timeline.place(vertexTick[k]));
      if (distanceToChord(px, py, ax, ay, bx, by) <= reach) hits.push({ begin: vertexTick[k - 1], end: vertexTick[k] });
      ax = bx;
      ay = by;
    }
    let best: { tick: number; rank: number; depth: number } | null = null;
    const kAlike = 1.5;  // pixels
    const onCursor = this.timeline.lineOf(this.timeline.tick);
    for (const { begin, end } of hits) {
      let near = Infinity, at = begin, depth = 0;
      const step = Math.max(1, Math.floor((end - begin) / 256));
      for (let tick = begin + 1; tick <= end; tick += step) {
        const [x, y, z] = toPixels(this.timeline.place(tick));
        const away = Math.hypot(x - px, y - py);
        if (away < near) [near, at, depth] = [away, tick, z];
      }
      if (this.timeline.tick > begin && this.timeline.tick <= end) {
        const [x, y, z] = toPixels(this.timeline.place(this.timeline.tick));
        const away = Math.hypot(x - px, y - py);
        if (away <= near + kAlike) [near, at, depth] = [away, this.timeline.tick, z];
      }
      const rank = Math.floor(near / kAlike) - (this.timeline.lineOf(at) === onCursor ? 0.5 : 0);
      if (near <= reach + kAlike && (!best || rank < best.rank || rank === best.rank && depth < best.depth)) best = { tick: at, rank, depth };
    }
    return best?.tick ?? null;
  }

  // The vertex at or after a tick.
  vertexAfter(tick: number): number {
    return Math.min(upperBound(this.timeline.run.vertexTick, tick - 1), this.timeline.run.vertexTick.length - 1);
  }
}

function distanceToChord(px: number, py: number, ax: number, ay: number, bx: number, by: number): number {
  const x = bx - ax, y = by - ay, square = x * x + y * y;
  const share = square > 0 ? Math.min(Math.max(((px - ax) * x + (py - ay) * y) / square, 0), 1) : 0;
  return Math.hypot(px - ax - share * x, py - ay - share * y);
}
