// The picture beside the first three steps: the part in its stock, as the job has them.
import { useSignal, useSignalEffect } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { partFacets, PartView } from "./part_view";
import { checked } from "./store";

export function Stage({ themed }: { themed: boolean }): JSX.Element {
  const host = useRef<HTMLDivElement>(null), canvas = useRef<HTMLCanvasElement>(null), view = useSignal<PartView | null>(null), why = useSignal("");
  useEffect(() => {
    try {
      view.value = new PartView(host.current!, canvas.current!);
    } catch (reason) {
      why.value = `No picture: ${String(reason)}`;
    }
    return () => view.value?.close();
  }, []);
  useEffect(() => view.value?.ask(), [themed]);
  useSignalEffect(() => {
    const { setups, facets } = checked.value;
    view.value?.show(facets ?? partFacets.value, setups.at(0)?.stock ?? null);
  });
  const empty = partFacets.value === null && checked.value.facets === null && checked.value.setups.length === 0;
  return <div class="stage" ref={host}>
    <canvas ref={canvas} role="img" aria-label="The part in its stock" tabIndex={0} />
    {empty ? <p class="stage-note">{why.value || "The part is shown here."}</p> : null}
  </div>;
}
