/** Sliders that look into the machine: how far it is taken apart, and how much of it is cut away from which side. */
import { el } from "./dom.js";

const SIDES = { front: "from the front", side: "from the side", top: "from above", quarter: "a quarter", film: "as in the film" };

/** @param {import("../app.js").App} app  @returns {HTMLElement} */
export function inside(app) {
  const { store } = app;
  const range = (word, label) => {
    const input = el("input", { type: "range", class: "scrub", min: 0, max: 1, step: "any", value: 0, "aria-label": label });
    input.addEventListener("input", () => store.set({ [word]: input.valueAsNumber }));
    return input;
  };
  const apart = range("apart", "Exploded"), cut = range("cut", "Section");
  const side = el("select", { class: "side-of", "aria-label": "Side of the section" }, ...Object.entries(SIDES).filter(([value]) => value !== "film" || app.payload.solid?.sawn).map(([value, words]) => el("option", { value }, words)));
  side.addEventListener("change", () => store.set({ cutSide: side.value }));
  const layers = el("label", {}, "Exploded", apart);
  const box = el("div", { class: "inside", role: "group", "aria-label": "Inside" },
    layers, el("label", {}, "Section", cut), side);
  const show = () => {
    const { apart: now, cut: away } = store.state;
    for (const [input, value] of [[apart, now], [cut, away]]) {
      if (input.valueAsNumber !== value) input.value = value;
      input.style.setProperty("--part", String(value));
      input.setAttribute("aria-valuetext", `${Math.round(100 * value)} %`);
    }
    side.value = store.state.cutSide;
    side.hidden = !away;
    box.hidden = !app.payload.solid;
    layers.hidden = !!app.payload.space;
  };
  store.on(["apart", "cut", "cutSide"], show, true);
  box.update = show;
  return box;
}
