/** The path of a traced point as a thin light that fades behind it. */
import { BufferAttribute, BufferGeometry, Color, DoubleSide, Group, Mesh, MeshBasicMaterial } from "three";
import { cross } from "../data/space.js";
import { tailOf } from "../view2d/trails.js";

const RINGS = 220, SIDES = 8;

export class Trails {
  constructor() {
    this.group = new Group();
    this.made = [];
  }

  /** @param {string} ink  where the shot says no colour */
  update(payload, ink) {
    this.ink = ink;
    for (const { mesh } of this.made) mesh.geometry.dispose();
    this.group.clear();
    this.made = payload.trails.map((trail) => {
      const mesh = new Mesh(tube(trail.colour, ink), new MeshBasicMaterial({ vertexColors: true, transparent: true, side: DoubleSide, depthWrite: false, toneMapped: false }));
      mesh.frustumCulled = false;
      mesh.renderOrder = 5;
      this.group.add(mesh);
      return { trail, mesh };
    });
  }

  /** @param {string} ink  as {@link update} */
  /** @param {(z: number) => number} raised  where a height is in a machine that is apart */
  draw(payload, motion, ink, raised = (z) => z) {
    if (ink !== this.ink) this.update(payload, ink);
    for (const { trail, mesh } of this.made) {
      const at = () => (payload.space ? motion.spot("point", trail.point) : [...motion.point(trail.point), raised(trail.z)]);
      const places = tailOf(payload, motion, trail.tail, RINGS, at), { array } = mesh.geometry.attributes.position;
      for (let k = 0; k < RINGS; k++) {
        const a = places[Math.max(k - 1, 0)], b = places[Math.min(k + 1, RINGS - 1)];
        const way = unit(a.map((x, n) => b[n] - x)), side = unit(cross([0, 0, 1], way)), up = cross(way, side);
        const r = trail.radius * (1 - (k / (RINGS - 1)) ** 1.5 * 0.85);
        for (let n = 0; n < SIDES; n++) {
          const angle = (2 * Math.PI * n) / SIDES, c = r * Math.cos(angle), s = r * Math.sin(angle);
          for (let m = 0; m < 3; m++) array[3 * (k * SIDES + n) + m] = places[k][m] + c * side[m] + s * up[m];
        }
      }
      mesh.geometry.attributes.position.needsUpdate = true;
    }
  }
}

/** At length 1; the x axis for what has none. */
function unit(way) {
  const length = Math.hypot(...way);
  return length > 1e-12 ? way.map((x) => x / length) : [1, 0, 0];
}

function tube(colour, ink) {
  const geometry = new BufferGeometry(), colours = new Float32Array(4 * RINGS * SIDES), corners = [];
  const bright = (colour ? new Color().setRGB(...colour) : new Color(ink)).multiplyScalar(1.12);
  for (let k = 0; k < RINGS; k++) {
    for (let n = 0; n < SIDES; n++) {
      colours.set([bright.r, bright.g, bright.b, 0.95 * (1 - k / (RINGS - 1)) ** 1.6], 4 * (k * SIDES + n));
      if (k + 1 === RINGS) continue;
      const a = k * SIDES + n, b = k * SIDES + ((n + 1) % SIDES);
      corners.push(a, b, a + SIDES, b, b + SIDES, a + SIDES);
    }
  }
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * RINGS * SIDES), 3));
  geometry.setAttribute("color", new BufferAttribute(colours, 4));
  geometry.setIndex(corners);
  return geometry;
}
