// The record that a page closed amid a cut leaves behind: the program's name, its text's checksum, the line that the tool had reached, and
// the controller as it was at the beginning. The next page offers to resume there.
import { crc32 } from "../sender/crc32";
import type { Place } from "../sender/status_report";

export interface CutRecord { name: string; crc: string; line: number; start: string[]; startPlace: Place }

const kStore = "cusp-studio-cut";

export const crcOf = (text: string): string => crc32(text);

export function keepRecord(record: CutRecord): void {
  try {
    localStorage.setItem(kStore, JSON.stringify(record));
  } catch { /* no store: nothing is kept */ }
}

export function dropRecord(): void {
  try {
    localStorage.removeItem(kStore);
  } catch { /* as above */ }
}

/** Null: no cut was left; or what is kept is none. */
export function keptRecord(): CutRecord | null {
  try {
    const found = JSON.parse(localStorage.getItem(kStore) ?? "null") as (Omit<Partial<CutRecord>, "startPlace"> & { startPlace?: unknown[] }) | null;
    const good = typeof found?.name === "string" && typeof found.crc === "string" && Number.isInteger(found.line) && (found.line ?? 0) >= 1 &&
      Array.isArray(found.start) && found.start.every((line) => typeof line === "string") && Array.isArray(found.startPlace) && [3, 4].includes(found.startPlace.length) && found.startPlace.every(Number.isFinite);
    return good ? found as unknown as CutRecord : null;
  } catch {
    return null;
  }
}
