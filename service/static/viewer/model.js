// A mesh of the service, ready to be shown: in the middle, as large as every other.

import { GLTFLoader } from "../vendor/three.js";
import { request } from "../shared/api.js";
import { painted } from "./light.js";

/**
 * Load a mesh with colours at its vertices.
 *
 * @param {string} address - of a GLB
 * @param {AbortSignal} signal
 * @returns {Promise<object>} a mesh of three, within the unit sphere; see `discard`
 */
export async function loadModel(address, signal) {
  const file = await (await request(address, { signal })).arrayBuffer();
  const { scene } = await new GLTFLoader().parseAsync(file, "");
  const mesh = scene.getObjectByProperty("isMesh", true);
  mesh.material.dispose();
  mesh.material = painted(mesh.material.side);
  return centred(mesh);
}

function centred(mesh) {
  mesh.geometry.computeBoundingSphere();
  const { center, radius } = mesh.geometry.boundingSphere;
  mesh.scale.setScalar(1 / radius);
  mesh.position.copy(center).divideScalar(-radius);
  return mesh;
}

/** Free what a model holds on the graphics card. */
export function discard(mesh) {
  mesh.removeFromParent();
  mesh.geometry.dispose();
  mesh.material.dispose();
}
