/** Meshes of the payload as geometries; the format is told in render/view/solid.py. */
import { BufferAttribute, BufferGeometry } from "three";

/**
 * @param {{count: number, positions: Uint16Array, normals: Int8Array, triangles: Uint16Array | Uint32Array}} mesh
 * @param {number} step m
 */
export function geometryOf({ count, positions, normals, triangles }, step) {
  const places = new Float32Array(3 * count);
  for (let axis = 0; axis < 3; axis++) {
    let value = 0;
    for (let k = 0; k < count; k++) {
      value = (value + positions[axis * count + k]) & 0xffff;
      places[3 * k + axis] = value * step;
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(places, 3));
  geometry.setAttribute("normal", new BufferAttribute(unitsOf(normals, count), 3, true));
  geometry.setIndex(new BufferAttribute(cornersOf(triangles, count), 1));
  geometry.computeBoundingSphere();
  return geometry;
}

function unitsOf(octahedral, count) {
  const out = new Int16Array(3 * count);
  for (let k = 0; k < count; k++) {
    let x = octahedral[k] / 127, y = octahedral[count + k] / 127;
    const z = 1 - Math.abs(x) - Math.abs(y);
    if (z < 0) [x, y] = [(1 - Math.abs(y)) * (x >= 0 ? 1 : -1), (1 - Math.abs(x)) * (y >= 0 ? 1 : -1)];
    const factor = 32767 / Math.hypot(x, y, z);
    out[3 * k] = x * factor;
    out[3 * k + 1] = y * factor;
    out[3 * k + 2] = z * factor;
  }
  return out;
}

function cornersOf(zigzag, count) {
  const number = zigzag.length / 3, out = count < 65536 ? new Uint16Array(zigzag.length) : new Uint32Array(zigzag.length);
  const plain = (value) => (value & 1 ? -(value + 1) / 2 : value / 2);
  let first = 0;
  for (let k = 0; k < number; k++) {
    first += plain(zigzag[k]);
    out[3 * k] = first;
    out[3 * k + 1] = first + plain(zigzag[number + k]);
    out[3 * k + 2] = first + plain(zigzag[2 * number + k]);
  }
  return out;
}
