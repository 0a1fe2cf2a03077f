// The virtual mill: a typed interface to the firmware and its machine tool in the WebAssembly module; also for node.
import { instanceOf } from "../core/core";

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  cusp_text(size: number): number;
  cusp_mill_open(plate: number): number;
  cusp_mill_send(): number;
  cusp_mill_tick(): number;
  cusp_mill_answers(): number;
  cusp_mill_mark(): void;
  cusp_mill_inputs(high: number, low: number): void;
  cusp_mill_plate(plate: number): void;
  cusp_mill_power(on: number): void;
  cusp_mill_figures(): number;
}

const kFigures = 11;

/** Of the machine tool itself, whatever its controller reports. */
export interface MillFigures {
  /** mm from the upper ends of the travel. */
  at: [number, number, number];
  steps: [number, number, number];
  /** CRC-32 of the edges since mark(), eight hex digits. */
  edges: string;
  inputs: number;
  /** 0 to 1. */
  spindle: number;
  flood: boolean;
  mist: boolean;
}

export class MillCore {
  private readonly exports: Exports;

  /** plate: height of the probe plate over the tool's first place, mm; null: there is none. Throws where the settings are refused. */
  constructor(module: WebAssembly.Module, settings: string, plate: number | null) {
    this.exports = instanceOf(module) as unknown as Exports;
    this.put(new TextEncoder().encode(settings));
    if (this.exports.cusp_mill_open(plate ?? NaN) === 0) throw new Error("the mill's settings are refused");
  }

  /** Bytes to the controller; what it answers at once. */
  send(bytes: Uint8Array): Uint8Array {
    this.put(bytes);
    return this.answers(this.exports.cusp_mill_send());
  }

  /** A servo tick of a millisecond; what the controller sends in it. */
  tick(): Uint8Array { return this.answers(this.exports.cusp_mill_tick()); }

  mark(): void { this.exports.cusp_mill_mark(); }
  /** Bits of InputBit that read so, whatever the switches say. */
  inputs(high: number, low: number): void { this.exports.cusp_mill_inputs(high, low); }
  plate(height: number): void { this.exports.cusp_mill_plate(height); }
  power(on: boolean): void { this.exports.cusp_mill_power(on ? 1 : 0); }

  figures(): MillFigures {
    const f = new Float64Array(this.exports.memory.buffer, this.exports.cusp_mill_figures(), kFigures);
    return {
      at: [f[0], f[1], f[2]], steps: [f[3], f[4], f[5]], edges: f[6].toString(16).padStart(8, "0"),
      inputs: f[7], spindle: f[8], flood: f[9] !== 0, mist: f[10] !== 0,
    };
  }

  private put(bytes: Uint8Array): void {
    const place = this.exports.cusp_text(bytes.length);
    new Uint8Array(this.exports.memory.buffer, place, bytes.length).set(bytes);
  }

  private answers(size: number): Uint8Array {
    return size === 0 ? kNothing : new Uint8Array(this.exports.memory.buffer, this.exports.cusp_mill_answers(), size).slice();
  }
}

const kNothing = new Uint8Array();
