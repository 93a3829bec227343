/** Surfaces of the film as three.js has them. Colours are linear. */
import { Color, MeshPhysicalMaterial, MeshStandardMaterial } from "three";

/**
 * @param {{colour: number[], finish: string, roughness: number, metal: number, coat: number}} surface
 * @param {boolean} soft whether WebGL is in software: then without varnish
 */
export function materialOf(surface, soft) {
  const look = {
    color: new Color().setRGB(...surface.colour), metalness: surface.metal, roughness: Math.max(surface.roughness, 0.18),
    envMapIntensity: surface.metal ? 1 : 0.9, userData: { clear: surface.clear },
  };
  if (soft || !surface.coat) return new MeshStandardMaterial(look);
  return new MeshPhysicalMaterial({ ...look, clearcoat: surface.coat, clearcoatRoughness: 0.2 });
}

const DIM = 0.5, GREY = new Color(0.32, 0.34, 0.37);

/** As it is, half transparent, or dimmed: greyer, and seen through as one. @param {"" | "glass" | "dim"} look */
export function setLook(material, look, neutral = false) {
  const own = (material.userData.colour ??= material.color.clone());
  material.color.copy(neutral ? greyed(own) : own);
  if (look === "dim") material.color.lerp(GREY, DIM);
  const clear = material.userData.clear;
  material.transparent = look !== "" || clear < 1;
  material.opacity = ({ glass: 0.3, dim: 0.62 }[look] ?? 1) * clear;
  material.depthWrite = look !== "glass";
  material.needsUpdate = true;
}

/** A grey as light as a colour: beside arrows, whose colours belong to quantities, no part has one (render/film/pieces.py). */
function greyed({ r, g, b }) {
  const light = 0.2126 * r + 0.7152 * g + 0.0722 * b;
  const grey = Math.max(r, g, b) - Math.min(r, g, b) > 0.05 ? 0.9 * Math.max(light, 0.14) : light;
  return new Color().setRGB(...[r, g, b].map((one) => 0.06 * one + 0.94 * grey));
}
