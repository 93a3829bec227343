/**
 * The film's studio (render/blender/scene/studio.py) for the screen: softboxes that are reflected, one lamp with soft
 * shadows, a floor that fades into the backdrop. Lengths in radii of the swept motion, z up, turned with the camera.
 */
import {
  AmbientLight, BackSide, CanvasTexture, CircleGeometry, Color, DirectionalLight, DoubleSide, Group, Mesh, MeshBasicMaterial,
  MeshStandardMaterial, PMREMGenerator, PlaneGeometry, Scene, SphereGeometry, SRGBColorSpace, Vector3,
} from "three";

/** Place, size, strength and colour of what shines, by look. */
const LOOKS = {
  studio: {
    world: [0.035, 0.04, 0.052], floor: [0.02, 0.025, 0.036], edge: [0.0035, 0.0045, 0.007], exposure: 1.0, lamp: 2.6, ambient: 0.0,
    rough: 0.55, shine: 0.22,
    boxes: [
      [[-0.3, 3.4, 2.5], [5.0, 2.0], 1.7, [1, 0.985, 0.96]], [[1.2, -0.3, 4.2], [1.3, 1.3], 1.5, [1, 0.97, 0.94]],
      [[-3.2, 1.4, 0.9], [0.7, 2.8], 6.5, [0.36, 0.62, 1]], [[3.2, 0.9, 0.8], [0.7, 2.8], 5.5, [1, 0.56, 0.26]],
      [[-1.2, -3.8, 1.6], [3.4, 1.6], 2.2, [0.84, 0.91, 1]],
    ],
  },
  daylight: {
    world: [0.34, 0.36, 0.4], floor: [0.66, 0.67, 0.69], edge: [0.77, 0.79, 0.82], exposure: 0.95, lamp: 2.7, ambient: 0.12,
    rough: 0.8, shine: 0.5,
    boxes: [
      [[-0.6, 1.8, 3.2], [3.4, 2.4], 3.0, [1, 0.98, 0.95]], [[-3.0, 1.4, 1.4], [0.8, 2.6], 1.6, [0.8, 0.9, 1]],
      [[3.0, 1.2, 1.2], [0.8, 2.6], 1.6, [1, 0.88, 0.74]], [[0, -3.4, 2.2], [3.6, 1.6], 1.0, [0.95, 0.97, 1]],
    ],
  },
};
const FLOOR = 11;
/** Radius of the floor. */

export class Studio {
  /** @param {import("three").WebGLRenderer} renderer  @param {Scene} scene */
  constructor(renderer, scene) {
    this.renderer = renderer;
    this.scene = scene;
    this.group = new Group();
    scene.add(this.group);
    this.lamp = new DirectionalLight(0xffffff, 1);
    this.lamp.castShadow = true;
    this.lamp.shadow.mapSize.set(2048, 2048);
    Object.assign(this.lamp.shadow.camera, { left: -1.7, right: 1.7, top: 1.7, bottom: -1.7, near: 1, far: 9 });
    this.lamp.shadow.bias = -0.0004;
    this.lamp.shadow.normalBias = 0.004;
    this.lamp.shadow.radius = 5;
    this.ambient = new AmbientLight(0xffffff, 0.1);
    this.floor = new Mesh(new CircleGeometry(FLOOR, 96), new MeshStandardMaterial({ transparent: true, metalness: 0, roughness: 0.5, alphaMap: fading() }));
    this.floor.receiveShadow = true;
    this.floor.renderOrder = -1;
    this.group.add(this.lamp, this.lamp.target, this.ambient, this.floor);
  }

  /** @param {"studio" | "daylight"} name  @param {number} azimuth rad  @param {number} height of the floor */
  set(name, azimuth, height) {
    const look = LOOKS[name] ?? LOOKS.studio;
    this.floor.position.z = height;
    this.floor.material.color.setRGB(...look.floor);
    this.floor.material.roughness = look.rough;
    this.floor.material.envMapIntensity = look.shine;
    this.lamp.intensity = look.lamp;
    this.lamp.position.set(-0.9, 1.5, 4.2).applyAxisAngle(UP, azimuth);
    this.ambient.intensity = look.ambient;
    this.renderer.toneMappingExposure = look.exposure;
    this.scene.background = new Color().setRGB(...look.edge);
    this.scene.environment?.dispose();
    this.scene.environment = this.reflected(look, azimuth);
  }

  /** The softboxes as every surface sees them. */
  reflected(look, azimuth) {
    const room = new Scene(), maker = new PMREMGenerator(this.renderer);
    room.add(new Mesh(new SphereGeometry(40, 24, 16), new MeshBasicMaterial({ color: new Color().setRGB(...look.world), side: BackSide })));
    for (const [place, size, strength, colour] of look.boxes) {
      const material = new MeshBasicMaterial({ color: new Color().setRGB(...colour).multiplyScalar(strength), side: DoubleSide });
      const box = new Mesh(new PlaneGeometry(...size), material);
      box.position.set(...place);
      box.up.copy(UP);
      box.lookAt(new Vector3());
      room.add(box);
    }
    room.rotation.z = azimuth;
    const made = maker.fromScene(room, 0.012, 0.05, 100).texture;
    maker.dispose();
    return made;
  }
}

const UP = new Vector3(0, 0, 1);

/** Opaque in the middle, nothing at the rim. */
function fading() {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 512;
  const g = canvas.getContext("2d"), gradient = g.createRadialGradient(256, 256, 0, 256, 256, 256);
  gradient.addColorStop(0, "#fff");
  gradient.addColorStop(0.16, "#f4f4f4");
  gradient.addColorStop(0.45, "#6a6a6a");
  gradient.addColorStop(0.75, "#161616");
  gradient.addColorStop(1, "#000");
  g.fillStyle = gradient;
  g.fillRect(0, 0, 512, 512);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  return texture;
}
