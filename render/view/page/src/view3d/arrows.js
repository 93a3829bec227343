/** Arrows and arcs over the parts, as in the film: thin shafts with cones, drawn over everything. */
import { CylinderGeometry, Curve, ExtrudeGeometry, Group, LatheGeometry, Mesh, MeshBasicMaterial, Shape, TubeGeometry, Vector2, Vector3 } from "three";
import { arcsAt, arrowsAt } from "../view2d/arrows.js";
import { HEADS } from "../view2d/inks.js";

const ALONG = new Vector3(1, 0, 0), UP = new Vector3(0, 0, 1);
const SHAFT = 0.0042, HEAD = 0.0125, POINT = 0.037;
/** Parts of the size, render/film/arrows.py. */
const SEGMENTS = 64;
/** The halo round an arrow, in radii of its shaft; arcs, which stand on parts, are stouter. */
const HALO = 0.55, STOUT = 1.3;
/** Second points of heads, and open ones, as in the film (render/blender/scene/arrows.py). */
const BACK = 0.72, NECK = 0.3, WIDE = 1.45, BARB = 0.3;

export class Arrows {
  constructor() {
    this.group = new Group();
    this.materials = {};
    this.straight = new Map();
    this.curved = new Map();
    this.shaft = new CylinderGeometry(1, 1, 1, 12).rotateZ(-Math.PI / 2).translate(0.5, 0, 0);
    this.heads = Object.fromEntries(["solid", "solid double", "open", "open double"].map((head) => [head, headOf(head)]));
    this.halo = new MeshBasicMaterial({ color: "#05070a", toneMapped: false, depthTest: false, transparent: true, opacity: 0.85 });
  }

  clear() {
    this.group.clear();
    this.straight.clear();
    this.curved.clear();
  }

  material(row, colours) {
    const known = (this.materials[row] ??= new MeshBasicMaterial({ toneMapped: false, depthTest: false, transparent: true }));
    known.color.set(colours[row]);
    return known;
  }

  /** A thing, and behind it its halo. */
  pair(geometry, material) {
    return [this.halo, material].map((one, k) => {
      const mesh = new Mesh(geometry, one);
      mesh.renderOrder = 9 + k;
      return mesh;
    });
  }

  /** @param {(z: number) => number} raised  where a height is in a machine that is apart */
  draw(payload, motion, shown, colours, raised = (z) => z) {
    const size = payload.solid.size;
    for (const one of [...this.straight.values(), ...this.curved.values()]) one.visible = false;
    for (const { index, row, tail, tip, z } of arrowsAt(payload, motion, shown)) {
      const one = this.arrow(index, row, this.material(row, colours)), way = new Vector3(...tip.map((x, k) => x - tail[k]));
      const length = way.length(), point = Math.min(POINT * size, (HEADS[row].endsWith("double") ? 0.5 : 0.7) * length);
      const thin = Math.min(1, length / (1.4 * POINT * size)), thick = SHAFT * size * thin, halo = HALO * thick;
      one.visible = true;
      one.position.set(tail[0], tail[1], tail[2] ?? raised(z));
      one.quaternion.setFromUnitVectors(ALONG, way.divideScalar(length));
      one.children.forEach((mesh, k) => {
        const more = k % 2 ? 0 : halo, head = HEAD * size * thin;
        if (k < 2) mesh.scale.set(length - 0.8 * point, thick + more, thick + more);
        else {
          mesh.position.x = length + 1.6 * more;
          mesh.scale.set(point + 3 * more, head + 1.6 * more, head + 1.6 * more);
        }
      });
    }
    for (const { index, row, centre, sweep, radius, z, about } of arcsAt(payload, motion, shown)) {
      const one = this.arc(index, radius, size, payload, this.material(row, colours)), part = Math.abs(sweep) / one.userData.full;
      one.visible = true;
      one.position.set(centre[0], centre[1], centre[2] ?? raised(z));
      if (about) one.quaternion.setFromUnitVectors(UP, new Vector3(...about).normalize());
      one.scale.y = Math.sign(sweep);
      const angle = Math.abs(sweep);
      const thin = Math.min(1, (0.55 * radius * angle) / (STOUT * POINT * size)), neck = Math.max(part - (0.8 * thin * STOUT * POINT * size) / (radius * one.userData.full), 0);
      for (const mesh of one.children.slice(0, 2)) mesh.geometry.setDrawRange(0, Math.round(neck * SEGMENTS) * one.userData.indices);
      one.children.slice(2).forEach((head, k) => {
        const more = k ? 0 : HALO * STOUT * SHAFT * size, wide = thin * STOUT * HEAD * size + 1.6 * more;
        head.position.set(radius * Math.cos(angle), radius * Math.sin(angle), 0);
        head.rotation.z = angle + Math.PI / 2;
        head.scale.set(thin * STOUT * POINT * size + 3 * more, wide, wide);
      });
    }
  }

  arrow(index, row, material) {
    let one = this.straight.get(index);
    if (!one) {
      one = new Group();
      one.add(...this.pair(this.shaft, material), ...this.pair(this.heads[HEADS[row]], material));
      this.straight.set(index, one);
      this.group.add(one);
    }
    return one;
  }

  arc(index, radius, size, { arcs, arrows }, material) {
    let one = this.curved.get(index);
    if (!one) {
      const full = arcs.full * arrows.longest, thick = STOUT * SHAFT * size, halo = HALO * thick;
      const tubes = [this.halo, material].map((of, k) => {
        const mesh = new Mesh(new TubeGeometry(new Arc(radius, full), SEGMENTS, thick + (k ? 0 : halo), 8), of);
        mesh.renderOrder = 9 + k;
        return mesh;
      });
      one = new Group();
      one.add(...tubes, ...this.pair(this.heads.solid, material));
      one.userData = { full, indices: 8 * 6 };
      this.curved.set(index, one);
      this.group.add(one);
    }
    return one;
  }
}

/** A head whose tip is the origin, its neck at x = -1, its half width 1. */
function headOf(head) {
  if (head.startsWith("solid")) {
    const profile = head === "solid" ? [[1, -1], [0, 0]] : [[1, -1 - BACK], [NECK, BACK * NECK - 1], [1, BACK * NECK - 1], [0, 0]];
    return new LatheGeometry([[0, profile[0][1]], ...profile].map(([r, y]) => new Vector2(r, y)), 20).rotateZ(-Math.PI / 2);
  }
  const thick = SHAFT / HEAD, shapes = [[[-1, -thick], [-0.1, -thick], [-0.1, thick], [-1, thick]]];
  for (const back of head === "open" ? [0] : [0, BACK]) {
    shapes.push([[0, 0], [-1, WIDE], [-1 - BARB, WIDE], [-1.6 * BARB, 0], [-1 - BARB, -WIDE], [-1, -WIDE]].map(([x, y]) => [x - back, y]));
  }
  const made = shapes.map((corners) => new Shape(corners.map(([x, y]) => new Vector2(x, y))));
  return new ExtrudeGeometry(made, { depth: 2 * thick, bevelEnabled: false }).translate(0, 0, -thick);
}

class Arc extends Curve {
  constructor(radius, sweep) {
    super();
    Object.assign(this, { radius, sweep });
  }

  getPoint(part, target = new Vector3()) {
    const angle = part * this.sweep;
    return target.set(this.radius * Math.cos(angle), this.radius * Math.sin(angle), 0);
  }
}
