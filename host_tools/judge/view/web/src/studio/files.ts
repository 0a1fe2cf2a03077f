// Files into the project and out of it.
import { textOf } from "../engine/engine";
import { setKey } from "../project/job_text";
import { emptyProject, filesFor } from "../project/project";
import { filesOfZip, zipOf } from "../project/zip";
import { history, kinds, kJobName, planned, project, say } from "./store";

const decoded = (bytes: Uint8Array): string => new TextDecoder().decode(bytes).replace(/^\ufeff/, "").replace(/\r\n/g, "\n");

/** Takes dropped or chosen files: a job or a zip replaces the project's job, all else joins its files. */
export async function takeFiles(list: Iterable<File>): Promise<void> {
  const files = new Map(project.value.files);
  let { job } = project.value;
  const taken: string[] = [];
  const take = async (name: string, bytes: Uint8Array): Promise<void> => {
    if (kinds.zip.test(name)) {
      for (const [inner, data] of await filesOfZip(bytes)) await take(inner, data);
    } else if (kinds.job.test(name) && /^\s*(\[\[?operation|operation\s*=)/m.test(decoded(bytes))) job = decoded(bytes);
    else files.set(name, bytes);
    taken.push(name);
  };
  try {
    for (const file of list) await take(file.name, new Uint8Array(await file.arrayBuffer()));
  } catch (reason) {
    say(textOf(reason), true);
    return;
  }
  if (taken.length === 0) return;
  if (job === "") job = setKey("", { table: "", index: 0, key: "units" }, "\"mm\"");
  history.change({ job, files });
  say(`${taken.join(", ")} ${taken.length === 1 ? "is" : "are"} in the project`);
}

export function removeFile(name: string): void {
  const files = new Map(project.value.files);
  files.delete(name);
  history.change({ files });
}

export function newProject(): void {
  history.change(emptyProject);
  planned.value = null;
  say("A new project; Undo brings the old one back.");
}

export function download(name: string, content: Blob): void {
  const link = document.createElement("a"), address = URL.createObjectURL(content);
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** job.toml and the files, as the job spells them; a path that leads out of the folder stays out. */
export function saveProjectFile(): void {
  const { job } = project.value, all = new Map([[kJobName, new TextEncoder().encode(job)], ...project.value.files]);
  for (const [name, bytes] of filesFor(project.value)) if (!/(^|\/)\.\.(\/|$)|^\//.test(name)) all.set(name, bytes);
  download("project.zip", zipOf(all));
}
