/** The parts: a group for each body, a mesh for each piece, moved by the motion; springs and belts as recorded. */
import { AnimationMixer, Box3, Group, Matrix4, Mesh, Vector3 } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { materialOf, setLook } from "./materials.js";
import { geometryOf } from "./meshes.js";

export class Parts {
  /**
   * @param {any} solid payload.solid  @param {boolean} soft whether WebGL is in software
   * @param {() => void} ready called when springs and belts are there
   */
  constructor(solid, soft, ready) {
    this.solid = solid;
    this.group = new Group();
    /** @type {Map<string, Group>} */
    this.bodies = new Map();
    this.rollers = [];
    /** Meshes, their own height, and how far an exploded machine lifts them (m). */
    this.lifts = [];
    /** Heights of the middles of pieces when all is together, and their lifts (m). */
    this.steps = [];
    this.apart = this.dressed = 0;
    this.meshes = [];
    /** Materials of springs, ropes and belts. @type {import("three").Material[]} */
    this.paints = [];
    this.materials = solid.surfaces.map((surface) => materialOf(surface, soft));
    const geometries = solid.meshes.map((mesh) => geometryOf(mesh, solid.step));
    for (const piece of solid.pieces) {
      const mesh = new Mesh(geometries[piece.mesh], this.materials[piece.surface]);
      mesh.castShadow = mesh.receiveShadow = true;
      mesh.userData = { body: piece.body, piece: piece.name };
      mesh.position.set(...piece.at);
      this.lifts.push([mesh, piece.at[2], piece.lift ?? 0]);
      mesh.geometry.boundingBox ?? mesh.geometry.computeBoundingBox();
      this.steps.push([piece.at[2] + mesh.geometry.boundingBox.max.z / 2, piece.lift ?? 0]);
      this.meshes.push(mesh);
      if (piece.turns) {
        const axis = new Group();
        axis.position.set(piece.turns.x, piece.turns.y, 0);
        mesh.position.x -= piece.turns.x;
        mesh.position.y -= piece.turns.y;
        axis.add(mesh);
        this.body(piece.body).add(axis);
        this.rollers.push([axis, piece.turns.angle]);
      } else this.body(piece.body).add(mesh);
    }
    /** Whether springs and belts are still to come. */
    this.waits = !!solid.tubes;
    if (solid.tubes) this.load(solid.tubes, ready);
  }

  body(name) {
    let group = this.bodies.get(name);
    if (!group) {
      group = new Group();
      this.bodies.set(name, group);
      this.group.add(group);
    }
    return group;
  }

  async load(bytes, ready) {
    const file = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
    const { scene, animations } = await new GLTFLoader().parseAsync(file, "");
    scene.rotation.set(0, 0, 0);
    for (const root of scene.children) root.quaternion.identity(); // its y is up, ours z
    const paints = new Set();
    scene.traverse((one) => {
      one.castShadow = one.receiveShadow = !!one.isMesh;
      if (one.isMesh) paints.add(one.material);
    });
    this.paints = [...paints];
    this.tubes = scene;
    this.group.add(scene);
    this.mixer = new AnimationMixer(scene);
    for (const clip of animations) this.mixer.clipAction(clip).play();
    this.length = Math.max(0, ...animations.map((clip) => clip.duration));
    this.waits = false;
    ready();
  }

  /** @param {import("../data/motion.js").Motion} motion */
  move(motion) {
    const { bodies, other, space } = motion.payload, count = motion.time.length;
    for (const [name, group] of this.bodies) {
      const map = other?.[name];
      group.visible = !other || name in bodies || name === "ground";
      group.matrixAutoUpdate = !map;
      if (name in bodies && space) {
        const { place, turned: [w, x, y, z] } = motion.pose(name);
        group.position.set(...place);
        group.quaternion.set(x, y, z, w);
      } else if (name in bodies) {
        const { x, y, theta } = motion.body(name);
        group.position.set(x, y, 0);
        group.rotation.z = theta;
      }
      if (!map) continue;
      const [a, b, c, d, e, f] = map;
      group.updateMatrix();
      group.matrix.multiply(new Matrix4().set(a, b, 0, c, d, e, 0, f, 0, 0, 1, 0, 0, 0, 0, 1));
      group.matrixWorldNeedsUpdate = true;
    }
    for (const [axis, angle] of this.rollers) if (angle.length === count) axis.rotation.z = motion.linear(angle);
    if (this.tubes) this.tubes.visible = !other && !this.apart;
    this.mixer?.setTime(Math.min(motion.t - motion.start, this.length * (1 - 1e-7)));
  }

  /** How far the topmost piece is lifted (m). */
  get tallest() { return Math.max(0, ...this.lifts.map(([, , lift]) => lift)); }

  /** Take the machine apart about its middle: 0 together, 1 wholly. @param {number} apart */
  explode(apart) {
    this.apart = apart;
    const half = this.tallest / 2;
    for (const [mesh, height, lift] of this.lifts) mesh.position.z = height + apart * (lift - half);
  }

  /** Where something that floats at a height goes when the machine is apart: with what is just below it. @param {number} z m */
  raised(z) {
    if (!this.apart) return z;
    let lift = 0;
    for (const [middle, more] of this.steps) if (middle <= z && more > lift) lift = more;
    return z + this.apart * (lift - this.tallest / 2);
  }

  /** Least and largest place of all pieces along an axis of the machine, at the moment and as far as they are apart. */
  reach(axis) {
    const box = new Box3(), along = new Vector3(...axis), corner = new Vector3(), back = this.group.matrixWorld.clone().invert();
    let [low, high] = [Infinity, -Infinity];
    for (const mesh of this.meshes) {
      mesh.geometry.boundingBox ?? mesh.geometry.computeBoundingBox();
      box.copy(mesh.geometry.boundingBox).applyMatrix4(mesh.matrixWorld).applyMatrix4(back);
      for (const k of [0, 1, 2, 3, 4, 5, 6, 7]) {
        const place = corner.set(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z).dot(along);
        low = Math.min(low, place);
        high = Math.max(high, place);
      }
    }
    return [low, high];
  }

  /** Others take their place. */
  dispose() {
    this.group.removeFromParent();
    this.group.traverse((one) => { one.geometry?.dispose(); });
    for (const material of this.materials) material.dispose();
  }

  /** @param {"" | "glass" | "dim"} look  @param {boolean} neutral whether no part has a colour */
  dress(look, neutral) {
    for (const material of this.materials) setLook(material, look, neutral);
    this.dressed++;
  }
}
