/** Flat signs that face the camera: the selected joint or point, centres of mass. Sizes in pixels. */
import { CanvasTexture, Group, Sprite, SpriteMaterial, SRGBColorSpace } from "three";

const PIXELS = { selected: 30, centre: 18, joint: 11, gap: 20 };

export class Marks {
  constructor() {
    this.group = new Group();
    this.materials = {};
    this.pool = [];
  }

  /** @param {{kind: keyof typeof PIXELS, at: [number, number, number]}[]} wanted  @param {number} height of the view in pixels
   *  @param {number} tangent of half the field of view, times metres in a unit of the world */
  show(wanted, colours, height, tangent) {
    while (this.pool.length < wanted.length) {
      const sprite = new Sprite();
      sprite.renderOrder = 20;
      this.pool.push(sprite);
      this.group.add(sprite);
    }
    this.pool.forEach((sprite, k) => {
      const one = wanted[k];
      sprite.visible = !!one;
      if (!one) return;
      sprite.material = this.material(one.kind, colours);
      sprite.position.set(...one.at);
      const size = (2 * tangent * PIXELS[one.kind]) / height;
      sprite.scale.set(size, size, 1);
    });
  }

  material(kind, colours) {
    const key = `${kind} ${colours.driver}`;
    return (this.materials[key] ??= new SpriteMaterial({ map: sign(kind, colours), depthTest: false, depthWrite: false, transparent: true, toneMapped: false, sizeAttenuation: false }));
  }
}

function sign(kind, colours) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 128;
  const g = canvas.getContext("2d");
  const disc = (r, colour, from = 0, to = 7) => {
    g.fillStyle = colour;
    g.beginPath();
    g.moveTo(64, 64);
    g.arc(64, 64, r, from, to);
    g.fill();
  };
  if (kind === "selected") {
    g.strokeStyle = colours.driver;
    g.lineWidth = 9;
    g.beginPath();
    g.arc(64, 64, 54, 0, 7);
    g.stroke();
    disc(22, colours.driver);
  } else if (kind === "joint") {
    disc(60, colours.paper);
    disc(44, colours.ink);
  } else if (kind === "gap") {
    for (const [colour, width] of [[colours.paper, 34], [colours.wrong, 17]]) { // seen before parts of any colour
      g.strokeStyle = colour;
      g.lineWidth = width;
      g.beginPath();
      g.arc(64, 64, 46, 0, 7);
      g.stroke();
    }
  } else {
    disc(60, colours.ink);
    disc(52, colours.paper);
    disc(52, colours.ink, 0, Math.PI / 2);
    disc(52, colours.ink, Math.PI, 1.5 * Math.PI);
  }
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  return texture;
}
