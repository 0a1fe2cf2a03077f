// The keys of a job's tables, from the schema that the program makes of its own: kind, range, default and help of each field.
import type { Calls, StrategyFacts, SuggestKey } from "../engine/engine";

export interface Key {
  name: string; kind: string; otherwise: string; help: string; choices: string[];
  low?: number; high?: number; aboveLow: boolean; needed: boolean;
}

interface SchemaKey {
  "x-kind"?: string; "x-default"?: string; description?: string; enum?: string[];
  minimum?: number; exclusiveMinimum?: number; maximum?: number; items?: SchemaKey;
}
interface SchemaTable { properties?: Record<string, SchemaKey> }
interface Schema {
  properties: Record<string, SchemaKey & SchemaTable>;
  definitions: Record<string, SchemaTable & { allOf?: { if: { properties: { strategy: { const: string } } }; then: SchemaTable }[] }>;
}

const unbounded = 1e6;  // the largest number of any key: no limit worth showing

function keyOf(name: string, given: SchemaKey): Key {
  const { items } = given, kind = given["x-kind"] ?? "text", otherwise = given["x-default"] ?? "none";
  return {
    name, kind, otherwise, help: given.description ?? "", choices: given.enum ?? [],
    low: given.exclusiveMinimum ?? given.minimum ?? items?.exclusiveMinimum ?? items?.minimum, high: given.maximum ?? items?.maximum,
    aboveLow: given.exclusiveMinimum !== undefined || items?.exclusiveMinimum !== undefined, needed: otherwise === "needed",
  };
}

const keysIn = (table: SchemaTable | undefined): Key[] => Object.entries(table?.properties ?? {}).map(([name, key]) => keyOf(name, key));

/** The tables of keys that fields are made of. */
export class KeyTables {
  readonly strategies: StrategyFacts[];
  readonly posts: string[];
  readonly suggest: SuggestKey[];
  private readonly schema: Schema;

  constructor(facts: Calls["keys"]["result"]) {
    this.schema = facts.schema as Schema;
    this.strategies = facts.strategies;
    this.posts = facts.posts;
    this.suggest = facts.suggest;
  }

  /** Of the top of a job: `units`, `post` and so on, without its tables. */
  top(): Key[] { return keysIn(this.schema).filter((key) => !key.kind.startsWith("table")); }

  table(name: string): Key[] { return keysIn(this.schema.definitions[name] ?? this.schema.properties[name]); }

  operation(strategy: string): Key[] {
    const own = this.schema.definitions.operation.allOf?.find((rule) => rule.if.properties.strategy.const === strategy);
    return keysIn(own?.then).filter((key) => key.name !== "strategy");
  }
}

/** The range in words: "above 0", "20 to 150"; "": any. */
export function rangeOf({ low, high, aboveLow }: Key): string {
  const least = low !== undefined && low > -unbounded ? low : undefined, most = high !== undefined && high < unbounded ? high : undefined;
  if (least !== undefined && most !== undefined) return `${least} to ${most}`;
  if (least !== undefined) return aboveLow ? `above ${least}` : `${least} or more`;
  return most === undefined ? "" : `at most ${most}`;
}

/** The unit of a kind, for a job in inches or millimetres. */
export function unitOf(kind: string, inch: boolean): string {
  const length = inch ? "in" : "mm";
  if (kind === "feed") return `${length}/min`;
  if (kind === "angle") return "°";
  return /length|least|pairs/.test(kind) ? length : "";
}
