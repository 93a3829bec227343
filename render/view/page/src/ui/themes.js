/** Dark and light: as the system has it until somebody chooses. */
import { icon } from "./icons.js";

const NEXT = { auto: "light", light: "dark", dark: "auto" };
const ICONS = { auto: "half", light: "sun", dark: "moon" };
const WORDS = { auto: "as the system", light: "light", dark: "dark" };

/** @param {import("../app.js").App} app */
export function themes(app) {
  const system = matchMedia("(prefers-color-scheme: dark)"), { root, themeButton } = app.parts;
  const self = { dark: system.matches };
  const apply = () => {
    const { theme } = app.store.state;
    self.dark = theme === "auto" ? system.matches : theme === "dark";
    root.dataset.theme = self.dark ? "dark" : "light";
    themeButton.replaceChildren(icon(ICONS[theme]));
    themeButton.title = `Colours: ${WORDS[theme]} (d)`;
    themeButton.setAttribute("aria-label", themeButton.title);
    self.changed?.();
    app.redraw?.();
  };
  system.addEventListener("change", apply);
  themeButton.addEventListener("click", () => self.next());
  self.next = () => app.store.set({ theme: NEXT[app.store.state.theme] });
  app.store.on(["theme"], apply, true);
  return self;
}
