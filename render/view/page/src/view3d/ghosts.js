/** Other poses of the motion, faint. */
import { Group, InstancedMesh, Matrix4, MeshBasicMaterial } from "three";

const POSES = 7;

export class Ghosts {
  constructor() { this.group = new Group(); }

  /** @param {import("./parts.js").Parts} parts  @param {import("../data/motion.js").Motion} motion */
  update(parts, motion) {
    this.group.clear();
    const now = motion.t, materials = parts.materials.map((material) => new MeshBasicMaterial({ color: material.color, transparent: true, opacity: 0.09, depthWrite: false }));
    const moving = parts.meshes.filter((mesh) => mesh.userData.body in motion.payload.bodies);
    const copies = moving.map((mesh) => {
      const copy = new InstancedMesh(mesh.geometry, materials[parts.materials.indexOf(mesh.material)], POSES);
      copy.frustumCulled = false;
      this.group.add(copy);
      return copy;
    });
    const inverse = new Matrix4(), matrix = new Matrix4();
    for (let k = 0; k < POSES; k++) {
      motion.to(motion.start + ((motion.end - motion.start) * (k + 0.5)) / POSES);
      parts.move(motion);
      parts.group.updateMatrixWorld(true);
      inverse.copy(parts.group.matrixWorld).invert();
      moving.forEach((mesh, n) => copies[n].setMatrixAt(k, matrix.multiplyMatrices(inverse, mesh.matrixWorld)));
    }
    motion.to(now);
    parts.move(motion);
  }
}
