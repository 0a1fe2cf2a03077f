// Unpacks the page's script and runs it at once, so that window.cusp exists for everything after it.
import { inflateSync, strFromU8 } from "fflate";

const packed = document.getElementById("packed-script")!;
const script = document.createElement("script");
script.text = strFromU8(inflateSync(Uint8Array.from(atob(packed.textContent), (character) => character.charCodeAt(0))));
packed.replaceWith(script);
