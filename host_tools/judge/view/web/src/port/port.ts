// A port: bytes to and from a controller, and the clock by which its sender lives.

export interface PortEvents {
  take: (bytes: Uint8Array) => void;
  /** Some fifty times a second of the port's clock. */
  beat: () => void;
  /** Once: the controller can no longer be reached. */
  lost: (why: string) => void;
}

export interface Port {
  /** Rejects where the port can't be opened. */
  open(events: PortEvents): Promise<void>;
  /** Bytes go out in order; a port that is lost drops them. */
  write(bytes: Uint8Array): void;
  /** ms, steady. A virtual mill that runs faster has a faster clock. */
  now(): number;
  /** A program begins. */
  begin(): void;
  close(): Promise<void>;
}

/** ms between beats. */
export const kBeat = 20;
