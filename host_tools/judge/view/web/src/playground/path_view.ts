// The path on a canvas, coloured by speed: drag turns it, the wheel zooms, shift and drag moves it.
import { cssOf, gradientOf, scaleTable } from "../colours";
import { SKETCH_FIELDS } from "../core/path_sketch";
import { button, element, figure, legendBar } from "../elements";

const STEPS = 24;  // of colour
const DRAGGED_SEGMENTS = 30_000;

export class PathView {
  private readonly canvas = element("canvas", { tabindex: "0", role: "img", "aria-label": "Path of the tool; arrow keys turn it" });
  private readonly legend = element("div", { class: "legend" });
  private path: Float64Array = new Float64Array();
  private speedStep: Uint8Array = new Uint8Array();
  private centre = [0, 0, 0];
  private size = 1;
  private turn = 0;  // radians about Z
  private tilt = Math.PI / 2;  // from horizontal to top view
  private zoom = 1;
  private shift = [0, 0];
  private pending = false;
  private tool: [number, number, number] | null = null;  // mm

  constructor(host: HTMLElement, private readonly isDark: () => boolean) {
    const views: [string, number, number][] = [["Top", 0, Math.PI / 2], ["Front", 0, 0], ["Right", Math.PI / 2, 0], ["3-D", -0.6, 0.6]];
    const row = element("div", { class: "axis-row" }, ...views.map(([name, turn, tilt]) =>
      button(name, `Look from this side: ${name}`, () => { this.look(turn, tilt); })));
    host.append(this.canvas, row, this.legend);
    this.legend.hidden = true;
    new ResizeObserver(() => this.redraw()).observe(host);
    this.listen();
  }

  show(path: Float64Array): void {
    this.path = path;
    this.measure();
    this.colour();
    this.redraw();
  }

  redraw(fast = false): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => { this.pending = false; this.draw(fast); });
  }

  /** Marks a place on the path, mm; null: none. */
  mark(at: [number, number, number] | null): void {
    this.tool = at;
    this.redraw(this.speedStep.length > DRAGGED_SEGMENTS);
  }

  look3d(): void { this.look(-0.6, 0.6); }

  private look(turn: number, tilt: number): void {
    [this.turn, this.tilt, this.zoom, this.shift] = [turn, tilt, 1, [0, 0]];
    this.redraw();
  }

  private measure(): void {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let at = 0; at < this.path.length; at += SKETCH_FIELDS) {
      for (let k = 0; k < 3; ++k) {
        low[k] = Math.min(low[k], this.path[at + k]);
        high[k] = Math.max(high[k], this.path[at + k]);
      }
    }
    if (this.path.length === 0) return;
    this.centre = low.map((v, k) => (v + high[k]) / 2);
    this.size = Math.max(1, Math.hypot(...low.map((v, k) => high[k] - v)));
  }

  private colour(): void {
    const count = Math.max(0, this.path.length / SKETCH_FIELDS - 1), speed = new Float64Array(count);
    for (let k = 0; k < count; ++k) {
      const a = SKETCH_FIELDS * k, b = a + SKETCH_FIELDS, p = this.path;
      const seconds = p[b + 4] - p[a + 4];
      speed[k] = seconds > 0 ? Math.hypot(p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]) / seconds : 0;
    }
    const most = speed.reduce((a, b) => Math.max(a, b), 0);
    this.speedStep = Uint8Array.from(speed, (v) => most > 0 ? Math.min(STEPS - 1, Math.floor(v / most * STEPS)) : 0);
    this.legend.hidden = most === 0;
    this.legend.replaceChildren(...legendBar(gradientOf(this.table()), "Speed, mm/s", [0, most / 2, most].map((v) => figure(v))));
  }

  private table(): Uint8Array {
    return scaleTable("viridis", { dark: this.isDark(), safe: true });
  }

  private draw(fast: boolean): void {
    const { canvas } = this, ratio = devicePixelRatio;
    [canvas.width, canvas.height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    const pen = canvas.getContext("2d")!, scale = 0.92 * Math.min(canvas.width, canvas.height) / this.size * this.zoom;
    const [cosTurn, sinTurn, cosTilt, sinTilt] = [Math.cos(this.turn), Math.sin(this.turn), Math.cos(this.tilt), Math.sin(this.tilt)];
    const placed = (...at: [number, number, number]): [number, number] => {
      const [x, y, z] = at.map((value, k) => value - this.centre[k]);
      const across = x * cosTurn + y * sinTurn, away = -x * sinTurn + y * cosTurn;
      return [canvas.width / 2 + this.shift[0] * ratio + across * scale,
        canvas.height / 2 + this.shift[1] * ratio - (away * sinTilt + z * cosTilt) * scale];
    };
    const place = (at: number) => placed(this.path[at], this.path[at + 1], this.path[at + 2]);
    const lines = Array.from({ length: STEPS }, () => new Path2D()), count = this.speedStep.length;
    const stride = fast ? Math.max(1, Math.ceil(count / DRAGGED_SEGMENTS)) : 1;
    for (let k = 0; k < count; k += stride) {
      const line = lines[this.speedStep[k]];
      line.moveTo(...place(SKETCH_FIELDS * k));
      line.lineTo(...place(SKETCH_FIELDS * Math.min(count, k + stride)));
    }
    pen.lineWidth = 1.3 * ratio;
    const table = this.table();
    lines.forEach((line, k) => { pen.strokeStyle = cssOf(table, Math.round(k * 255 / (STEPS - 1))); pen.stroke(line); });
    if (!this.tool) return;
    pen.fillStyle = this.isDark() ? "#ffd166" : "#b3261e";
    pen.beginPath();
    pen.arc(...placed(...this.tool), 5 * ratio, 0, 2 * Math.PI);
    pen.fill();
  }

  private listen(): void {
    const { canvas } = this;
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons === 0) return;
      if (event.shiftKey || event.buttons === 4) this.shift = [this.shift[0] + event.movementX, this.shift[1] + event.movementY];
      else this.rotate(-event.movementX * 0.01, event.movementY * 0.01);
      this.redraw(true);
    });
    canvas.addEventListener("pointerup", () => this.redraw());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom = Math.min(500, Math.max(0.2, this.zoom * Math.exp(-event.deltaY * 0.0015)));
      this.redraw();
    }, { passive: false });
    const keys: Record<string, () => void> = {
      ArrowLeft: () => this.rotate(-0.1, 0), ArrowRight: () => this.rotate(0.1, 0), ArrowUp: () => this.rotate(0, 0.1), ArrowDown: () => this.rotate(0, -0.1),
      "+": () => { this.zoom *= 1.2; }, "-": () => { this.zoom /= 1.2; },
    };
    canvas.addEventListener("keydown", (event) => {
      if (!(event.key in keys)) return;
      event.preventDefault();
      keys[event.key]();
      this.redraw();
    });
  }

  private rotate(turn: number, tilt: number): void {
    this.turn += turn;
    this.tilt = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.tilt + tilt));
  }
}
