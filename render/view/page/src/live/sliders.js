/** Sliders for the numbers of Params: each with its name, a range and a field for any number. */
import { el } from "../ui/dom.js";
import { newest } from "./connection.js";

export class Sliders {
  /**
   * @param {(values: Record<string, number>, final: boolean) => void} moved
   * @param {(held: boolean) => void} hold while a finger or the mouse is on a slider
   */
  constructor(moved, hold) {
    this.moved = moved;
    this.hold = hold;
    this.element = el("div", { class: "sliders" });
    this.rows = new Map();
    this.quick = newest(([name, value]) => this.moved({ [name]: value }, false));
  }

  /** @param {{name: string, value: number, low: number, high: number, step: number, whole: boolean, label: string, unit: string}[]} numbers */
  take(numbers, values) {
    const same = numbers.length === this.rows.size && numbers.every(({ name }) => this.rows.has(name));
    if (!same) {
      this.rows.clear();
      this.element.replaceChildren(...numbers.map((number) => this.row(number)));
    }
    for (const number of numbers) {
      const row = this.rows.get(number.name);
      row.number = number;
      row.words.textContent = number.label;
      row.words.title = number.name;
      row.unit.textContent = number.unit;
      row.range.setAttribute("aria-label", number.label);
      Object.assign(row.range, { min: number.low, max: number.high, step: number.whole ? 1 : "any" });
      row.field.step = number.whole ? 1 : "any";
    }
    this.show(values);
  }

  row(number) {
    const { name } = number, id = `live-${name}`;
    const words = el("label", { for: id }), unit = el("span", { class: "unit" });
    const range = el("input", { type: "range", id, class: "scrub" });
    const field = el("input", { type: "number", class: "number", "aria-label": `${number.label}, as a number` });
    const back = el("button", { type: "button", class: "back", title: "As the file has it", "aria-label": `${number.label} as the file has it` }, "↺");
    const row = { number, words, unit, range, field, back, typed: false };
    this.rows.set(name, row);
    const send = (value, final) => {
      if (!Number.isFinite(value)) return void this.put(row, this.values?.[name]);
      this.put(row, value);
      if (final) {
        this.quick.drop();
        this.moved({ [name]: value }, true);
      } else this.quick([name, value]);
    };
    range.addEventListener("input", () => send(rounded(range.valueAsNumber, row.number), false));
    range.addEventListener("change", () => send(rounded(range.valueAsNumber, row.number), true));
    field.addEventListener("input", () => { row.typed = true; });
    field.addEventListener("change", () => { row.typed = false; send(field.valueAsNumber, true); });
    field.addEventListener("blur", () => { row.typed = false; this.put(row, this.values?.[name]); });
    back.addEventListener("click", () => send(row.number.value, true));
    range.addEventListener("pointerdown", () => { this.held = name; this.hold(true); });
    for (const end of ["pointerup", "pointercancel", "blur"]) range.addEventListener(end, () => { this.held = null; this.hold(false); });
    return el("div", { class: "slide" }, words, range, field, unit, back);
  }

  /** Show the numbers that differ from the file; the one that is being dragged or typed is left alone. */
  show(values) {
    this.values = values;
    for (const [name, row] of this.rows) if (name !== this.held) this.put(row, values[name]);
  }

  put(row, value) {
    const { number, range, field, back } = row, now = value ?? number.value;
    range.min = Math.min(number.low, now);
    range.max = Math.max(number.high, now);
    range.value = now;
    range.style.setProperty("--part", String((now - range.min) / (range.max - range.min || 1)));
    range.setAttribute("aria-valuetext", shown(now));
    if (!row.typed) field.value = shown(now);
    back.hidden = now === number.value;
  }
}

/** To a step of the slider, without the digits that binary fractions add. */
function rounded(value, { step, whole }) {
  return whole ? Math.round(value) : Number((Math.round(value / step) * step).toPrecision(12));
}

const shown = (value) => String(Number(value.toPrecision(7)));
