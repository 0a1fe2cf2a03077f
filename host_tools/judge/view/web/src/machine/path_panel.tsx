// The path of the whole program, and where the tool is on it.
import { effect, useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { drawProgram, hasCore } from "../core/run_program";
import { isAbort, textOf } from "../engine/engine";
import { isDark } from "../frame";
import { PathView } from "../playground/path_view";
import { now } from "./machine";
import { choice } from "./run_panel";

export function PathPanel(): JSX.Element {
  const host = useRef<HTMLDivElement>(null), note = useSignal("");
  useEffect(() => {
    const view = new PathView(host.current!, isDark);
    let stop = new AbortController();
    const ends = [effect(() => {
      const program = choice();
      stop.abort();
      stop = new AbortController();
      if (!program || !hasCore) return;
      note.value = "Running the program through for its path …";
      const progress = ({ fraction }: { fraction: number }) => { note.value = `Running the program through for its path: ${Math.round(100 * fraction)} %`; };
      drawProgram(program.text(), "", { signal: stop.signal, progress }).then(({ path }) => {
        note.value = "";
        view.show(path);
        view.look3d();
      }, (reason: unknown) => { if (!isAbort(reason)) note.value = textOf(reason); });
    }), effect(() => {
      const [x, y, z] = now.value.work;
      view.mark(now.value.link === "open" ? [x, y, z] : null);
    })];
    return () => {
      stop.abort();
      for (const end of ends) end();
    };
  }, []);
  return <div class="stage" ref={host}>{note.value ? <p class="stage-note">{note.value}</p> : null}</div>;
}
