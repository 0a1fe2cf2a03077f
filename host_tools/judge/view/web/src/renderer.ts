// The renderer of the scene, made while the run is still being unpacked.
import * as THREE from "three";
import { fieldMaterial } from "./height_field";
import { pathMaterial } from "./path_lines";
import { toolLights, toolMaterial } from "./tool_shape";

// The colour tables are in the colour space of the screen.
THREE.ColorManagement.enabled = false;

export const backgroundOf = (dark: boolean): THREE.Color => new THREE.Color(dark ? 0x15181d : 0xeef1f4);

// Size of the element that holds the canvas, CSS pixels.
export function sizeOf(canvas: HTMLCanvasElement): { width: number; height: number } {
  const box = canvas.parentElement!.getBoundingClientRect();
  return { width: Math.max(box.width, 1), height: Math.max(box.height, 1) };
}

// Throws without WebGL.
export function rendererOn(canvas: HTMLCanvasElement): THREE.WebGLRenderer {
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  const { width, height } = sizeOf(canvas);
  renderer.setSize(width, height, false);
  return renderer;
}

export function drawsInSoftware(renderer: THREE.WebGLRenderer): boolean {
  const gl = renderer.getContext(), names = gl.getExtension("WEBGL_debug_renderer_info");
  return names !== null && /SwiftShader|llvmpipe|software|Basic Render/i.test(String(gl.getParameter(names.UNMASKED_RENDERER_WEBGL)));
}

// Compiles the shaders of the scene, in the background where the driver can. The renderer keeps the programs for materials
// alike, since these here are not disposed.
export function warmUp(renderer: THREE.WebGLRenderer, withSolids: boolean): void {
  const world = new THREE.Scene(), geometry = new THREE.BufferGeometry();
  world.add(new THREE.LineSegments(geometry, pathMaterial(0, null)), new THREE.Mesh(geometry, toolMaterial()), ...toolLights());
  if (withSolids) world.add(new THREE.Mesh(geometry, fieldMaterial()));
  renderer.compile(world, new THREE.OrthographicCamera());
}
