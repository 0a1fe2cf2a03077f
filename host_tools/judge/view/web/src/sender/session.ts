// A session with a machine: the link, its program, jogs and stops, and the picture of all that for the page.
import { Dialogue, kHold, kJogCancel, kReset, kResume } from "./dialogue";
import type { Outcome } from "./dialogue";
import { Jogging, jogLine } from "./jogging";
import { ProgramRun } from "./program_run";
import type { ProgramLine } from "./program_run";
import type { Place } from "./status_report";
import { atRest, type Snapshot } from "./snapshot";
import type { Port } from "../port/port";

const kRepeatHold = 100;     // ms
const kHoldLimit = 10_000;   // ms in which any machine stops
const kMostMessages = 30;
const kInch = 25.4;

// Lengths alone: A is degrees.
const scaled = (at: Place, by: number): Place => at.map((n, axis) => axis < 3 ? n! * by : n) as Place;
const moved = (at: Place, by: Place, sign: number): Place => at.map((n, axis) => n! + sign * (by[axis] ?? 0)) as Place;

/** Why a program can't begin. */
export class Refusal extends Error {}

export class Session {
  private dialogue: Dialogue | null = null;
  private run: ProgramRun | null = null;
  private jog: Jogging | null = null;
  private stopping: { since: number; held: number } | null = null;
  private heldByUs = false;
  private resumed = false;   // since the last report
  private link: Snapshot["link"] = "none";
  private why = "";
  private name = "";
  private alarm = 0;
  private messages: string[] = [];
  private offset: Place = [0, 0, 0];
  private overrides: [number, number, number] = [100, 100, 100];
  private accessories = "";
  private startListing: string[] = [];
  private startPlace: Place = [0, 0, 0];

  /** changed: something that the page should see at once. */
  constructor(private readonly changed: () => void) {}

  /** A program whose link was lost may be continued on the new one. */
  async open(port: Port, name: string): Promise<void> {
    await this.close();
    const dialogue = new Dialogue(port, {
      report: () => { this.takeReport(); },
      answered: (sent, error) => {
        this.run?.takeAnswer(sent, error);
        if (this.run?.phase === "fault" && error > 0 && !this.stopping) this.beginStop();
        this.run?.feed();
      },
      alarm: (code) => { this.takeAlarm(code); },
      message: (text) => { this.say(text); },
      restarted: () => { this.takeRestart(); },
      ready: () => { this.changed(); },
      beat: () => { this.beat(); },
      lost: (why) => { this.lose(why); },
    });
    dialogue.mayPrepare = !this.run?.mayContinue;
    [this.dialogue, this.link, this.why, this.name] = [dialogue, "opening", "", name];
    this.changed();
    try {
      await dialogue.open();
    } catch (reason) {
      this.dialogue = null;
      [this.link, this.why] = ["lost", reason instanceof Error ? reason.message : String(reason)];
    }
    this.changed();
  }

  async close(): Promise<void> {
    const { dialogue } = this;
    if (!dialogue) return;
    this.jog?.end();
    if (this.run?.phase === "run") {
      dialogue.realtime(kHold);
      this.run.end("lost", 0, "the port was closed");
    }
    this.dialogue = null;
    [this.link, this.stopping, this.jog] = ["none", null, null];
    await dialogue.close();
    this.changed();
  }

  get isRunning(): boolean { return this.run?.phase === "run"; }
  get isCutting(): boolean { return this.isRunning && this.dialogue?.state !== "Hold" && this.dialogue?.state !== "Door"; }

  /** Sends the lines. Throws a Refusal where the machine is not ready for it. */
  begin(lines: readonly ProgramLine[]): void {
    const dialogue = this.readyDialogue();
    if (this.isRunning || dialogue.state !== "Idle") throw new Refusal(`the machine is not at rest but in state ${dialogue.state}`);
    this.stopping = null;
    this.heldByUs = false;
    this.startListing = dialogue.facts.listing;
    this.startPlace = this.machinePlace();
    dialogue.port.begin();
    this.run = new ProgramRun(dialogue, lines);
    this.run.feed();
    this.changed();
  }

  /** After a lost link, where the controller still expects the program's lines. */
  goOn(): void {
    if (!this.dialogue || !this.run || !this.canContinue) throw new Refusal("the controller was reset since: resume from a line");
    this.heldByUs = false;
    if (["Hold", "Door"].includes(this.dialogue.state)) this.dialogue.realtime(kResume);
    this.run.continueOn(this.dialogue);
    this.changed();
  }

