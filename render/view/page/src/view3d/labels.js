/** Words over the parts: names of joints, points and bodies, and gaps; each where its place is seen. */
import { Vector3 } from "three";
import { el } from "../ui/dom.js";

const place = new Vector3();
/** Pixels from the middle of a gap's ring to the line that leads to its words. */
const RING = 9;

export class Labels {
  /** @param {HTMLElement} layer */
  constructor(layer) {
    this.layer = layer;
    this.known = new Map();
  }

  /** @param {{key: string, text: string, at: [number, number, number], kind: string, act?: () => void}[]} wanted
   *  @param {(v: Vector3) => [number, number]} pixel */
  show(wanted, pixel) {
    const gone = new Set(this.known.keys()), taken = [], across = this.layer.clientWidth;
    for (const { key, text, at, kind, act } of wanted) {
      let one = this.known.get(key);
      if (!one) {
        one = act ? el("button", { class: "label", type: "button", "data-kind": kind, onclick: act }) : el("span", { class: "label", "data-kind": kind });
        this.known.set(key, one);
        this.layer.append(one);
      }
      gone.delete(key);
      if (one.textContent !== text) one.textContent = text;
      const [there, y] = pixel(place.set(...at));
      const width = 8 * text.length + 12, half = width / 2;
      // Words of a place that is seen are not cut off by the edge.
      const x = there < 0 || there > across || width > across ? there : Math.min(Math.max(there, half), across - half);
      let top = y - 13;
      for (let k = 0; k < 6 && taken.some(([a, b, w]) => Math.abs(a - x) < (w + width) / 2 && Math.abs(b - top) < 19); k++) top -= 19;
      taken.push([x, top, width]);
      one.style.setProperty("--lean", `${(there - x).toFixed(1)}px`);
      one.style.setProperty("--rise", `${(y - top - RING).toFixed(1)}px`);
      one.style.transform = `translate(${x.toFixed(1)}px, ${top.toFixed(1)}px) translate(-50%, -100%)`;
    }
    for (const key of gone) {
      this.known.get(key).remove();
      this.known.delete(key);
    }
  }
}
