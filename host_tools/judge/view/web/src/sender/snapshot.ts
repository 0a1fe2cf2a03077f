// The machine as the page knows it, some ten times a second. Lengths are mm, speeds mm/min.
import type { RunPhase } from "./program_run";
import type { Place } from "./status_report";

export interface Snapshot {
  /** lost: `why` says how. */
  link: "none" | "opening" | "open" | "lost";
  why: string;
  port: string;
  /** Lines may be sent. */
  ready: boolean;
  /** Lines are numbered and checked; null: not known yet. */
  checked: boolean | null;
  version: string;
  state: string;
  substate: number;
  alarm: number;
  machine: Place;
  work: Place;
  offset: Place;
  feed: number;
  spindle: number;
  pins: string;
  overrides: [number, number, number];
  accessories: string;
  modal: string[];
  settings: Partial<Record<number, number>>;
  places: Record<string, Place>;
  probe: { at: Place; touched: boolean } | null;
  toolLength: number;
  /** The hold is this page's own. */
  held: boolean;
  stopping: boolean;
  messages: string[];
  /** Reports that were damaged, and not shown. */
  refused: number;
  resent: number;
  run: {
    phase: RunPhase; error: number; text: string; line: number; at: number; executed: number; answered: number; lines: number; fraction: number; seconds: number;
    /** The controller still expects its lines: each is executed once. */
    canContinue: boolean;
  } | null;
  /** The line that the machine waits at: M0 or M6. */
  pause: { kind: "stop" | "tool"; line: number; text: string } | null;
}

export const atRest: Snapshot = {
  link: "none", why: "", port: "", ready: false, checked: null, version: "", state: "", substate: -1, alarm: 0, machine: [0, 0, 0], work: [0, 0, 0], offset: [0, 0, 0],
  feed: 0, spindle: 0, pins: "", overrides: [100, 100, 100], accessories: "", modal: [], settings: {}, places: {}, probe: null, toolLength: 0, held: false,
  stopping: false, messages: [], refused: 0, resent: 0, run: null, pause: null,
};
