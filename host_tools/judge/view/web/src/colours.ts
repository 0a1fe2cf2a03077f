// Colours for numbers: scales with an order that the colour-blind can see, in light and dark.

export type Rgb = [number, number, number];

const hex = (text: string): Rgb => [0, 2, 4].map((k) => parseInt(text.slice(k, k + 2), 16)) as Rgb;

const viridis = "440154 472d7b 3b528b 2c728e 21918c 28ae80 5ec962 addc30 fde725".split(" ").map(hex);
const cividis = "00224e 123570 3b496c 575d6d 707173 8a8678 a59c74 c3b369 e1cc55 fee838".split(" ").map(hex);
// Palette of Okabe and Ito; the first colour means none.
const kinds = "8a8f98 0072b2 e69f00 009e73 cc79a7 56b4e9 d55e00 b8a900".split(" ").map(hex);
// Gouged, in tolerance, left: the usual colours of CAM programs, and a scale for the colour-blind.
const usual = "8b0000 e02020 f2a33c 3cb44b 35a7a0 2a6fe0 10206f".split(" ").map(hex);
const safe = "7f2704 d94801 fdae6b e8e8e8 9ecae1 3182bd 08306b".split(" ").map(hex);

// The colour at a fraction, 0 to 1, of a list of colours.
function between(list: Rgb[], share: number): Rgb {
  const at = Math.min(Math.max(share, 0), 1) * (list.length - 1);
  const k = Math.min(Math.floor(at), list.length - 2), part = at - k;
  return [0, 1, 2].map((c) => list[k][c] + (list[k + 1][c] - list[k][c]) * part) as Rgb;
}

export type ScaleName = "viridis" | "cividis" | "kinds" | "left";

export interface Look { dark: boolean; safe: boolean }

// 256 colours as bytes RGBA, without ends that are too close to the background.
export function scaleTable(name: ScaleName, look: Look): Uint8Array {
  const table = new Uint8Array(1024);
  for (let k = 0; k < 256; ++k) {
    const share = k / 255;
    let colour: Rgb;
    if (name === "kinds") colour = kinds[k === 0 ? 0 : 1 + (k - 1) % 7];
    else if (name === "left") colour = between(look.safe ? safe : usual, share);
    else {
      const list = name === "viridis" ? viridis : cividis;
      colour = between(list, look.dark ? 0.22 + 0.78 * share : 0.9 * share);
    }
    table.set([...colour.map(Math.round), 255], 4 * k);
  }
  return table;
}

export function cssOf(table: Uint8Array, k: number): string {
  return `rgb(${table[4 * k]} ${table[4 * k + 1]} ${table[4 * k + 2]})`;
}

// A scale as a CSS background.
export function gradientOf(table: Uint8Array): string {
  const stops = Array.from({ length: 17 }, (_, k) => cssOf(table, Math.round(k * 255 / 16)));
  return `linear-gradient(90deg, ${stops.join(", ")})`;
}

export const axisColours = (dark: boolean): string[] => dark ? ["#ff8a4c", "#2fc49a", "#6db3ff"] : ["#c04a00", "#007a5a", "#0060b0"];
