/**
 * A section: what is in front of a plane is cut away, or a quarter that is in front of two; cut faces are hatched.
 *
 * Parts are closed, so a ray that meets the back of a face first has come through the plane into a part: there the cut
 * face is seen, and there it is painted.
 */
import { DoubleSide, FrontSide, Plane, Vector3 } from "three";

const AXES = { front: [[0, 0, 1]], side: [[1, 0, 0]], top: [[0, 1, 0]], quarter: [[0, 0, 1], [1, 0, 0]] };
/** Lines of neighbours lean to other sides, in light and dark of the part's own colour. @param {number} k its number */
const hatched = (k) => `
#include <opaque_fragment>
if (!gl_FrontFacing) {
  float stripe = step(0.55, fract((gl_FragCoord.x ${k % 2 ? "-" : "+"} gl_FragCoord.y) / ${(9 + 2 * (k % 3)).toFixed(1)}));
  gl_FragColor = vec4(mix(0.55 * diffuseColor.rgb + 0.38, 0.35 * diffuseColor.rgb + 0.02, stripe), 1.0);
}`;

export class Section {
  constructor() {
    this.plane = new Plane();
    this.planes = { 1: [this.plane], 2: [this.plane, new Plane()] };
    this.normal = new Vector3();
    this.place = new Vector3();
    /** Pieces that the shot cuts: mesh, own material, the one of all like it, planes of the mesh (or of the machine, where fixed) and of the world. */
    this.sawn = [];
    /** Planes of the film that cut springs, ropes and belts: of the machine, and of the world. */
    this.still = [];
    this.on = "";
  }

  /**
   * @param {import("./parts.js").Parts} parts  @param {number} cut part of the machine that is away, 0 .. 1
   * @param {string} side  @param {import("three").Object3D} machine whose frame the axes are in
   * @param {import("three").Vector3} eye  what is on its side is cut away
   */
  draw(parts, cut, side, machine, eye) {
    const axes = AXES[side] ?? [], on = !cut ? "" : side === "film" ? side : `${axes.length}`;
    if (cut) axes.forEach((axis, k) => this.lay(this.planes[axes.length][k], parts, axis, cut, machine, eye));
    if (this.parts !== parts || this.on !== on || this.paints !== parts.paints || (on === "film" && this.dressed !== parts.dressed)) this.change(parts, on);
    for (const { mesh, own, planes, fixed } of this.sawn) planes.forEach((plane, k) => plane.copy(own[k]).applyMatrix4((fixed ? machine : mesh).matrixWorld));
    for (const [own, plane] of this.still) plane.copy(own).applyMatrix4(machine.matrixWorld);
  }

  /** Lay a plane across an axis of the machine, so that what is on the eye's side goes. */
  lay(plane, parts, axis, cut, machine, eye) {
    const [low, high] = parts.reach(axis);
    this.normal.set(...axis).transformDirection(machine.matrixWorld);
    this.place.set(...axis).multiplyScalar((low + high) / 2).applyMatrix4(machine.matrixWorld);
    const near = this.normal.dot(eye) > this.normal.dot(this.place), at = near ? high - cut * (high - low) : low + cut * (high - low);
    if (near) this.normal.negate();
    this.place.set(...axis).multiplyScalar(at).applyMatrix4(machine.matrixWorld);
    plane.setFromNormalAndCoplanarPoint(this.normal, this.place);
  }

  change(parts, on) {
    for (const { mesh, material, common } of this.sawn) {
      if (mesh.material === material) mesh.material = common;
      material.dispose();
    }
    this.sawn = [];
    this.parts?.meshes.forEach((mesh) => { mesh.visible = true; });
    this.parts = parts;
    this.on = on;
    this.dressed = parts.dressed;
    const planes = this.planes[on] ?? null;
    parts.materials.forEach((material, k) => opened(material, k, planes));
    this.paints = parts.paints;
    this.still = (on === "film" ? (parts.solid.still ?? []) : []).map(([x, y, z, place]) => [new Plane(new Vector3(-x, -y, -z), place), new Plane()]);
    parts.paints.forEach((material, k) => opened(material, k, this.still.length ? this.still.map(([, plane]) => plane) : planes));
    if (on === "film") parts.solid.pieces.forEach((piece, k) => this.saw(piece, parts.meshes[k], k));
  }

  /** Cut a piece as the film does: by planes that go with it, or, where they are fixed, stay in the machine's frame. */
  saw({ cut, gone, at: corner, fixed }, mesh, k) {
    mesh.visible = !gone;
    if (!cut?.length || gone) return;
    const common = mesh.material, material = common.clone(), at = fixed ? [0, 0, 0] : corner;
    const own = cut.map(([x, y, z, place]) => new Plane(new Vector3(-x, -y, -z), place - (x * at[0] + y * at[1] + z * at[2])));
    const planes = own.map((plane) => plane.clone());
    opened(material, k, planes);
    mesh.material = material;
    this.sawn.push({ mesh, own, planes, material, common, fixed });
  }
}

/** Have a material end beyond all planes, with painted cut faces; whole without planes. */
function opened(material, k, planes) {
  material.clippingPlanes = planes;
  material.clipIntersection = true;
  material.clipShadows = !!planes;
  material.side = planes ? DoubleSide : FrontSide;
  material.onBeforeCompile = planes ? (shader) => { shader.fragmentShader = shader.fragmentShader.replace("#include <opaque_fragment>", hatched(k)); } : () => {};
  material.customProgramCacheKey = () => (planes ? `section ${k % 6}` : "");
  material.needsUpdate = true;
}
