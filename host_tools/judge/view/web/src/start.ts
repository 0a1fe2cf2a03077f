// Unpacks the page's script and runs it. Until then `window.cusp` has `ready` only.
import { inflate } from "./inflate";

async function start(): Promise<void> {
  const packed = document.getElementById("packed-script")!, text = atob(packed.textContent), bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k);
  const script = document.createElement("script");
  script.text = new TextDecoder().decode(await inflate(bytes));
  packed.replaceWith(script);
  await (window as unknown as { cusp: { ready: Promise<void> } }).cusp.ready;
}

const ready = start();
ready.catch((reason: unknown) => {
  const app = document.getElementById("app")!;
  if (!app.hasChildNodes()) app.textContent = String(reason);
});
Object.assign(window, { cusp: { ready } });
