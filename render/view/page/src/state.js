/**
 * What the page is showing, in one place: who changes something sets it here, who shows it listens.
 *
 * @typedef {{kind: "joint" | "body" | "driver" | "point" | "force" | "contact", name: string}} Thing
 * @typedef {object} State
 * @property {number} time          s of the motion
 * @property {boolean} playing
 * @property {number} speed         1: as the film
 * @property {Thing | null} selected
 * @property {"3d" | "2d"} view
 * @property {"auto" | "dark" | "light"} theme
 * @property {number} apart         how far the parts are taken apart, 0 .. 1
 * @property {number} cut           how much of them is cut away, 0 .. 1, from the side cutSide
 * @property {"front" | "side" | "top" | "quarter" | "film"} cutSide   film: as the shot says, whatever cut is
 * @property {Record<string, boolean>} shown   by the words of ui/shown.js
 */
export class Store {
  /** @param {State} state */
  constructor(state) {
    this.state = state;
    /** @type {[string[], (state: State) => void][]} */
    this.listeners = [];
  }

  /** Change some of it; listeners of what is really other are called. @param {Partial<State>} change */
  set(change) {
    const changed = Object.keys(change).filter((key) => this.state[key] !== change[key]);
    if (!changed.length) return;
    Object.assign(this.state, change);
    for (const [keys, listener] of this.listeners) if (keys.some((key) => changed.includes(key))) listener(this.state);
  }

  /** @param {string[]} keys  @param {(state: State) => void} listener  @param {boolean} now call it at once, too */
  on(keys, listener, now = false) {
    this.listeners.push([keys, listener]);
    if (now) listener(this.state);
  }

  show(word, on) { this.set({ shown: { ...this.state.shown, [word]: on ?? !this.state.shown[word] } }); }
}

/** @param {Thing | null} a  @param {Thing | null} b */
export const same = (a, b) => a === b || (!!a && !!b && a.kind === b.kind && a.name === b.name);
