// A project: the job's text and the files that it names. Each edit is a new value, so undo and redo are a list of them.
import { computed, signal } from "@preact/signals";
import { parse } from "smol-toml";
import type { FileSet } from "../engine/engine";

export interface Project { readonly job: string; readonly files: FileSet }

export const emptyProject: Project = { job: "", files: new Map() };

const kMostUndone = 500;

/** The project at hand, and its past and future. */
export class History {
  readonly now = signal<Project>(emptyProject);
  private readonly past = signal<readonly Project[]>([]);
  private readonly future = signal<readonly Project[]>([]);
  readonly canUndo = computed(() => this.past.value.length > 0);
  readonly canRedo = computed(() => this.future.value.length > 0);
  private merging = "";

  /** One step. Edits in turn with the same name, "" apart, are undone together: letters typed into one field. */
  change(next: Partial<Project>, name = ""): void {
    const before = this.now.value, after = { ...before, ...next };
    if (after.job === before.job && after.files === before.files) return;
    if (name === "" || name !== this.merging) this.past.value = [...this.past.value.slice(1 - kMostUndone), before];
    this.merging = name;
    this.future.value = [];
    this.now.value = after;
  }

  private step(from: typeof this.past, to: typeof this.past): void {
    const next = from.value.at(-1);
    if (!next) return;
    to.value = [...to.value, this.now.value];
    from.value = from.value.slice(0, -1);
    this.merging = "";
    this.now.value = next;
  }
  undo(): void { this.step(this.past, this.future); }
  redo(): void { this.step(this.future, this.past); }
}

/** The job's values, as far as its text is TOML. */
export interface JobValues { values: Record<string, unknown>; fault: string }

export function valuesOf(job: string): JobValues {
  try {
    return { values: parse(job), fault: "" };
  } catch (reason) {
    return { values: {}, fault: reason instanceof Error ? reason.message : String(reason) };
  }
}

/** The tables of a name: none, one, or a list. */
export function tablesOf(values: Record<string, unknown>, name: string): Record<string, unknown>[] {
  const found = values[name];
  return (Array.isArray(found) ? found : found === undefined ? [] : [found]) as Record<string, unknown>[];
}

const fileOf = (path: string): string => path.replace(/#[^#/]*$/, "");
const baseOf = (path: string): string => path.slice(path.lastIndexOf("/") + 1);

/** Every text in a job, at any depth. */
function textsOf(value: unknown): string[] {
  if (typeof value === "string") return [value];
  return typeof value === "object" && value !== null ? Object.values(value).flatMap(textsOf) : [];
}

/** The files as the job spells them: "../parts/tap.stl" is a dropped "tap.stl". */
export function filesFor({ job, files }: Project): FileSet {
  const out = new Map(files), byBase = new Map([...files].map(([name, bytes]) => [baseOf(name), bytes]));
  for (const path of textsOf(valuesOf(job).values).map(fileOf)) {
    const bytes = byBase.get(baseOf(path));
    if (!out.has(path) && bytes) out.set(path, bytes);
  }
  return out;
}
