// CRC-32 (IEEE 802.3) of a text of ASCII, as checked lines have it: docs/protocol.md.

const table = Uint32Array.from({ length: 256 }, (_, byte) => {
  let remainder = byte;
  for (let bit = 0; bit < 8; ++bit) remainder = (remainder >>> 1) ^ ((remainder & 1) === 0 ? 0 : 0xEDB88320);
  return remainder;
});

/** Eight hexadecimal digits. */
export function crc32(text: string): string {
  let remainder = 0xFFFFFFFF;
  for (let k = 0; k < text.length; ++k) remainder = (remainder >>> 8) ^ table[(remainder ^ text.charCodeAt(k)) & 255];
  return (~remainder >>> 0).toString(16).toUpperCase().padStart(8, "0");
}

/** A line as it is sent, without line end. */
export const checkedLine = (number: number, text: string): string => `N${number}${text}*${crc32(`N${number}${text}`)}`;

/** The text before a checksum that is right; null: there is none, or it is wrong. */
export function checkedText(line: string): string | null {
  const star = line.length - 9, text = line.slice(0, Math.max(star, 0));
  return star > 0 && line[star] === "*" && line.slice(star + 1).toUpperCase() === crc32(text) ? text : null;
}
