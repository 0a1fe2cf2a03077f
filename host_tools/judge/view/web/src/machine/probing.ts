// Touches with the probe: fast, back, slowly; then the place that was touched, from a listing that no lost byte has changed.
import { command, now, refresh } from "./machine";

export interface Touch { axis: 0 | 1 | 2; sign: 1 | -1; /** mm */ most: number; /** mm/min */ fast: number; slow: number }

const kBack = 2;      // mm
const kLetters = "XYZ";

/** The machine's coordinate of the axis where it touched, mm. Rejects with the alarm or error. The tool ends at the place. */
export async function touch({ axis, sign, most, fast, slow }: Touch): Promise<number> {
  const letter = kLetters[axis], way = (mm: number): string => `${letter}${(sign * mm).toFixed(3)}`;
  await command(`G21G91G94G38.2${way(most)}F${fast}`);
  await command(`G0${way(-Math.min(kBack, most / 2))}`);
  await command(`G38.2${way(2 * kBack)}F${slow}`);
  await refresh();
  const { probe } = now.value;
  if (!probe?.touched) throw new Error("the probe did not touch");
  const at = probe.at[axis];
  // Where it touched, not where it had stopped behind that.
  await command(`G90G53G1${letter}${at.toFixed(3)}F${fast}`);
  return at;
}

/** Away from the place, and back to the units and distances of before. */
export async function leave({ axis, sign }: Touch, mm: number, before: readonly string[]): Promise<void> {
  await command(`G21G91G0${kLetters[axis]}${(-sign * mm).toFixed(3)}`);
  await restore(before);
}

export async function restore(before: readonly string[]): Promise<void> {
  for (const word of before) if (/^G(20|21|90|91)$/.test(word)) await command(word);
}
