// Shared by both pages: sections, dialogs, light and dark, licences.
import licences from "licences";
import { button, element } from "./elements";

export const place = (name: string, label: string): HTMLElement => element("section", { class: name, "aria-label": label });

const systemDark = matchMedia("(prefers-color-scheme: dark)");
export const isDark = (): boolean => (document.documentElement.dataset.theme ?? (systemDark.matches ? "dark" : "light")) === "dark";

export function dialog(title: string, ...content: Node[]): HTMLDialogElement {
  const out = element("dialog", { "aria-label": title }, element("h2", {}, title), ...content);
  out.append(button("Close", "Close", () => out.close()));
  document.body.append(out);
  return out;
}

// The buttons of light and dark, and of licences.
export function frameButtons(restyle: () => void): [HTMLButtonElement, HTMLButtonElement] {
  const title = "Licences of what this page holds", rights = dialog(title, element("pre", { tabindex: "0" }, licences));
  systemDark.addEventListener("change", restyle);
  return [button("Light or dark", "Change between light and dark", () => {
    document.documentElement.dataset.theme = isDark() ? "light" : "dark";
    restyle();
  }), button("Licences", title, () => rights.showModal())];
}
