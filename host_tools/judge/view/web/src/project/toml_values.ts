// Values of a job as a person types them into a field, and as TOML.

/** A value as TOML, on one line. */
export function tomlOf(value: unknown): string {
  if (typeof value === "string") return quoted(value);
  if (Array.isArray(value)) return `[${value.map(tomlOf).join(", ")}]`;
  if (typeof value === "object" && value !== null) return `{ ${Object.entries(value).map(([key, part]) => `${key} = ${tomlOf(part)}`).join(", ")} }`;
  return String(value);
}

export const quotedList = (texts: string[]): string => `[${texts.map(quoted).join(", ")}]`;

function quoted(text: string): string {
  // JSON's escapes are TOML's, but that DEL must be escaped too
  return JSON.stringify(text).replace(/\u007f/g, "\\u007f");
}

/** The text by which a field shows a value: numbers and texts plain, lists by commas, pairs in brackets. */
export function shown(value: unknown): string {
  if (value === undefined || value === null) return "";
  if (Array.isArray(value)) return value.map((part) => Array.isArray(part) ? `[${shown(part)}]` : shown(part)).join(", ");
  return typeof value === "string" ? value : tomlOf(value);
}

const kNumber = /^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$/;

// TOML wants digits on both sides of a point.
function numberOf(text: string): string {
  if (!kNumber.test(text)) throw new RangeError(`"${text}" is not a number`);
  return text.replace(/^([-+]?)\./, "$10.").replace(/\.(?=$|[eE])/, ".0");
}

const partsOf = (text: string): string[] => text.replace(/^\[(.*)\]$/s, "$1").split(",").map((part) => part.trim()).filter((part) => part !== "");

/** The content of a field, as TOML; undefined: the key is not given. `kind` is the key's, as the schema names it. */
export function typed(kind: string, text: string): string | undefined {
  const given = text.trim();
  if (given === "") return undefined;
  const numbers = () => partsOf(given).map(numberOf);
  switch (kind) {
    case "length": case "feed": case "number": case "angle": case "whole number": return numberOf(given);
    case "true or false": return given;
    case "choice": case "text": return quoted(given);
    case "text or list of texts": {
      const parts = partsOf(given);
      return parts.length === 1 ? quoted(parts[0]) : `[${parts.map(quoted).join(", ")}]`;
    }
    case "list of texts": return `[${partsOf(given).map(quoted).join(", ")}]`;
    case "tool": return toolOf(given);
    case "list of tools": return `[${partsOf(given).map(toolOf).join(", ")}]`;
    case "list of lengths": case "[least, greatest]": return `[${numbers().join(", ")}]`;
    case "length or two": case "number or list": case "length or [least, greatest]": {
      const list = numbers();
      return list.length === 1 ? list[0] : `[${list.join(", ")}]`;
    }
    case "list of pairs": return `[${[...given.matchAll(/\[([^[\]]*)\]/g)].map(([, pair]) => `[${partsOf(pair).map(numberOf).join(", ")}]`).join(", ")}]`;
    default: return given;
  }
}

const toolOf = (text: string): string => /^\d+$/.test(text) ? text : quoted(text);