  /** The program that was lost is given up: the controller is asked anew. */
  forget(): void {
    this.run = null;
    if (this.dialogue) this.dialogue.mayPrepare = true;
    this.changed();
  }

  hold(): void {
    this.heldByUs = true;
    this.dialogue?.realtime(kHold);
  }
  resume(): void {
    this.heldByUs = false;
    this.resumed = true;
    this.dialogue?.realtime(kResume);
  }

  /** Holds, then resets once the machine stands; a second time: resets at once. A jog is cancelled. A machine that rests is left alone. */
  stop(): void {
    const { dialogue } = this;
    if (!dialogue) return;
    if (!this.isRunning && !this.jog && dialogue.rests) return;
    this.jog?.end();
    if (this.isRunning) this.run?.end("stopped");
    if (this.stopping) this.reset();
    else this.beginStop();
    this.changed();
  }

  /** Stops at once. In motion the place may be lost. */
  reset(): void {
    this.stopping = null;
    if (this.isRunning) this.run?.end("stopped");
    this.dialogue?.realtime(kReset);
  }

  async command(text: string): Promise<Outcome> {
    const dialogue = this.dialogue;
    if (!dialogue) throw new Refusal("no machine is connected");
    if (this.isRunning) throw new Refusal("a program runs");
    if (!dialogue.ready) throw new Refusal(`the controller takes no lines in state ${dialogue.state || "unknown"}`);
    return dialogue.command(text);
  }

