// A run on show: scene, program, time and charts around one cursor. In the page of `cusp view`, and in the studio.
import { applyColouring, colourings } from "./colouring";
import type { Colouring } from "./colouring";
import { Charts } from "./charts";
import { listenToKeys, readout, sceneTools, transport } from "./controls";
import type { Choices } from "./controls";
import { element } from "./elements";
import { isDark } from "./frame";
import { ProgramList } from "./program_list";
import type { PageFacts, Run, Triple, WorstPlace } from "./run_data";
import { rendererOn, warmUp } from "./renderer";
import { Scene } from "./scene";
import { Timeline } from "./timeline";

/** Where the parts of a run are shown. */
export interface RunPlaces { stage: HTMLElement; program: HTMLElement; transport: HTMLElement; charts: HTMLElement }

export interface RunView {
  timeline: Timeline;
  scene: Scene | null;                       // null: no WebGL, which `status` says
  drawn: () => Promise<void>;                // of the first picture
  toLine: (line: number) => void;
  toPlace: (place: WorstPlace) => void;
  tickAt: (px: number, py: number) => number | null;
  show: (name: string) => void;
  restyle: () => void;
  close: () => void;
}

// Null without WebGL, with the reason in `status`.
function rendererOr(canvas: HTMLCanvasElement, status: HTMLElement): ReturnType<typeof rendererOn> | null {
  try {
    return rendererOn(canvas);
  } catch (error) {
    status.textContent = `No picture: ${error instanceof Error ? error.message : String(error)}`;
    return null;
  }
}

// A click on the path moves the cursor there; a drag turns the scene.
function pickOn(canvas: HTMLCanvasElement, timeline: Timeline, tickAt: (px: number, py: number) => number | null): void {
  let down: [number, number] = [0, 0];
  canvas.addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; });
  canvas.addEventListener("pointerup", (event) => {
    if (event.button !== 0 || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 3) return;
    const tick = tickAt(event.pageX, event.pageY);
    if (tick === null) return;
    timeline.play(false);
    timeline.seekTick(tick);
  });
}

/**
 * Shows a run. `load` gets a function to call when its data are on their way; `status` says what keeps the picture away;
 * `help` opens the list of keys.
 */
export async function openRun(places: RunPlaces, facts: PageFacts, load: (begun: () => void) => Promise<Run>, status: HTMLElement, help: () => void): Promise<RunView> {
  const canvas = element("canvas", { role: "img", "aria-label": "Path, stock and tool of the run", tabindex: "0" }), closing = new AbortController();
  let renderer = null as ReturnType<typeof rendererOr>;
  const run = await load(() => {
    canvas.style.visibility = "hidden";  // black until the first frame
    places.stage.prepend(canvas);
    renderer = rendererOr(canvas, status);
    if (renderer) warmUp(renderer, facts.verification !== undefined);
  });
  if (run.ticks === 0) throw new Error("the run has no set point");
  const timeline = new Timeline(run, facts);
  const scene = renderer ? new Scene(renderer, timeline) : null;
  const goTo = (line: number) => {
    timeline.play(false);
    const ticks = timeline.ticksOfLine(line);
    if (ticks) timeline.seekTick(ticks[1]);
    return ticks !== null;
  };
  const list = element("div", { class: "program-list", role: "listbox", tabindex: "0", "aria-label": "Lines of the program" });
  places.program.append(list);
  const program = new ProgramList(list, timeline, goTo);
  program.scrollTo(1);  // the cursor is at the end, where all is cut; the program is read from its start
  const charts = new Charts(places.charts, timeline, isDark());
  places.transport.append(...transport(timeline));
  places.stage.append(readout(timeline));

  const choices: Choices = { colouring: run.left ? "height" : "speed", safe: true };
  const legend = element("div", { class: "legend" });
  let sync: () => void = () => undefined;
  const recolour = () => {
    if (scene) legend.replaceChildren(...applyColouring(choices.colouring, timeline, scene, { dark: isDark(), safe: choices.safe }));
    sync();
  };
  if (scene) {
    const tools = sceneTools(scene, timeline, choices, recolour);
    sync = tools.sync;
    places.stage.append(tools.bar, legend);
  }
  recolour();
  const nextColouring = () => {
    choices.colouring = colourings[(colourings.indexOf(choices.colouring) + 1) % colourings.length];
    recolour();
  };
  listenToKeys(timeline, scene, charts, nextColouring, help, closing.signal);
  const tickAt = (px: number, py: number) => scene?.path.tickAt(px, py, 5, scene.toPixels()) ?? null;
  if (scene) pickOn(canvas, timeline, tickAt);
  const show = (name: string) => {
    if (!colourings.includes(name as Colouring)) throw new RangeError(`no colouring "${name}": there are ${colourings.join(", ")}`);
    choices.colouring = name as Colouring;
    recolour();
  };
  return {
    timeline, scene, tickAt, show,
    drawn: async () => {
      canvas.style.visibility = "";
      await scene?.whenDrawn(true);
    },
    toLine: (line) => {
      goTo(line);
      program.scrollTo(line);
    },
    toPlace: (at) => {
      show("left");
      scene?.flyTo(at.at);
    },
    restyle: () => {
      charts.look = isDark();
      recolour();
    },
    close: () => {
      timeline.play(false);
      closing.abort();
      renderer?.dispose();
      renderer?.forceContextLoss();
    },
  };
}

/** Page pixels of a point; not numbers without a scene. */
export const pixelsOf = ({ scene }: RunView, at: Triple): [number, number] => scene ? scene.toPixels()(at).slice(0, 2) as [number, number] : [NaN, NaN];
