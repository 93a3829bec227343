/** The list of keys, and the licences of what is in the page. */
import { el } from "./dom.js";
import { icon } from "./icons.js";
import { SHOWN } from "./shown.js";

const KEYS = [
  ["Space", "play, pause"],
  ["← →", "one frame of the film back or on; with Shift ten"],
  ["Home End", "start and end of the motion"],
  ["[ ]", "slower, faster"],
  ["3 2", "parts, skeleton"],
  ["+ − 0", "closer, farther, the whole machine"],
  ["j l i m", "look from the left, the right, above, below; the skeleton moves"],
  ["Esc", "nothing selected"],
  ["d", "dark, light, as the system has it"],
  ["s", "save the curves as CSV"],
  ["?", "this list"],
];

const MOUSE = [
  ["Click", "a joint or body shows its curves"],
  ["Drag", "turns the parts, moves the skeleton"],
  ["Right button, two fingers", "moves the parts"],
  ["Wheel, pinch", "closer, farther"],
  ["Drag on curves", "moves the machine"],
  ["Exploded, Section", "take the parts apart, cut them open"],
];

export function showHelp() {
  const table = (rows) => el("dl", {}, ...rows.flatMap(([key, words]) => [el("dt", {}, ...key.split(", ").flatMap((one, k) => [k ? ", " : "", el("kbd", {}, one)])), el("dd", {}, words)]));
  const shown = SHOWN.map(({ key, label }) => [key, label.toLowerCase()]);
  const licences = document.getElementById("mbsd-licences")?.textContent ?? "";
  const dialog = el("dialog", { class: "help", "aria-label": "Keys" },
    el("button", { type: "button", class: "round close", "aria-label": "Close", onclick: () => dialog.close() }, icon("close")),
    el("h2", {}, "Keys"), el("div", { class: "columns" }, table(KEYS), table(shown)),
    el("h2", {}, "Mouse and fingers"), table(MOUSE),
    licences ? el("details", {}, el("summary", {}, "Licences of three.js and µPlot"), el("pre", {}, licences)) : null);
  dialog.addEventListener("close", () => dialog.remove());
  dialog.addEventListener("click", (event) => event.target === dialog && dialog.close());
  document.querySelector(".mbsd").append(dialog);
  dialog.showModal();
}
