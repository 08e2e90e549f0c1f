// Light as in the thumbnails (worker/pictures/shading.py): a lamp over the left shoulder of whoever looks.

import { ShaderMaterial } from "../vendor/three.js";

const VERTICES = `
  varying vec3 normalSeen; // right, up, towards the camera
  varying vec3 painted; // linear, as glTF has it
  void main() {
    normalSeen = normalMatrix * normal;
    painted = color.rgb;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

const PIXELS = `
  varying vec3 normalSeen;
  varying vec3 painted;
  const vec3 LAMP = vec3(-0.45, 0.65, 0.85);
  const float WRAP = 0.25, AMBIENT = 0.62, SKY = 0.1, BRIGHTEST = 1.04;
  vec3 sRGB(vec3 linear) {
    return mix(linear * 12.92, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, linear));
  }
  void main() {
    vec3 seen = normalize(normalSeen) * (gl_FrontFacing ? 1.0 : -1.0);
    float lit = clamp((dot(seen, normalize(LAMP)) + WRAP) / (1.0 + WRAP), 0.0, 1.0);
    float brightness = AMBIENT + SKY * seen.y + (BRIGHTEST - AMBIENT) * lit;
    gl_FragColor = vec4(clamp(sRGB(painted) * brightness, 0.0, 1.0), 1.0);
  }`;

/** A surface in its own colours; `side` as in three. */
export const painted = (side) => new ShaderMaterial({ vertexShader: VERTICES, fragmentShader: PIXELS, vertexColors: true, side });
