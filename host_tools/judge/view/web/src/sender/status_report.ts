// A status report of Grbl 1.1, read strictly: a text that lost bytes is none.

/** X, Y, Z in mm, or inches with $13, and where the machine has it A in degrees. */
export type Place = [number, number, number, number?];

/** Fields that a report may leave out are null. Lengths as reported: mm, or inches with $13. */
export interface StatusReport {
  state: string;
  substate: number;
  machine: Place | null;
  work: Place | null;
  offset: Place | null;
  blocks: number | null;
  bytes: number | null;
  line: number | null;
  feed: number | null;
  spindle: number | null;
  pins: string;
  overrides: [number, number, number] | null;
  /** Letters of what is on; null: the report does not say. */
  accessories: string | null;
}

const kNumber = /^-?\d{1,5}\.(\d{3}|\d{4})$/;
const kStates = /^(Idle|Run|Jog|Alarm|Check|Home|Sleep|Hold:[01]|Door:[0-3])$/;

/** Of three to six axes, all with as many decimals; null: a text of another form. */
export const placeOf = (text: string): Place | null => {
  const axes = text.split(","), decimals = new Set(axes.map((n) => kNumber.exec(n)?.[1].length ?? 0));
  return axes.length >= 3 && axes.length <= 6 && decimals.size === 1 && !decimals.has(0) ? axes.slice(0, 4).map(Number) as Place : null;
};
const numbersOf = (text: string, form: RegExp): number[] | null => form.test(text) ? text.split(",").map(Number) : null;

/** Null: a field has not its form, or comes twice; or there is no position. Fields that only other controllers have are passed over. */
export function statusReport(line: string): StatusReport | null {
  if (!line.startsWith("<") || !line.endsWith(">")) return null;
  const [state, ...fields] = line.slice(1, -1).split("|"), seen = new Set<string>();
  if (!kStates.test(state)) return null;
  const [name, substate] = state.split(":");
  const report: StatusReport = {
    state: name, substate: Number(substate || -1), machine: null, work: null, offset: null, blocks: null, bytes: null, line: null, feed: null, spindle: null,
    pins: "", overrides: null, accessories: null,
  };
  for (const field of fields) {
    const at = field.indexOf(":"), key = field.slice(0, at), value = field.slice(at + 1);
    if (at < 1 || seen.has(key) || !takeField(report, key, value)) return null;
    seen.add(key);
  }
  if ((report.machine === null) === (report.work === null)) return null;
  if (report.overrides && report.accessories === null) report.accessories = "";
  return report;
}

function takeField(report: StatusReport, key: string, value: string): boolean {
  let numbers: number[] | null;
  switch (key) {
    case "MPos": return (report.machine = placeOf(value)) !== null;
    case "WPos": return (report.work = placeOf(value)) !== null;
    case "WCO": return (report.offset = placeOf(value)) !== null;
    case "Bf":
      numbers = numbersOf(value, /^\d{1,5},\d{1,6}$/);
      [report.blocks, report.bytes] = numbers ?? [null, null];
      return numbers !== null;
    case "Ln":
      report.line = /^\d{1,9}$/.test(value) ? Number(value) : null;
      return report.line !== null;
    case "FS": case "F":
      numbers = numbersOf(value, key === "F" ? /^\d{1,7}(\.\d)?$/ : /^\d{1,7}(\.\d)?,\d{1,6}$/);
      [report.feed, report.spindle] = [numbers?.[0] ?? null, numbers?.[1] ?? null];
      return numbers !== null;
    case "Pn":
      report.pins = value;
      return /^[PXYZDHRSEMABC]+$/.test(value);
    case "Ov":
      report.overrides = numbersOf(value, /^\d{1,3},\d{1,3},\d{1,3}$/) as [number, number, number] | null;
      return report.overrides !== null;
    case "A":
      report.accessories = value;
      return /^[SCFM]+$/.test(value);
    default: return /^[A-Za-z]+$/.test(key) && /^[\w.,:-]*$/.test(value);
  }
}

/** How fast a machine may have moved between two reports, mm/min: feeds of both, and room for what was between them. */
const mostSpeed = (a: StatusReport, b: StatusReport): number => 1.3 * Math.max(a.feed ?? 0, b.feed ?? 0) + 600;
const isMoving = ({ state, substate }: StatusReport): boolean => !["Idle", "Alarm", "Sleep", "Check"].includes(state) && substate !== 0;

/** Whether the second report can follow the first after so many ms: at rest the place stays, in motion it is within reach. */
export function follows(first: StatusReport, second: StatusReport, ms: number): boolean {
  const a = first.machine ?? first.work, b = second.machine ?? second.work;
  if (!a || !b || (first.machine === null) !== (second.machine === null)) return false;
  const distance = Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
  if (!isMoving(first) && !isMoving(second)) return distance === 0;
  return distance <= mostSpeed(first, second) / 60_000 * ms + 0.3;
}

/** Passes on reports of a link without checksums: one that does not follow the last waits until the next one agrees with it. */
export class ReportFilter {
  private last: { report: StatusReport; at: number } | null = null;
  private doubted: { report: StatusReport; at: number } | null = null;

  /** True if it is to be believed. */
  accept(report: StatusReport, at: number): boolean {
    const agrees = (other: typeof this.last): boolean => other !== null && follows(other.report, report, at - other.at);
    const good = agrees(this.last) || agrees(this.doubted);
    this.doubted = good ? null : { report, at };
    if (good) this.last = { report, at };
    return good;
  }
}
