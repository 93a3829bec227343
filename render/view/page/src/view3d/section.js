/**
 * A section: what is in front of a plane is cut away, and cut faces are hatched.
 *
 * Parts are closed, so a ray that meets the back of a face first has come through the plane into a part: there the cut
 * face is seen, and there it is painted.
 */
import { DoubleSide, FrontSide, Plane, Vector3 } from "three";

const AXES = { front: [0, 0, 1], side: [1, 0, 0], top: [0, 1, 0] };
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
    this.normal = new Vector3();
    this.place = new Vector3();
  }

  /**
   * @param {import("./parts.js").Parts} parts  @param {number} cut part of the machine that is away, 0 .. 1
   * @param {string} side  @param {import("three").Object3D} machine whose frame the axes are in
   * @param {import("three").Vector3} eye  what is on its side is cut away
   */
  draw(parts, cut, side, machine, eye) {
    const on = cut > 0;
    if (on) {
      const axis = AXES[side] ?? AXES.front, [low, high] = parts.reach(axis);
      this.normal.set(...axis).transformDirection(machine.matrixWorld);
      this.place.set(...axis).multiplyScalar((low + high) / 2).applyMatrix4(machine.matrixWorld);
      const near = this.normal.dot(eye) > this.normal.dot(this.place), at = near ? high - cut * (high - low) : low + cut * (high - low);
      if (near) this.normal.negate();
      this.place.set(...axis).multiplyScalar(at).applyMatrix4(machine.matrixWorld);
      this.plane.setFromNormalAndCoplanarPoint(this.normal, this.place);
    }
    if (this.parts === parts && this.on === on) return;
    this.parts = parts;
    this.on = on;
    parts.materials.forEach((material, k) => {
      material.clippingPlanes = on ? [this.plane] : null;
      material.clipShadows = on;
      material.side = on ? DoubleSide : FrontSide;
      material.onBeforeCompile = on ? (shader) => { shader.fragmentShader = shader.fragmentShader.replace("#include <opaque_fragment>", hatched(k)); } : () => {};
      material.customProgramCacheKey = () => (on ? `section ${k % 6}` : "");
      material.needsUpdate = true;
    });
  }
}
