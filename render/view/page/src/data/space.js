/**
 * The motion of a machine in space at any moment: places and quaternions by the quintics of the film
 * (render/film/space.py). The 2D view sees it along payload.view: two rows, right and up of the picture.
 *
 * @typedef {[number, number, number]} Place  m
 * @typedef {{place: Place, turned: number[]}} Pose  of a body's frame; the quaternion (w, x, y, z) of length 1
 */
import { Motion } from "./motion.js";

/** @type {Pose} */
const REST = { place: [0, 0, 0], turned: [1, 0, 0, 0] };

export class SpaceMotion extends Motion {
  /** @param {string} name  @returns {Pose} */
  pose(name) {
    const one = this.payload.bodies[name];
    if (!one) return REST;
    const i = this.index, w = this.weights, q = [0, 0, 0, 0];
    [i, i + 1].forEach((k, end) => {
      const at = [one.qw[k], one.qx[k], one.qy[k], one.qz[k]];
      const spin = [0, one.wx[k], one.wy[k], one.wz[k]], gain = [0, one.alphax[k], one.alphay[k], one.alphaz[k]];
      const rate = half(product(spin, at)), bend = half(product(gain, at).map((value, n) => value + product(spin, rate)[n]));
      for (let n = 0; n < 4; n++) q[n] += w[3 * end] * at[n] + w[3 * end + 1] * rate[n] + w[3 * end + 2] * bend[n];
    });
    const size = Math.hypot(...q);
    return { place: this.smoothly(one), turned: q.map((value) => value / size) };
  }

  /** @returns {Place} of a body's frame or a traced point */
  smoothly(one) { return [this.smooth(one.x, one.vx, one.ax), this.smooth(one.y, one.vy, one.ay), this.smooth(one.z, one.vz, one.az)]; }

  /** @param {{body: string, x?: number, y?: number, z?: number}} end  @returns {Place} */
  where({ body, x = 0, y = 0, z = 0 }) {
    const { place, turned } = this.pose(body), [w, ...v] = turned, twice = cross(v, [x, y, z]).map((value) => 2 * value), more = cross(v, twice);
    return /** @type {Place} */ ([x, y, z].map((value, k) => place[k] + value + w * twice[k] + more[k]));
  }

  spot(kind, name) {
    const { joints, bodies, points } = this.payload;
    if (kind === "point") return this.smoothly(points[name]);
    if (kind === "joint") return this.where(joints[name].at);
    const [x, y, z] = bodies[name].com;
    return this.where({ body: name, x, y, z });
  }

  flat(place) { return /** @type {[number, number]} */ (this.payload.view.map((row) => dot(row, place))); }
  place(end) { return this.flat(this.where(end)); }
  joint(name) { return this.flat(this.spot("joint", name)); }
  point(name) { return this.flat(this.spot("point", name)); }
  centre(name) { return this.flat(this.spot("body", name)); }
  /** 1 where a direction looks out of the picture of the 2D view, else -1. */
  facing(direction) { return dot(cross(this.payload.view[0], this.payload.view[1]), direction) < 0 ? -1 : 1; }
}

/** @param {import("./decode.js").Payload} payload */
export const motionOf = (payload) => (payload.space ? new SpaceMotion(payload) : new Motion(payload));

export const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
const dot = ([a, b, c], [x, y, z]) => a * x + b * y + c * z;
const half = (q) => q.map((value) => value / 2);
/** Of quaternions: first b, then a. */
const product = ([w, ...u], [s, ...v]) => [w * s - dot(u, v), ...cross(u, v).map((value, k) => w * v[k] + s * u[k] + value)];
