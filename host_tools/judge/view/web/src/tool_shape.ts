// The tool in its true shape; a thin pointer where its shape is unknown.
import * as THREE from "three";
import type { Timeline } from "./timeline";
import type { ToolFacts } from "./run_data";

export type Cutter = ToolFacts & { shape: "ball" | "flat" | "bull" | "vee" | "drill" | "taper"; radius: number; corner_radius: number };

const isCutter = (tool: ToolFacts | undefined): tool is Cutter => tool?.radius !== undefined && tool.corner_radius !== undefined;

// The tool in the spindle; before the first T word, the first.
export function toolAt(timeline: Timeline, tick: number): Cutter | null {
  const { tools } = timeline.facts, number = timeline.sectionOf(timeline.lineOf(tick)).tool;
  const tool = tools.find((t) => t.number === number) ?? tools[0];
  return isCutter(tool) ? tool : null;
}

// Height of the lower side above the tip, at the distance `away` from the axis.
export function profileOf(tool: Cutter, away: number): number {
  const corner = tool.corner_radius, half = (tool.tip_angle ?? 0) / 2;
  const beyond = Math.max(0, away - (half ? tool.tip_radius ?? 0 : tool.radius - corner));
  if (half && beyond >= corner * Math.cos(half)) return corner * (1 - Math.sin(half)) + (beyond - corner * Math.cos(half)) / Math.tan(half);
  return corner - Math.sqrt(Math.max(0, corner * corner - beyond * beyond));
}

// Axis z, the tip at 0.
export function toolGeometry(tool: Cutter | null, size: number): THREE.BufferGeometry {
  const points: THREE.Vector2[] = [];
  if (tool) {
    const { radius, corner_radius: corner } = tool, flat = radius - corner;
    const end = profileOf(tool, radius);
    points.push(new THREE.Vector2(0, 0));
    if (tool.tip_angle) {
      const ball = corner * Math.cos(tool.tip_angle / 2);
      for (let k = 0; corner && k <= 8; ++k) points.push(new THREE.Vector2(ball * k / 8, profileOf(tool, ball * k / 8)));
      points.push(new THREE.Vector2(tool.tip_radius || ball, profileOf(tool, tool.tip_radius || ball)), new THREE.Vector2(radius, end));
    } else {
      for (let k = 0; k <= 16; ++k) {
        const angle = k / 16 * Math.PI / 2;
        points.push(new THREE.Vector2(flat + corner * Math.sin(angle), corner * (1 - Math.cos(angle))));
      }
    }
    const flutes = tool.flute_length ? Math.max(tool.flute_length, end) : Math.max(5 * radius, end + radius);
    const neck = (tool.shank_diameter ?? 1.84 * radius) / 2; let top = Math.max(tool.length ?? flutes + 5 * radius, flutes);
    points.push(new THREE.Vector2(radius, flutes), new THREE.Vector2(neck, flutes), new THREE.Vector2(neck, top));
    for (const [diameter, length] of tool.holder ?? []) points.push(new THREE.Vector2(diameter / 2, top), new THREE.Vector2(diameter / 2, top += length));
    points.push(new THREE.Vector2(0, top));
  } else {
    points.push(new THREE.Vector2(0, 0), new THREE.Vector2(0.012 * size, 0.05 * size), new THREE.Vector2(0.012 * size, 0.16 * size), new THREE.Vector2(0, 0.16 * size));
  }
  return new THREE.LatheGeometry(points, 40).rotateX(Math.PI / 2);
}

export const toolMaterial = (): THREE.MeshLambertMaterial => new THREE.MeshLambertMaterial({ color: 0xffffff });

// The lights of the tool; path and solids are shaded by their own.
export function toolLights(): THREE.Light[] {
  const light = new THREE.DirectionalLight(0xffffff, 1.8);
  light.position.set(-0.5, -0.6, 0.8);
  return [light, new THREE.AmbientLight(0xffffff, 1.7)];
}
