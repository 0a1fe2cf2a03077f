// A navigator.serial for tests, in a page or a worker: its one port leads to the virtual mill over a line with faults. esbuild bundles it;
// fakeSerial(base64 of the core, options) puts it in place. `globalThis.fake` is the test's hand at cable and mill.
import { MillCore } from "./src/port/mill_core";
import { FaultyLine, numbers } from "./faulty_port.mjs";

const text = (bytes) => String.fromCharCode(...bytes), bytesOf = (all) => Uint8Array.from(all, (c) => c.charCodeAt(0));

class FakePort extends EventTarget {
  constructor(mill, { seed, faults, grbl, rate }) {
    super();
    const random = numbers(seed);
    Object.assign(this, { mill, grbl, rate, plugged: true, sent: "", waiting: [], readable: null, writable: null, opened: 0 });
    [this.to, this.from] = [new FaultyLine(random, faults), new FaultyLine(random, faults)];
    let before = performance.now(), due = 0;
    setInterval(() => {
      const now = performance.now();
      due = Math.min(due + (now - before) * this.rate, 2000);
      before = now;
      for (; due >= 1; due -= 1) this.tick();
    }, 5);
  }

  getInfo() { return { usbVendorId: 0x1209, usbProductId: 0xc05b }; }

  open() {
    if (!this.plugged) return Promise.reject(new DOMException("Failed to open serial port.", "NetworkError"));
    this.opened += 1;
    this.readable = new ReadableStream({ start: (source) => { this.source = source; } });
    this.writable = new WritableStream({
      start: (sink) => { this.sink = sink; },
      write: (bytes) => { this.sent += text(bytes); this.waiting.push(this.to.pass(bytes)); },
    });
    return Promise.resolve();
  }
  close() {
    [this.readable, this.writable, this.source, this.sink] = [null, null, null, null];
    return Promise.resolve();
  }

  unplug() {
    this.plugged = false;
    const why = new DOMException("The device has been lost.", "NetworkError"), { source, sink } = this;
    this.waiting = [];
    [this.readable, this.writable, this.source, this.sink] = [null, null, null, null];
    source?.error(why);
    sink?.error(why);
    this.dispatchEvent(new Event("disconnect"));
  }
  plug() { this.plugged = true; }

  tick() {
    for (let bytes = this.waiting.shift(); bytes; bytes = this.waiting.shift()) {
      this.answer(this.mill.send(this.grbl ? bytesOf(text(bytes).replace("$CRC=1", "$XYZ=1")) : bytes));
    }
    this.answer(this.mill.tick());
  }
  answer(given) {
    if (given.length === 0) return;
    const bytes = this.grbl ? bytesOf(text(given).replace(/\[OPT:.*\]/, "[OPT:V,15,128]")) : given;
    const arrived = this.from.pass(bytes);
    if (arrived.length > 0) this.source?.enqueue(arrived);
  }
}

globalThis.fakeSerial = async (core, { seed = 1, faults = {}, grbl = false, settings = "", plate = -20, rate = 1 } = {}) => {
  const module = await WebAssembly.compile(bytesOf(atob(core)));
  const port = new FakePort(new MillCore(module, settings, plate), { seed, faults, grbl, rate });
  globalThis.fake = port;
  Object.defineProperty(navigator, "serial", { configurable: true, value: { requestPort: () => Promise.resolve(port), getPorts: () => Promise.resolve([port]) } });
};
// For a page whose worker has the port: a name for a person to choose.
globalThis.fakeName = () => {
  const port = { getInfo: () => ({ usbVendorId: 0x1209, usbProductId: 0xc05b }) };
  Object.defineProperty(navigator, "serial", { configurable: true, value: { requestPort: () => Promise.resolve(port), getPorts: () => Promise.resolve([port]) } });
};
// Where a worker has no ports, as it is told.
globalThis.noSerial = () => { Object.defineProperty(navigator, "serial", { configurable: true, value: undefined }); };