  /** $# and $G anew, as lost bytes have not changed them; after all motion, as they are refused in it. */
  async refresh(): Promise<void> {
    const dialogue = this.readyDialogue();
    if (dialogue.state !== "Alarm") await dialogue.command("G4P0.01");
    const { facts } = dialogue, own = facts.listing.filter((line) => !/^\[(G|T|PRB)/.test(line));
    facts.listing = own;
    for (const command of ["$G", "$#"]) facts.take(await dialogue.listingOf(command));
    this.changed();
  }

  realtime(byte: number): void { this.dialogue?.realtime(byte); }

  jogStep(direction: readonly number[], distance: number, feed: number): void {
    const dialogue = this.readyDialogue();
    if (this.isRunning || !["Idle", "Jog"].includes(dialogue.state)) return;
    dialogue.add({ text: jogLine(direction, distance, feed), line: 0, done: (error) => { if (error > 0) this.say(`jog: error:${error}`); } });
    dialogue.flush();
  }
  jogBegin(direction: readonly number[], feed: number): void {
    const dialogue = this.readyDialogue();
    this.jog?.end();
    if (this.isRunning || !["Idle", "Jog"].includes(dialogue.state)) return;
    this.jog = new Jogging(dialogue, direction, feed);
  }
  jogKeep(): void { this.jog?.keep(); }
  jogEnd(): void {
    if (this.jog) this.jog.end();
    else if (this.dialogue?.state === "Jog") this.dialogue.realtime(kJogCancel);
    this.jog = null;
  }

  snapshot(): Snapshot {
    const { dialogue, run } = this, last = dialogue?.last ?? null;
    if (!dialogue) return { ...atRest, link: this.link, why: this.why, port: this.name, run: this.runPicture(), messages: this.messages };
    const machine = this.machinePlace();
    return {
      link: this.link, why: this.why, port: this.name, ready: dialogue.ready, checked: dialogue.checked, version: dialogue.facts.version,
      state: dialogue.state, substate: last?.substate ?? -1, alarm: dialogue.state === "Alarm" ? this.alarm : 0,
      machine, work: moved(machine, this.offset, -1), offset: this.offset,
      feed: (last?.feed ?? 0) * this.unit, spindle: last?.spindle ?? 0, pins: last?.pins ?? "", overrides: this.overrides, accessories: this.accessories,
      modal: dialogue.facts.modal, settings: Object.fromEntries(dialogue.facts.settings), places: this.places(), probe: this.probe(), toolLength: dialogue.facts.toolLength * this.unit,
      held: this.heldByUs, stopping: this.stopping !== null, messages: this.messages, refused: dialogue.refused, resent: dialogue.resent,
      run: this.runPicture(), pause: run?.phase === "run" && dialogue.state === "Hold" && !this.resumed && !this.heldByUs ? run.pause : null,
    };
  }

  /** Facts for a call to resume: the controller as it was when the program began, and as it is. */
  resumeFacts(): { start: string[]; startPlace: Place; now: string[]; place: Place } {
    return { start: this.startListing, startPlace: this.startPlace, now: this.dialogue?.facts.listing ?? [], place: this.machinePlace() };
  }

  private runPicture(): Snapshot["run"] {
    const { run } = this;
    return run === null ? null : {
      phase: run.phase, error: run.error, text: run.text, line: run.line, at: run.at, executed: run.executed.line, answered: run.answered, lines: run.lines.length,
      fraction: run.fraction, seconds: run.seconds, canContinue: this.canContinue,
    };
  }

  private places(): Record<string, Place> {
    return Object.fromEntries([...this.dialogue?.facts.places ?? []].map(([name, at]) => [name, scaled(at, this.unit)]));
  }
  private probe(): Snapshot["probe"] {
    const found = this.dialogue?.facts.probe;
    return found ? { ...found, at: scaled(found.at, this.unit) } : null;
  }

  private get canContinue(): boolean { return this.run?.mayContinue === true && this.dialogue?.stillChecks === true; }
  private get unit(): number { return this.dialogue?.facts.setting(13) ? kInch : 1; }

  private machinePlace(): Place {
    const last = this.dialogue?.last, at = scaled(last?.machine ?? last?.work ?? [0, 0, 0], this.unit);
    return last?.machine ? at : moved(at, this.offset, 1);
  }

  private readyDialogue(): Dialogue {
    if (!this.dialogue?.ready) throw new Refusal("no machine is ready");
    return this.dialogue;
  }

  private say(text: string): void {
    this.messages = [...this.messages, text].slice(-kMostMessages);
    this.changed();
  }

  private takeReport(): void {
    const dialogue = this.dialogue!, report = dialogue.last!, { unit } = this;
    if (!dialogue.stillChecks) dialogue.mayPrepare = true;
    if (this.link === "opening") {
      this.link = "open";
      this.changed();
    }
    if (report.offset) this.offset = scaled(report.offset, unit);
    if (report.overrides) this.overrides = report.overrides;
    if (report.accessories !== null) this.accessories = report.accessories;
    this.resumed = false;
    if (report.state !== "Hold") this.heldByUs &&= report.state === "Run";
    this.run?.takeReport(report);
    if (this.run?.phase === "run" && report.state === "Alarm") this.run.end("fault", this.alarm, "alarm");
    if (this.run?.phase === "run" && report.state === "Check") this.run.end("fault", 0, "the controller is in check mode: nothing is cut");
    this.run?.feed();
    if (this.stopping && !["Run", "Jog", "Home"].includes(report.state) && report.substate !== 1 && report.substate !== 2) {
      const moved = this.stopping;
      this.stopping = null;
      if (report.state !== "Idle" || moved.held > 0) dialogue.realtime(kReset);
      this.changed();
    }
  }

  private takeAlarm(code: number): void {
    this.alarm = code;
    if (this.run?.phase === "run") this.run.end("fault", code, "alarm");
    this.jog = null;
    this.changed();
  }

  private takeRestart(): void {
    this.stopping = null;
    this.jog = null;
    if (this.isRunning) this.run?.end("lost", 0, "the controller was reset");
    if (this.dialogue) this.dialogue.mayPrepare = true;
    this.changed();
  }

  private beginStop(): void {
    const dialogue = this.dialogue!;
    this.stopping = { since: dialogue.port.now(), held: 0 };
    if (dialogue.state === "Jog") dialogue.realtime(kJogCancel);
    if (["Home", "Alarm", "Sleep", "Check", "Door"].includes(dialogue.state)) {
      this.stopping = null;
      dialogue.realtime(kReset);
      return;
    }
    this.pressHold();
  }

  private pressHold(): void {
    this.stopping!.held += 1;
    this.heldByUs = true;
    this.dialogue!.realtime(kHold);
  }

  private beat(): void {
    const now = this.dialogue?.port.now() ?? 0;
    this.jog?.beat();
    if (this.stopping) {
      if (now - this.stopping.since > kHoldLimit) this.reset();
      else if (now - this.stopping.since > kRepeatHold * this.stopping.held) this.pressHold();
    }
    this.run?.feed();
  }

  private lose(why: string): void {
    this.run?.end("lost", 0, why);
    this.dialogue = null;
    [this.link, this.why, this.jog, this.stopping] = ["lost", why, null, null];
    this.changed();
  }
}
