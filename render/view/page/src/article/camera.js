/** The camera of an article: it goes to what a paragraph is about, and goes with it. */
import { Vector3 } from "three";

const SECONDS = 0.9, NEAR = 0.62, FILLED = 0.86, LEAST = 0.6, MOST = 1.1, CLOSER = 2;
/** Of a way; of the distance from the whole machine; part of the stage that it fills, and how far from the film's distance it is
 * seen for that; times the size of the skeleton. */

export class Camera {
  /** @param {import("../app.js").App} app */
  constructor(app) {
    this.app = app;
    this.near = null;
    this.part = 1;
  }

  /** @param {[string, string] | null} near kind and name of what is looked at; null: the whole machine  @param {boolean} still at once */
  look(near, still) {
    const [kind, name] = near ?? [];
    this.near = near ? { kind, name } : null;
    this.part = still ? 1 : 0;
    this.began = 0;
    this.from = null;
    this.on = true;
    this.app.redraw();
  }

  /** The reader moves it now. */
  stop() { this.on = false; }

  /** Where it looks at the moment, and how far it is on its way; before each picture. */
  draw(now) {
    if (!this.on) return;
    this.began ||= now;
    const raw = this.part < 1 ? Math.min((now - this.began) / (1000 * SECONDS), 1) : 1, part = raw * raw * (3 - 2 * raw);
    const place = this.near && this.app.placeOf(this.near), { stage } = this.app;
    if (stage.flat) this.plane(stage.plane.paper, place, part);
    else this.solid(stage.solid, place, part);
    if (raw >= 1) this.part = 1;
    if (raw < 1) this.app.redraw();
    else if (!this.near) this.on = false;
  }

  plane(paper, place, part) {
    this.from ??= { zoom: paper.zoom, pan: [...paper.pan] };
    const zoom = place ? CLOSER : 1, pan = place ? this.centred(paper, place, zoom) : [0, 0];
    paper.zoom = this.from.zoom + part * (zoom - this.from.zoom);
    paper.pan = pan.map((to, k) => this.from.pan[k] + part * (to - this.from.pan[k]));
  }

  /** The pan that brings a place into the middle. */
  centred(paper, [x, y], zoom) {
    const { scale } = paper, k = (scale / paper.zoom) * zoom;
    return [-k * (x - (paper.low[0] + paper.high[0]) / 2), k * (y - (paper.low[1] + paper.high[1]) / 2)];
  }

  /** The distance at which all of it fills the stage, in that of the film, which is composed for another shape. */
  whole(solid) {
    const { size, parts } = solid, key = `${size} ${parts.group.uuid}`;
    if (key === this.measured) return this.filled;
    const { solid: payload, skeleton } = this.app.payload, { camera: first } = payload, eye = solid.camera.clone(), corners = [];
    eye.position.copy(solid.world(...first.position));
    eye.up.set(0, 0, 1);
    eye.lookAt(solid.world(...first.target));
    eye.zoom = 1;
    eye.updateProjectionMatrix();
    eye.updateMatrixWorld(true);
    for (const k of [0, 1, 2, 3]) for (const z of parts.reach([0, 0, 1])) corners.push(solid.world(k & 1 ? skeleton.high[0] : skeleton.low[0], k & 2 ? skeleton.high[1] : skeleton.low[1], z));
    for (const mesh of parts.meshes) {
      const { min, max } = mesh.geometry.boundingBox;
      for (const k of [0, 1, 2, 3, 4, 5, 6, 7]) corners.push(new Vector3(k & 1 ? max.x : min.x, k & 2 ? max.y : min.y, k & 4 ? max.z : min.z).applyMatrix4(mesh.matrixWorld));
    }
    const most = Math.max(...corners.flatMap((corner) => { const { x, y } = corner.project(eye); return [Math.abs(x), Math.abs(y)]; }));
    this.measured = key;
    this.filled = Math.min(Math.max(most / FILLED, LEAST), MOST);
    return this.filled;
  }

  solid(solid, place, part) {
    const { camera, controls } = solid, { camera: first } = this.app.payload.solid;
    this.from ??= { position: camera.position.clone(), target: controls.target.clone() };
    const target = solid.world(...first.target), position = solid.world(...first.position);
    position.sub(target).multiplyScalar(this.whole(solid) * (place ? NEAR : 1));
    if (place) {
      const [x, y, z] = this.app.spotOf(this.near);
      target.copy(solid.world(x, y, solid.parts.raised(z)));
    }
    position.add(target);
    controls.target.lerpVectors(this.from.target, target, part);
    camera.position.copy(new Vector3().lerpVectors(this.from.position, position, part));
    controls.update();
  }
}
