/** Surfaces of the film as three.js has them. Colours are linear. */
import { Color, MeshPhysicalMaterial, MeshStandardMaterial } from "three";

/**
 * @param {{colour: number[], finish: string, roughness: number, metal: number, coat: number}} surface
 * @param {boolean} soft whether WebGL is in software: then without varnish
 */
export function materialOf(surface, soft) {
  const look = {
    color: new Color().setRGB(...surface.colour), metalness: surface.metal, roughness: Math.max(surface.roughness, 0.18),
    envMapIntensity: surface.metal ? 1 : 0.9,
  };
  if (soft || !surface.coat) return new MeshStandardMaterial(look);
  return new MeshPhysicalMaterial({ ...look, clearcoat: surface.coat, clearcoatRoughness: 0.2 });
}

/** Half transparent, or as it is. @param {MeshStandardMaterial} material */
export function setGlass(material, glass) {
  material.transparent = glass;
  material.opacity = glass ? 0.3 : 1;
  material.depthWrite = !glass;
  material.needsUpdate = true;
}
