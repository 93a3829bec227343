/** Surfaces of the film as three.js has them. Colours are linear. */
import { Color, MeshPhysicalMaterial } from "three";

/** @param {{colour: number[], finish: string, roughness: number, metal: number, coat: number}} surface */
export function materialOf(surface) {
  return new MeshPhysicalMaterial({
    color: new Color().setRGB(...surface.colour),
    metalness: surface.metal,
    roughness: Math.max(surface.roughness, 0.18),
    clearcoat: surface.coat,
    clearcoatRoughness: 0.2,
    envMapIntensity: surface.metal ? 1 : 0.9,
  });
}

/** Half transparent, or as it is. @param {MeshPhysicalMaterial} material */
export function setGlass(material, glass) {
  material.transparent = glass;
  material.opacity = glass ? 0.3 : 1;
  material.depthWrite = !glass;
  material.needsUpdate = true;
}
