// The project in the browser's own store: a page that is loaded again has it. Where there is no store, nothing is kept.
import type { Project } from "./project";

const kStore = "projects", kKey = "last";

function opened(): Promise<IDBDatabase> {
  return new Promise((done, fail) => {
    const request = indexedDB.open("cusp-studio", 1);
    request.onupgradeneeded = () => request.result.createObjectStore(kStore);
    request.onsuccess = () => done(request.result);
    request.onerror = () => fail(request.error ?? new Error("no store"));
  });
}

function asked<T>(request: IDBRequest<T>): Promise<T> {
  return new Promise((done, fail) => {
    request.onsuccess = () => done(request.result);
    request.onerror = () => fail(request.error ?? new Error("the store failed"));
  });
}

export async function saveProject({ job, files }: Project): Promise<void> {
  const base = await opened();
  try {
    await asked(base.transaction(kStore, "readwrite").objectStore(kStore).put({ job, files: [...files] }, kKey));
  } finally {
    base.close();
  }
}

export async function savedProject(): Promise<Project | null> {
  const base = await opened();
  try {
    const found = await asked(base.transaction(kStore).objectStore(kStore).get(kKey)) as { job: string; files: [string, Uint8Array][] } | undefined;
    return found ? { job: found.job, files: new Map(found.files) } : null;
  } finally {
    base.close();
  }
}
