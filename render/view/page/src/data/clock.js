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

  /** "in real time", "slowed 20 times". */
  said(speed) {
    const rate = this.rate * speed;
    if (Math.abs(rate - 1) < 0.02) return "real time";
    return rate < 1 ? `slowed ${figures(1 / rate)}×` : `${figures(rate)}× faster`;
  }
}

const figures = (x) => String(Number(x.toPrecision(3)));
const mod = (a, b) => ((a % b) + b) % b;
