/**
 * The motion at any moment: the quintic Hermite of the film (render/film/poses.py), and straight lines for loads.
 * Rows right before and right after an event share a time; at that time the later counts.
 *
 * @typedef {{x: number, y: number, theta: number}} Pose
 * @typedef {{body: string, x?: number, y?: number}} End  a point of a body, in its frame (m)
 */

import { KINDS } from "./kinds.js";

const REST = { x: 0, y: 0, theta: 0 };

export class Motion {
  /** @param {import("./decode.js").Payload} payload */
  constructor(payload) {
    this.payload = payload;
    /** @type {Float64Array} */
    this.time = payload.time;
    this.starts = [];
    for (let k = 0; k + 1 < this.time.length; k++) if (this.time[k + 1] > this.time[k]) this.starts.push(k);
    this.index = 0;
    this.part = 0;
    this.weights = new Float64Array(6);
    this.t = NaN;
    this.to(this.time[0]);
  }

  get start() { return this.time[0]; }
  get end() { return this.time[this.time.length - 1]; }

  /** Go to a time (s); it is held within the motion. */
  to(t) {
    t = Math.min(Math.max(t, this.start), this.end);
    if (t === this.t || !this.starts.length) return;
    this.t = t;
    const { starts, time } = this;
    let low = 0, high = starts.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (time[starts[middle]] <= t) low = middle; else high = middle - 1;
    }
    const i = this.index = starts[low];
    const h = time[i + 1] - time[i], s = this.part = (t - time[i]) / h;
    const s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
    this.weights.set([
      1 - 10 * s3 + 15 * s4 - 6 * s5, h * (s - 6 * s3 + 8 * s4 - 3 * s5), h * h * (0.5 * s2 - 1.5 * s3 + 1.5 * s4 - 0.5 * s5),
      10 * s3 - 15 * s4 + 6 * s5, h * (-4 * s3 + 7 * s4 - 3 * s5), h * h * (0.5 * s3 - s4 + 0.5 * s5),
    ]);
  }

  /** Quintic of a series with its rates and accelerations. */
  smooth(value, rate, acceleration) {
    const i = this.index, w = this.weights;
    return w[0] * value[i] + w[1] * rate[i] + w[2] * acceleration[i]
      + w[3] * value[i + 1] + w[4] * rate[i + 1] + w[5] * acceleration[i + 1];
  }

  /** A series by straight lines; `stride` and `offset` of arrays with several numbers a time. */
  linear(series, stride = 1, offset = 0) {
    const k = this.index * stride + offset;
    return series[k] + this.part * (series[k + stride] - series[k]);
  }

  /** @param {string} name  @returns {Pose} */
  body(name) {
    const body = this.payload.bodies[name];
    if (!body) return REST;
    return {
      x: this.smooth(body.x, body.vx, body.ax),
      y: this.smooth(body.y, body.vy, body.ay),
      theta: this.smooth(body.theta, body.omega, body.alpha),
    };
  }

  /** @param {End} end  @returns {[number, number]} */
  place(end) {
    const { x, y, theta } = this.body(end.body);
    const c = Math.cos(theta), s = Math.sin(theta), u = end.x ?? 0, v = end.y ?? 0;
    return [x + c * u - s * v, y + s * u + c * v];
  }

  /** @param {string} name  @returns {[number, number]} */
  joint(name) { return this.place(this.payload.joints[name].at); }

  /** @param {string} name  @returns {[number, number]} */
  point(name) {
    const point = this.payload.points[name];
    return [this.smooth(point.x, point.vx, point.ax), this.smooth(point.y, point.vy, point.ay)];
  }

  /** Centre of mass. @param {string} name  @returns {[number, number]} */
  centre(name) {
    const [x, y] = this.payload.bodies[name].com;
    return this.place({ body: name, x, y });
  }

  /** Where a joint, point or body is among the parts. @returns {[number, number, number]} */
  spot(kind, name) {
    const [x, y] = kind === "joint" ? this.joint(name) : kind === "point" ? this.point(name) : this.centre(name);
    return [x, y, this.payload.solid?.heights[KINDS[kind]]?.[name] ?? 0];
  }

  /** A point of a body among the parts. @returns {[number, number, number]} */
  where({ z = 0, ...end }) { return [...this.place(end), z]; }

  /** A place in the 2D view, and the way that a torque turns there. */
  flat(place) { return place; }
  facing() { return 1; }

  /** All bodies at the moment. @returns {Record<string, Pose>} */
  poses() {
    return Object.fromEntries(Object.keys(this.payload.bodies).map((name) => [name, this.body(name)]));
  }
}
