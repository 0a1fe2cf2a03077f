// Part: files come in, and are described.
import { useSignal, useSignalEffect } from "@preact/signals";
import type { JSX } from "preact";
import { useRef } from "preact/hooks";
import { isAbort, textOf } from "../engine/engine";
import { removeFile, takeFiles } from "./files";
import { engine, engineCall, floatsOf, inch, kinds, project } from "./store";
import { partFacets } from "./part_view";

const sizeOf = (bytes: number): string => bytes < 1e6 ? `${Math.ceil(bytes / 1000)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;

function DropZone(): JSX.Element {
  const picker = useRef<HTMLInputElement>(null);
  return <div class="drop">
    <p><strong>Drop a part here</strong>, or</p>
    <button type="button" class="primary" onClick={() => picker.current?.click()}>Choose files …</button>
    <p class="note">STEP, STL, OBJ, 3MF, DXF, SVG, Gerber, JSON, a picture; a job.toml with its parts, or a project.zip</p>
    <input ref={picker} type="file" multiple hidden aria-label="Files of the project" onChange={(event) => {
      const list = [...event.currentTarget.files ?? []];
      event.currentTarget.value = "";
      void takeFiles(list);
    }} />
  </div>;
}

// The description of a file is made once for its bytes.
const described = new WeakMap<Uint8Array, { text: string; facets: Float32Array | null }>();

function Described({ name, bytes }: { name: string; bytes: Uint8Array }): JSX.Element {
  const text = useSignal(described.get(bytes)?.text ?? "reading …"), bad = useSignal(false);
  useSignalEffect(() => {
    const units = inch.value ? "inch" : "mm", stop = new AbortController();
    if (!engine.value) return undefined;
    const known = described.get(bytes);
    if (known) {
      text.value = known.text;
      partFacets.value = known.facets;
      return undefined;
    }
    engineCall("describe", { files: [name], units, facets: true }, new Map([[name, bytes]]), { signal: stop.signal }).then(({ result, blocks }) => {
      const block = result.facets?.at(0)?.block, facets = floatsOf(block ? blocks.get(block) : undefined);
      described.set(bytes, { text: result.text, facets });
      text.value = result.text;
      if (facets) partFacets.value = facets;
    }, (reason: unknown) => {
      if (isAbort(reason)) return;
      bad.value = true;
      text.value = textOf(reason);
    });
    return () => stop.abort();
  });
  return <pre class={`described${bad.value ? " fault" : ""}`} role={bad.value ? "alert" : undefined}>{text.value}</pre>;
}

export function PartStep(): JSX.Element {
  const files = [...project.value.files];
  return <>
    <DropZone />
    {files.length > 0 ? <h2>Files</h2> : null}
    {files.map(([name, bytes]) => <article class="card" key={name}>
      <header class="card-head">
        <h3>{name}</h3><span class="note">{sizeOf(bytes.length)}</span>
        <button type="button" aria-label={`Remove ${name}`} onClick={() => removeFile(name)}>Remove</button>
      </header>
      {kinds.surfaces.test(name) || kinds.drawing.test(name) ? <Described name={name} bytes={bytes} /> : null}
    </article>)}
    {files.length > 0 ? <p class="next"><a class="button primary" href="#operations">Go on to the operations</a></p> : null}
  </>;
}
