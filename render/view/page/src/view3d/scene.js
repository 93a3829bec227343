/** The 3D view. The machine is scaled so that the radius of its swept motion is 1, and turned so that z is up. */
import { NeutralToneMapping, Group, Matrix4, PCFShadowMap, PerspectiveCamera, Raycaster, Scene, Vector2, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { cardIsPlayed } from "../ui/canvases.js";
import { inks, showsArrows } from "../view2d/inks.js";
import { Arrows } from "./arrows.js";
import { Ghosts } from "./ghosts.js";
import { Labels } from "./labels.js";
import { drawn } from "./looks/drawn.js";
import { Studio } from "./looks/studio.js";
import { Marks } from "./marks.js";
import { Parts } from "./parts.js";
import { Section } from "./section.js";
import { Trails } from "./trails.js";
import { wantedLabels, wantedMarks } from "./wanted.js";

const SENSOR = 36, ASPECT = 16 / 9, NEAR = 15, STILL = 5;
/** Angle of a step by the keyboard (rad). */
const TURN = Math.PI / 24;
/** How much farther one stands from a machine that is taken apart by its own size. */
const ROOM = 0.4;
/** Pixels of the picture for one of the page while WebGL in software plays. */
const COARSE = 0.5;

export class Solid {
  /** @param {HTMLCanvasElement} canvas  @param {import("../app.js").App} app  Throws where there is no WebGL. */
  constructor(canvas, app) {
    this.canvas = canvas;
    this.app = app;
    const soft = cardIsPlayed();
    if (soft === null) throw new Error("a context of WebGL 2 is refused");
    this.soft = soft;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: "high-performance" });
    this.renderer.localClippingEnabled = true;
    this.section = new Section();
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.scene = new Scene();
    this.machine = new Group();
    this.scene.add(this.machine);
    this.studio = new Studio(this.renderer, this.scene);
    this.camera = new PerspectiveCamera(30, ASPECT, 0.02, 60);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => app.redraw());
    Object.assign(this.controls, { enableDamping: false, maxPolarAngle: Math.PI * 0.495, minDistance: 0.25, maxDistance: 25, zoomToCursor: true });
    this.controls.keys = {};
    this.arrows = new Arrows();
    this.trails = new Trails();
    this.marks = new Marks();
    this.ghosts = new Ghosts();
    this.labels = new Labels(app.parts.labels);
    this.parts = null;
    this.size = [1, 1];
    this.listen();
    this.update();
    this.home();
  }

  get dark() { return this.app.dark; }

  /** Take what the app's payload is now; the camera stays. */
  update() {
    const { payload, motion } = this.app, { solid } = payload;
    if (this.parts?.solid !== solid) {
      const seen = this.parts && [this.camera.position, this.controls.target].map((one) => this.machine.worldToLocal(one.clone()));
      this.parts?.dispose();
      this.parts = new Parts(solid, this.soft, () => this.app.redraw());
      this.machine.add(this.parts.group);
      this.radius = solid.size / 2;
      this.machine.scale.setScalar(1 / this.radius);
      this.machine.quaternion.setFromRotationMatrix(turnOf(solid.axes));
      this.machine.position.set(...solid.middle).applyQuaternion(this.machine.quaternion).multiplyScalar(-1 / this.radius);
      this.machine.updateMatrixWorld(true);
      if (seen) { // the view stays, in metres
        this.camera.position.copy(this.machine.localToWorld(seen[0]));
        this.controls.target.copy(this.machine.localToWorld(seen[1]));
        this.controls.update();
      }
      this.dress = null;
      this.look = null;
    }
    this.machine.add(this.arrows.group, this.trails.group, this.marks.group, this.ghosts.group);
    this.arrows.clear();
    this.trails.update(payload, this.trails.ink);
    this.ghosted = null;
    this.parts.move(motion);
  }

  /** World of the picture from places (m). @returns {Vector3} */
  world(x, y, z) { return new Vector3(x, y, z).applyMatrix4(this.machine.matrixWorld); }

  home() {
    const { camera } = this.app.payload.solid;
    this.camera.position.copy(this.world(...camera.position));
    this.controls.target.copy(this.world(...camera.target));
    this.lens = camera.lens;
    this.aim();
    this.controls.update();
  }

  aim() {
    const aspect = this.size[0] / this.size[1], half = SENSOR / (2 * this.lens);
    this.tangent = half / Math.min(aspect, ASPECT);
    this.camera.fov = (2 * Math.atan(this.tangent) * 180) / Math.PI;
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
  }

  resize(width, height, ratio) {
    this.size = [width, height];
    this.ratio = ratio;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.aim();
  }

  zoom(factor) {
    this.camera.position.sub(this.controls.target).divideScalar(factor).add(this.controls.target);
    this.controls.update();
  }

  /** Look from elsewhere, by steps to the right and up. */
  turn(right, up) {
    const { target, maxPolarAngle } = this.controls, from = this.camera.position.clone().sub(target);
    const polar = Math.min(Math.max(Math.acos(from.z / from.length()) - TURN * up, 0.02), maxPolarAngle);
    const azimuth = Math.atan2(from.y, from.x) + TURN * right, flat = from.length() * Math.sin(polar);
    this.camera.position.set(flat * Math.cos(azimuth), flat * Math.sin(azimuth), from.length() * Math.cos(polar)).add(target);
    this.controls.update();
  }

  /** Pixels of a place (m) given as a vector, which is changed. @returns {[number, number]} */
  pixel(vector) {
    vector.applyMatrix4(this.machine.matrixWorld).project(this.camera);
    return [((vector.x + 1) / 2) * this.size[0], ((1 - vector.y) / 2) * this.size[1]];
  }

  /** The plane of the machine as it is seen, for who draws on paper: at the mean height of the joints. */
  get paper() {
    const heights = Object.values(this.app.payload.solid.heights.joints), z = heights.reduce((sum, one) => sum + one, 0) / (heights.length || 1), place = new Vector3();
    return { pixel: (x, y) => this.pixel(place.set(x, y, z)), scale: this.pixelsPerMetre() };
  }

  pixelsPerMetre() {
    return this.size[1] / (2 * this.tangent * this.camera.position.distanceTo(this.controls.target) * this.radius);
  }

  draw() {
    const { payload, motion, store, dark } = this.app, { shown } = store.state, { solid } = payload;
    const look = solid.looks[dark ? "dark" : "light"], ratio = this.soft && store.state.playing ? COARSE : this.ratio;
    if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
    if (this.look !== look) {
      const [x, y, z] = solid.axes[2], [u, v, w] = solid.middle;
      this.studio.set(look, solid.camera.azimuth, (solid.floor - (x * u + y * v + z * w)) / this.radius, solid.reach / this.radius);
      drawn(this.parts, look.drawing);
      this.look = look;
    }
    const dress = payload.other ? "dim" : shown.glass ? "glass" : "";
    const neutral = showsArrows(shown);
    if (this.dress !== dress || this.neutral !== neutral) this.parts.dress((this.dress = dress), (this.neutral = neutral));
    this.stand(store.state.apart);
    this.parts.move(motion);
    this.machine.updateMatrixWorld(true);
    this.section.draw(this.parts, store.state.cut, store.state.cutSide, this.machine, this.camera.position);
    this.ghosts.group.visible = !!shown.ghosts;
    if (shown.ghosts && this.ghosted !== this.parts) {
      this.ghosts.update(this.parts, motion);
      this.ghosted = this.parts;
    }
    const colours = inks(look.dark, payload.bodies), raised = (z) => this.parts.raised(z);
    const lifted = (list) => list.map((one) => ({ ...one, at: [one.at[0], one.at[1], raised(one.at[2])] }));
    this.trails.group.visible = !!shown.trails;
    if (shown.trails) this.trails.draw(payload, motion, colours.trail, raised);
    this.arrows.draw(payload, motion, shown, colours.arrows, raised);
    this.marks.show(lifted(wantedMarks(this.app)), colours, this.size[1], this.tangent * this.radius);
    this.renderer.render(this.scene, this.camera);
    this.labels.show(lifted(wantedLabels(this.app)), (vector) => this.pixel(vector));
  }

  /** Take the machine apart, and stand so far away that all of it is seen. */
  stand(apart) {
    if (this.parts.apart === apart) return;
    this.parts.explode(apart);
    this.camera.zoom = 1 / (1 + ROOM * (this.parts.tallest / this.app.payload.solid.size) * apart);
    this.camera.updateProjectionMatrix();
  }

  listen() {
    let start = null;
    this.canvas.addEventListener("pointerdown", (event) => { start = event.isPrimary && event.button === 0 ? [event.clientX, event.clientY] : null; });
    this.canvas.addEventListener("pointerup", (event) => {
      if (!start || Math.hypot(event.clientX - start[0], event.clientY - start[1]) > STILL) return;
      const box = this.canvas.getBoundingClientRect();
      this.app.select(this.thingAt(event.clientX - box.left, event.clientY - box.top));
    });
  }

  /** @returns {import("../state.js").Thing | null} a joint or point near a pixel, else the body there */
  thingAt(px, py) {
    const { payload, motion } = this.app;
    let best = null, nearest = NEAR;
    const look = (kind, name) => {
      const [u, v, z] = motion.spot(kind, name), [x, y] = this.pixel(new Vector3(u, v, this.parts.raised(z))), away = Math.hypot(x - px, y - py);
      if (away < nearest) [best, nearest] = [{ kind, name }, away];
    };
    for (const name in payload.joints) look("joint", name);
    for (const name in payload.points) look("point", name);
    if (best) return best;
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2((2 * px) / this.size[0] - 1, 1 - (2 * py) / this.size[1]), this.camera);
    const hit = ray.intersectObjects(this.parts.meshes, false)[0];
    const name = hit?.object.userData.body;
    return name && name in payload.bodies ? { kind: "body", name } : null;
  }
}

/** Turns places of the model into those of the picture. @param {number[][]} axes right, away, up */
function turnOf([a, b, c]) { return new Matrix4().set(...a, 0, ...b, 0, ...c, 0, 0, 0, 0, 1); }
