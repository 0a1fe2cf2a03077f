// Bytes of a controller to lines. Bytes that no answer holds come of a bad line: they are left out.

const kLongest = 4096;

export class LineReader {
  private text = "";

  constructor(private readonly take: (line: string) => void) {}

  put(bytes: Uint8Array): void {
    for (const byte of bytes) {
      if (byte === 10 || byte === 13) {
        const line = this.text;
        this.text = "";
        if (line !== "") this.take(line);
      } else if (byte >= 32 && byte <= 126 && this.text.length < kLongest) this.text += String.fromCharCode(byte);
    }
  }
}
