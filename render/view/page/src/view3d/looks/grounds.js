/** Textures of floors and walls (render/blender/scene/world/ground.py) as pictures that repeat. */
import { CanvasTexture, RepeatWrapping, SRGBColorSpace } from "three";

const SIZE = 1024;
/** Radii that one picture covers. */
const TILES = { wood: 3.72, concrete: 6, asphalt: 3, sand: 4, pegboard: 0.135 };

/** @param {string} texture  @param {{colour: number[], other: number[]}} ground  @param {number} wide radii of what it covers
 *  @returns {CanvasTexture | null} null of plain paint */
export function groundTexture(texture, ground, wide) {
  const shade = SHADES[texture];
  if (!shade) return null;
  const size = texture === "pegboard" ? 64 : SIZE, canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  const g = canvas.getContext("2d"), image = g.createImageData(size, size);
  for (let j = 0; j < size; j++) {
    for (let i = 0; i < size; i++) {
      const [part, dim = 1] = shade(i / size, j / size), at = 4 * (j * size + i), k = Math.min(Math.max(part, 0), 1);
      for (let c = 0; c < 3; c++) image.data[at + c] = 255 * screened(dim * (ground.other[c] + (ground.colour[c] - ground.other[c]) * k));
      image.data[at + 3] = 255;
    }
  }
  g.putImageData(image, 0, 0);
  const made = new CanvasTexture(canvas);
  made.colorSpace = SRGBColorSpace;
  made.wrapS = made.wrapT = RepeatWrapping;
  made.anisotropy = 8;
  made.repeat.setScalar(wide / TILES[texture]);
  return made;
}

const screened = (value) => (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055);

/** A number of 0..1 that belongs to two whole ones. */
function chance(i, j) {
  let n = Math.imul(i, 374761393) + Math.imul(j, 668265263);
  n = Math.imul(n ^ (n >>> 13), 1274126177);
  return ((n ^ (n >>> 16)) >>> 0) / 4294967296;
}

/** Smooth noise on the unit square with so many cells across and down; it repeats. */
function noise(x, y, across, down) {
  const u = x * across, v = y * down, i = Math.floor(u), j = Math.floor(v), a = u - i, b = v - j;
  const s = a * a * (3 - 2 * a), t = b * b * (3 - 2 * b), at = (p, q) => chance(((i + p) % across) + 7 * across, ((j + q) % down) + 3 * down);
  return (at(0, 0) * (1 - s) + at(1, 0) * s) * (1 - t) + (at(0, 1) * (1 - s) + at(1, 1) * s) * t;
}

const BOARDS = 6;
const SHADES = {
  wood(x, y) {
    const board = Math.floor(y * BOARDS), edge = Math.abs(y * BOARDS - board - 0.5), own = chance(board, 91), along = (x + own) % 1;
    const rings = Math.abs(((noise(along, y, 3, 5 * BOARDS) * 7 + 5 * own) % 1) - 0.5) * 2, fibres = noise(along, y, 12, 400);
    return [0.75 - 0.45 * rings * 0.6 - 0.35 * (fibres - 0.5) + 0.4 * (own - 0.5), edge > 0.487 ? 0.25 : 1];
  },
  concrete: (x, y) => [0.55 * noise(x, y, 6, 6) + 0.3 * noise(x, y, 19, 19) + 0.15 * noise(x, y, 300, 300)],
  asphalt: (x, y) => [0.5 * noise(x, y, 256, 256) + 0.35 * chance(Math.floor(x * SIZE), Math.floor(y * SIZE)) + 0.2 * noise(x, y, 5, 5)],
  sand(x, y) {
    const bent = noise(x, y, 5, 5), ripple = 0.5 + 0.5 * Math.sin(2 * Math.PI * (13 * y + 3 * x + 2.4 * bent));
    return [0.25 + 0.55 * ripple * (0.4 + noise(x, y, 4, 4)) + 0.2 * chance(Math.floor(x * SIZE), Math.floor(y * SIZE))];
  },
  pegboard: (x, y) => [1, Math.hypot(x - 0.5, y - 0.5) < 0.19 ? 0.2 : 1],
};
