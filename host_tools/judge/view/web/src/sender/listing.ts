// A listing that is asked for several times over a line that may lose bytes: what most of the times agree on.

const keyOf = (line: string): string => /^(\$\w+=|\[T:\d+\||\[[^:]+:)/.exec(line)?.[1] ?? line;

export class Votes {
  private readonly votes = new Map<string, Map<string, number>>();
  private times = 0;
  /** Twice in a row the same: nothing was lost. */
  private same = false;
  private before = "";

  add(lines: readonly string[]): void {
    this.times += 1;
    const text = lines.join("\n");
    this.same = this.times > 1 && text === this.before;
    this.before = text;
    for (const line of lines) {
      const values = this.votes.get(keyOf(line)) ?? new Map<string, number>();
      this.votes.set(keyOf(line), values.set(line, (values.get(line) ?? 0) + 1));
    }
  }

  /** True once a further time would not change the lines. */
  get agree(): boolean {
    return this.same || (this.times >= 5 && this.leaders().every(([, count, second]) => count >= second + 2 && count >= 3));
  }

  /** One line for each key that more than half of the times had. */
  lines(): string[] { return this.leaders().map(([line]) => line); }

  private leaders(): [string, number, number][] {
    if (this.same) return this.before.split("\n").filter((line) => line !== "").map((line) => [line, this.times, 0]);
    const out: [string, number, number][] = [];
    for (const values of this.votes.values()) {
      const all = [...values].sort((a, b) => b[1] - a[1]), total = all.reduce((sum, [, count]) => sum + count, 0);
      if (2 * total > this.times) out.push([all[0][0], all[0][1], all.at(1)?.[1] ?? 0]);
    }
    return out;
  }
}
