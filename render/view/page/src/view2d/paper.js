/** The plane on a canvas: metres to pixels, with pan, zoom and pinch. */

const ROOM = 0.09;
/** Part of the canvas left free on each side. */

export class Paper {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.width = this.height = 1;
    this.zoom = 1;
    this.pan = [0, 0];
  }

  /** Size in CSS pixels; the box (m) that is held at zoom 1, and pixels kept free: top, right, bottom, left. */
  fit(width, height, low, high, free = [0, 0, 0, 0]) {
    this.width = width;
    this.height = height;
    this.low = low;
    this.high = high;
    this.free = free;
  }

  get scale() {
    const w = (this.width - this.free[1] - this.free[3]) * (1 - 2 * ROOM);
    const h = (this.height - this.free[0] - this.free[2]) * (1 - 2 * ROOM);
    return this.zoom * Math.max(Math.min(w / (this.high[0] - this.low[0] || 1e-9), h / (this.high[1] - this.low[1] || 1e-9)), 1e-9);
  }

  /** @returns {[number, number]} pixels of a place (m) */
  pixel(x, y) {
    const k = this.scale, mx = (this.low[0] + this.high[0]) / 2, my = (this.low[1] + this.high[1]) / 2;
    const cx = (this.width + this.free[3] - this.free[1]) / 2, cy = (this.height + this.free[0] - this.free[2]) / 2;
    return [cx + this.pan[0] + k * (x - mx), cy + this.pan[1] - k * (y - my)];
  }

  /** @returns {[number, number]} the place (m) of a pixel */
  place(px, py) {
    const [ox, oy] = this.pixel(0, 0), k = this.scale;
    return [(px - ox) / k, (oy - py) / k];
  }

  /** Zoom by a factor about a pixel. */
  zoomAt(px, py, factor) {
    const [x, y] = this.place(px, py);
    this.zoom = Math.min(Math.max(this.zoom * factor, 0.1), 200);
    const [qx, qy] = this.pixel(x, y);
    this.pan = [this.pan[0] + px - qx, this.pan[1] + py - qy];
  }

  reset() { this.zoom = 1; this.pan = [0, 0]; }
}
