/**
 * The film's look (render/looks/, payload.solid.looks) for the screen: softboxes that are reflected, one lamp with soft
 * shadows, a floor that fades into the background, a wall. Lengths in radii of the swept motion, z up, turned with the camera.
 */
import {
  AmbientLight, BackSide, CanvasTexture, CircleGeometry, Color, DirectionalLight, DoubleSide, Group, Mesh, MeshBasicMaterial,
  MeshStandardMaterial, PMREMGenerator, PlaneGeometry, Scene, SphereGeometry, SRGBColorSpace, Vector3,
} from "three";
import { groundTexture } from "./grounds.js";

/** Radius of the floor; where it is open up to the horizon; half the width of a wall, and its height. */
const FLOOR = 11, OPEN = 40, WIDE = 9, HIGH = 6;
/** From the middle to the lamp. */
const AWAY = 4.6;

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
    this.floor = new Mesh(new CircleGeometry(1, 96), new MeshStandardMaterial({ transparent: true, metalness: 0, alphaMap: fading() }));
    this.floor.receiveShadow = true;
    this.floor.renderOrder = -1;
    this.wall = new Mesh(new PlaneGeometry(2 * WIDE, HIGH), new MeshStandardMaterial({ metalness: 0, roughness: 0.6 }));
    this.wall.rotation.x = Math.PI / 2;
    this.wall.receiveShadow = true;
    this.turned = new Group();
    this.turned.add(this.wall);
    this.group.add(this.lamp, this.lamp.target, this.ambient, this.floor, this.turned);
  }

  /** @param {any} look  @param {number} azimuth rad  @param {number} height of the floor  @param {number} away how far the machine reaches */
  set(look, azimuth, height, away) {
    const { ground, screen, drawing, lamp, wall, sky } = look, open = !wall && !drawing, radius = open ? OPEN : FLOOR;
    const paint = this.floor.material;
    this.floor.visible = !drawing;
    this.floor.scale.setScalar(radius);
    this.floor.position.z = height;
    this.floor.rotation.z = azimuth;
    paint.map?.dispose();
    paint.map = groundTexture(ground.texture, ground, 2 * radius);
    if (paint.map) paint.color.setScalar(1);
    else paint.color.setRGB(...ground.colour);
    paint.roughness = Math.max(ground.roughness, 0.55);
    paint.envMapIntensity = look.dark ? 0.22 : 0.5;
    paint.needsUpdate = true;
    this.hang(wall, azimuth, height, away);
    this.lamp.intensity = drawing ? 1 : screen.lamp;
    this.lamp.color.setRGB(...lamp.colour);
    this.lamp.position.set(...lamp.place).setLength(AWAY).applyAxisAngle(UP, azimuth);
    this.ambient.intensity = screen.ambient;
    this.renderer.toneMappingExposure = screen.exposure;
    this.scene.background = drawing ? new Color().setRGB(...drawing.paper, SRGBColorSpace) : new Color().setRGB(...(open ? sky.horizon : screen.edge));
    this.scene.environment?.dispose();
    this.scene.environment = this.reflected(look, azimuth);
  }

  /** The wall behind the machine, where the look has one with holes. */
  hang(wall, azimuth, height, away) {
    const board = wall?.kind === "pegboard", paint = this.wall.material;
    this.turned.visible = board;
    paint.map?.dispose();
    paint.map = board ? groundTexture("pegboard", { colour: wall.colour, other: wall.colour }, 1) : null;
    if (board) paint.map.repeat.set((2 * WIDE) / PITCH, HIGH / PITCH);
    paint.needsUpdate = true;
    if (!board) return;
    this.turned.rotation.z = azimuth;
    this.wall.position.set(0, away + wall.away, height + HIGH / 2);
  }

  /** The softboxes and the sky as every surface sees them. */
  reflected(look, azimuth) {
    const room = new Scene(), maker = new PMREMGenerator(this.renderer), { zenith, horizon, below } = look.sky;
    const dome = (colour, from, to) => room.add(new Mesh(
      new SphereGeometry(40, 24, 16, 0, 2 * Math.PI, from, to - from).rotateX(Math.PI / 2),
      new MeshBasicMaterial({ color: new Color().setRGB(...colour), side: BackSide }),
    ));
    dome(zenith, 0, 0.8);
    dome(horizon, 0.8, Math.PI / 2);
    dome(below, Math.PI / 2, Math.PI);
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
/** Radii between two holes. */
const PITCH = 0.135;

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
