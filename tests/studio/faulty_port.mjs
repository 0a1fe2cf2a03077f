// A port of the page's sender on the virtual mill, for tests: it loses, repeats and changes bytes both ways, from a seed, and can be
// unplugged. Time passes by run() alone.

export function numbers(state) {
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

// Bytes as a bad line lets them through. Faults are probabilities of each byte.
export class FaultyLine {
  constructor(random, { loss = 0, doubling = 0, noise = 0 } = {}) {
    Object.assign(this, { random, loss, doubling, noise, faults: 0 });
  }

  pass(bytes) {
    const out = [];
    for (const byte of bytes) {
      if (this.random() < this.loss) { this.faults += 1; continue; }
      const damaged = this.random() < this.noise ? byte ^ (1 << Math.floor(8 * this.random())) : byte;
      out.push(damaged);
      if (this.random() < this.doubling) out.push(damaged);
    }
    return Uint8Array.from(out);
  }
}

export class FaultyPort {
  // beat: ms between beats of the sender.
  constructor(mill, random, faults) {
    this.mill = mill;
    [this.to, this.from] = [new FaultyLine(random, faults), new FaultyLine(random, faults)];
    [this.ticks, this.events, this.waiting, this.sent] = [0, null, [], ""];
  }

  open(events) { this.events = events; return Promise.resolve(); }
  write(bytes) {
    this.sent += String.fromCharCode(...bytes);
    this.waiting.push(bytes);
  }
  now() { return this.ticks; }
  begin() { this.mill.mark(); }
  close() { this.events = null; return Promise.resolve(); }
  lose() {
    const { events } = this;
    this.events = null;
    this.waiting = [];
    events?.lost("it was unplugged");
  }

  // Ticks of the mill, with the sender where one is plugged in.
  async run(ms) {
    for (let k = 0; k < ms; ++k) {
      for (let bytes = this.waiting.shift(); bytes; bytes = this.waiting.shift()) this.deliver(this.mill.send(this.to.pass(bytes)));
      this.deliver(this.mill.tick());
      if (++this.ticks % 20 === 0) this.events?.beat();
      await Promise.resolve();
    }
  }

  async until(holds, most = 600_000) {
    for (const end = this.ticks + most; !holds();) {
      if (this.ticks > end) throw new Error(`not within ${most} ms`);
      await this.run(10);
    }
  }

  deliver(bytes) {
    this.says?.(bytes);
    const arrived = this.from.pass(bytes);
    if (arrived.length > 0) this.events?.take(arrived);
  }
}
