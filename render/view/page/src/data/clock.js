import { figures } from "./numbers.js";

/**
 * How the motion is shown (render/film/clock.py): one with a period turns on without a seam; one without plays
 * forwards, holds at its end and begins anew.
 */
export class Clock {
  /** @param {import("./decode.js").Payload} payload */
  constructor(payload) {
    const clock = payload.clock;
    this.start = clock.start;
    this.end = clock.end;
    this.repeats = payload.period !== null;
    /** Seconds of the motion in a second of film. */
    this.rate = (clock.end - clock.start) / clock.seconds;
    this.hold = clock.hold;
    this.frame = this.rate / clock.fps;
    this.held = 0;
  }

  /** The time (s) after `passed` seconds before the screen, at a speed (1: as the film). */
  after(t, passed, speed) {
    const span = this.end - this.start;
    let next = t + passed * speed * this.rate;
    if (this.repeats) return this.start + mod(next - this.start, span);
    if (next < this.end) { this.held = 0; return next; }
    this.held += passed;
    if (this.held < this.hold) return this.end;
    this.held = 0;
    return this.start;
  }

  /** The time some frames of the film on, or back. */
  step(t, frames) {
    const next = t + frames * this.frame;
    if (this.repeats) return this.start + mod(next - this.start, this.end - this.start);
    return Math.min(Math.max(next, this.start), this.end);
  }

  /** A speed (1: as the film) beside the machine's own: "1/4 speed", "real time". */
  said(speed) {
    const rate = this.rate * speed, parts = 1 / rate, whole = Number(Math.round(parts).toPrecision(2));
    if (Math.abs(rate - 1) < 0.02) return "real time";
    if (rate > 1) return `${figures(rate, 2)}× speed`;
    return parts >= 10 || Math.abs(parts - whole) < 0.02 * parts ? `1/${whole} speed` : `${figures(rate, 2)} speed`;
  }

  /** Speeds to choose from, in rising order: the film's, 1, and round ones of the machine around it. */
  speeds() {
    const round = [];
    for (let decade = Math.floor(Math.log10(this.rate)) - 2; decade <= Math.log10(this.rate) + 2; decade++) {
      for (const step of [1, 2, 5]) round.push((step * 10 ** decade) / this.rate);
    }
    return [...round.filter((speed) => speed > 1 / 25 && speed < 12 && Math.abs(Math.log(speed)) > 0.15), 1].sort((a, b) => a - b);
  }
}

const mod = (a, b) => ((a % b) + b) % b;
