/** Arrows and arcs over the parts, as in the film: thin shafts with cones, drawn over everything. */
import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshBasicMaterial, TubeGeometry, Vector3, Curve } from "three";
import { arcsAt, arrowsAt } from "../view2d/arrows.js";

const SHAFT = 0.0042, HEAD = 0.0125, POINT = 0.037;
/** Parts of the size, render/film/arrows/arrows.py. */
const SEGMENTS = 64;

export class Arrows {
  constructor() {
    this.group = new Group();
    this.materials = {};
    this.straight = new Map();
    this.curved = new Map();
    this.shaft = new CylinderGeometry(1, 1, 1, 12).rotateZ(-Math.PI / 2).translate(0.5, 0, 0);
    this.head = new ConeGeometry(1, 1, 20).rotateZ(-Math.PI / 2).translate(-0.5, 0, 0);
  }

  clear() {
    this.group.clear();
    this.straight.clear();
    this.curved.clear();
  }

  material(quantity, colours) {
    const known = (this.materials[quantity] ??= new MeshBasicMaterial({ toneMapped: false, depthTest: false, transparent: true }));
    known.color.set(colours[quantity]);
    return known;
  }

  mesh(geometry, material) {
    const mesh = new Mesh(geometry, material);
    mesh.renderOrder = 10;
    return mesh;
  }

  draw(payload, motion, shown, colours) {
    const size = payload.solid.size;
    for (const one of [...this.straight.values(), ...this.curved.values()]) one.visible = false;
    for (const { index, quantity, tail, tip, z } of arrowsAt(payload, motion, shown)) {
      const one = this.arrow(index, this.material(quantity, colours)), dx = tip[0] - tail[0], dy = tip[1] - tail[1];
      const length = Math.hypot(dx, dy), point = Math.min(POINT * size, 0.7 * length), thin = Math.min(1, length / (1.4 * POINT * size));
      one.visible = true;
      one.position.set(tail[0], tail[1], z);
      one.rotation.z = Math.atan2(dy, dx);
      one.children[0].scale.set(length - 0.8 * point, SHAFT * size * thin, SHAFT * size * thin);
      one.children[1].position.x = length;
      one.children[1].scale.set(point, HEAD * size * thin, HEAD * size * thin);
    }
    for (const { index, quantity, centre, sweep, radius, z } of arcsAt(payload, motion, shown)) {
      const one = this.arc(index, radius, size, payload, this.material(quantity, colours)), part = Math.abs(sweep) / one.userData.full;
      one.visible = true;
      one.position.set(...centre, z);
      one.scale.y = Math.sign(sweep);
      const [tube, head] = one.children;
      tube.geometry.setDrawRange(0, Math.round(part * SEGMENTS) * one.userData.indices);
      const angle = Math.abs(sweep);
      head.position.set(radius * Math.cos(angle), radius * Math.sin(angle), 0);
      head.rotation.z = angle + Math.PI / 2;
    }
  }

  arrow(index, material) {
    let one = this.straight.get(index);
    if (!one) {
      one = new Group();
      one.add(this.mesh(this.shaft, material), this.mesh(this.head, material));
      this.straight.set(index, one);
      this.group.add(one);
    }
    return one;
  }

  arc(index, radius, size, { arcs, arrows }, material) {
    let one = this.curved.get(index);
    if (!one) {
      const full = arcs.full * arrows.longest;
      const tube = this.mesh(new TubeGeometry(new Arc(radius, full), SEGMENTS, SHAFT * size, 8), material);
      const head = this.mesh(this.head, material);
      head.scale.set(POINT * size, HEAD * size, HEAD * size);
      one = new Group();
      one.add(tube, head);
      one.userData = { full, indices: 8 * 6 };
      this.curved.set(index, one);
      this.group.add(one);
    }
    return one;
  }
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
