/** A look that is a drawing: solids a little lighter than the paper, their outlines and edges as lines. */
import { BackSide, Color, EdgesGeometry, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, SRGBColorSpace } from "three";

/** Degrees between two faces from which there is an edge between them. */
const TURN = 24;
/** Width of an outline, as a part of the radius of the swept motion. */
const OUTLINE = 0.004;

/** Draw the parts, or give them their own surfaces back. @param {import("./parts.js").Parts} parts  @param {any} drawing */
export function drawn(parts, drawing) {
  if (drawing && !parts.drawing) {
    const paper = new Color().setRGB(...drawing.paper, SRGBColorSpace), line = new Color().setRGB(...drawing.line, SRGBColorSpace);
    const face = new MeshLambertMaterial({
      color: paper.clone().lerp(line, 1.4 * drawing.tone), emissive: paper, emissiveIntensity: 0.8, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
    const ink = new LineBasicMaterial({ color: line }), hull = outlines(line, (OUTLINE * parts.solid.size) / 2), known = new Map();
    parts.drawing = parts.meshes.map((mesh) => {
      let edges = known.get(mesh.geometry);
      if (!edges) known.set(mesh.geometry, (edges = new EdgesGeometry(mesh.geometry, TURN)));
      const lines = new LineSegments(edges, ink), around = new Mesh(mesh.geometry, hull), own = mesh.material;
      lines.raycast = around.raycast = () => {};
      mesh.material = face;
      mesh.add(lines, around);
      return { mesh, own, lines, around };
    });
  } else if (!drawing && parts.drawing) {
    for (const { mesh, own, lines, around } of parts.drawing) {
      mesh.material = own;
      lines.removeFromParent();
      around.removeFromParent();
      lines.geometry.dispose();
    }
    parts.drawing = null;
  }
}

/** The back of a solid that is a little larger: what is seen of it is an outline. @param {number} width m */
function outlines(color, width) {
  const made = new MeshBasicMaterial({ color, side: BackSide });
  made.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace("#include <begin_vertex>", `#include <begin_vertex>\n  transformed += normal * ${width.toFixed(7)};`);
  };
  return made;
}
