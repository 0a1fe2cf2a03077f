// The worker that sends: a session and its port, away from what slows or hides a page.
import { MillCore } from "../port/mill_core";
import { MillPort } from "../port/mill_port";
import { browserSerial, openSerial, SerialStreamPort } from "../port/serial_port";
import type { BrowserSerialPort } from "../port/serial_port";
import type { FromSender, ToSender } from "./messages";
import { Session } from "./session";

const kNews = 100;   // ms between pictures

const scope = self as unknown as { onmessage: (event: MessageEvent<ToSender>) => void; postMessage(message: FromSender): void };

let mill: MillPort | null = null, rate = 1, changed = false;

const session: Session = new Session(() => { changed = true; });

// A mill may be faster while it cuts: a person's clock counts otherwise.
function tell(): void {
  if (mill) mill.rate = session.isCutting ? rate : 1;
  const figures = mill?.mill.figures();
  scope.postMessage({ kind: "news", now: session.snapshot(), mill: figures ? { edges: figures.edges, at: figures.at } : null });
}

let told = 0;
setInterval(() => {
  const now = performance.now();
  if (!changed && now - told < kNews) return;
  [changed, told] = [false, now];
  tell();
}, 20);

async function openMill(message: Extract<ToSender, { kind: "mill" }>): Promise<void> {
  rate = message.rate;
  const port = new MillPort(new MillCore(message.module, message.settings, message.plate), 1);
  await session.open(port, "the virtual mill");
  mill = port;
}

async function openBrowserPort(port: BrowserSerialPort, name: string, baud: number): Promise<void> {
  const opened = new SerialStreamPort(async () => {
    await openSerial(port, baud);
    if (!port.readable || !port.writable) throw new Error("the port has no streams");
    return { readable: port.readable, writable: port.writable };
  }, () => port.close(), () => port.readable);
  port.addEventListener?.("disconnect", () => { opened.lose("it was unplugged"); });
  await session.open(opened, name);
}

async function openSerialAt({ index, name, baud }: Extract<ToSender, { kind: "serial" }>): Promise<void> {
  mill = null;
  const port = (await browserSerial()?.getPorts().catch(() => []))?.at(index);
  if (port) await openBrowserPort(port, name, baud);
  else scope.postMessage({ kind: "wantsStreams" });
}

async function openStreams({ readable, writable, name }: Extract<ToSender, { kind: "streams" }>): Promise<void> {
  mill = null;
  const closed = (): Promise<void> => {
    scope.postMessage({ kind: "closed" });
    return Promise.resolve();
  };
  await session.open(new SerialStreamPort(() => Promise.resolve({ readable, writable }), closed), name);
}

async function answer(id: number, act: () => unknown): Promise<void> {
  let outcome: unknown = null, refusal = "";
  try {
    outcome = await act() ?? null;
  } catch (reason) {
    refusal = reason instanceof Error ? reason.message : String(reason);
  }
  tell();  // so that who has asked sees what came of it
  scope.postMessage({ kind: "done", id, outcome: outcome as never, refusal });
}

async function take(message: ToSender): Promise<void> {
  switch (message.kind) {
    case "mill": return openMill(message);
    case "serial": return openSerialAt(message);
    case "streams": return openStreams(message);
    case "close":
      await session.close();
      mill = null;
      return;
    case "rate":
      rate = message.rate;
      return;
    case "begin": return answer(message.id, () => { session.begin(message.lines); });
    case "goOn": return answer(message.id, () => { session.goOn(); });
    case "command": return answer(message.id, () => session.command(message.text));
    case "refresh": return answer(message.id, () => session.refresh());
    case "facts": return answer(message.id, () => session.resumeFacts());
    case "realtime": session.realtime(message.byte); return;
    case "hold": session.hold(); return;
    case "resume": session.resume(); return;
    case "stop": session.stop(); return;
    case "reset": session.reset(); return;
    case "forget": session.forget(); return;
    case "jogStep": session.jogStep(message.direction, message.distance, message.feed); return;
    case "jogBegin": session.jogBegin(message.direction, message.feed); return;
    case "jogKeep": session.jogKeep(); return;
    case "jogEnd": session.jogEnd(); return;
  }
}

scope.onmessage = ({ data }) => {
  take(data).then(tell, (reason: unknown) => {
    if (data.kind === "jogStep" || data.kind === "jogBegin") return;
    throw reason;
  });
};
