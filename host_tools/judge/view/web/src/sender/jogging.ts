// Jogs for as long as a button is held: short moves one after the other, so that a machine whose page falls silent stops by itself.
import type { Dialogue } from "./dialogue";
import { kJogCancel } from "./dialogue";

const kPiece = 100;      // ms of motion in a move
const kAhead = 3;        // moves under way
const kAlive = 300;      // ms without a word of the page

export class Jogging {
  private readonly began: number;
  private moves = 0;
  private alive: number;
  ended = false;

  /** direction: of each axis, -1 to 1; feed: mm/min along it. */
  constructor(private readonly dialogue: Dialogue, private readonly direction: readonly number[], private readonly feed: number) {
    this.began = this.alive = dialogue.port.now();
    this.beat();
  }

  keep(): void { this.alive = this.dialogue.port.now(); }

  beat(): void {
    if (this.ended) return;
    const now = this.dialogue.port.now();
    if (now - this.alive > kAlive) {
      this.end();
      return;
    }
    for (; this.moves < kAhead + (now - this.began) / kPiece; ++this.moves) {
      this.dialogue.add({ text: jogLine(this.direction, this.feed * kPiece / 60_000, this.feed), line: 0, done: (error) => { if (error > 0) this.end(); } });
      this.dialogue.flush();
    }
  }

  end(): void {
    if (this.ended) return;
    this.ended = true;
    this.dialogue.realtime(kJogCancel);
  }
}

/** distance: mm along the direction. */
export function jogLine(direction: readonly number[], distance: number, feed: number): string {
  const size = Math.hypot(...direction), words = direction.map((d, k) => d === 0 ? "" : `${"XYZ"[k]}${(distance * d / size).toFixed(4)}`);
  return `$J=G91G21${words.join("")}F${feed.toFixed(0)}`;
}
