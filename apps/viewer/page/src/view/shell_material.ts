// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Draws quads from the wire's words: the graphics card makes corners of them, so that a large field is
// on screen as soon as it has come.
import {
  Color,
  DataTexture,
  DoubleSide,
  RedFormat,
  ShaderMaterial,
  SRGBColorSpace,
  Vector3,
} from "three";
import type { Colour } from "../colour/rank_palette";
import { cutFragment, cutVertex, type Cut } from "./material";

const vertexShader = /* glsl */ `
  attribute uvec4 quad;
  uniform vec3 workspace;
  uniform float cell;
  uniform sampler2D hidden;
  varying float vLight;
  ${cutVertex}

  void main() {
    // Corners go round the face: 0 (0,0), 1 (1,0), 2 (1,1), 3 (0,1).
    int n = gl_VertexID & 3;
    float u = n == 1 || n == 2 ? 1.0 : 0.0, v = n >= 2 ? 1.0 : 0.0;
    uint face = (quad.z >> 16u) & 0xffu;
    uint object = quad.w & 0xffffu;
    vec3 corner = vec3(float(quad.x & 0xffffu), float(quad.x >> 16u), float(quad.y & 0xffffu));
    float a = float(quad.y >> 16u), b = float(quad.z & 0xffffu);
    float side = float(face & 1u);
    vec3 normal = vec3(0.0);
    uint axis = face >> 1u;
    if (axis == 0u) { corner += vec3(side, u * a, v * b); normal.x = 1.0; }
    else if (axis == 1u) { corner += vec3(u * a, side, v * b); normal.y = 1.0; }
    else { corner += vec3(u * a, v * b, side); normal.z = 1.0; }
    normal *= 2.0 * side - 1.0;
    vLight = 0.80 + 0.20 * dot(normal, normalize(vec3(-0.35, -0.55, 0.75)));
    vec3 place = workspace + cell * corner;
    cutAt(place);
    gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
    float gone = texelFetch(hidden, ivec2(object & 255u, object >> 8u), 0).r;
    if (gone > 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  }`;

const fragmentShader = /* glsl */ `
  uniform vec3 colour;
  uniform float opacity;
  varying float vLight;
  ${cutFragment}

  void main() {
    cutAway();
    gl_FragColor = vec4(colour * vLight, opacity);
    #include <colorspace_fragment>
  }`;

/** Which objects are hidden, as the shells' shader reads it: 256 to a row. */
export class HiddenObjects {
  readonly texture: DataTexture;
  private readonly bytes: Uint8Array<ArrayBuffer>;

  constructor(count: number) {
    const rows = Math.max(1, Math.ceil(count / 256));
    this.bytes = new Uint8Array(256 * rows);
    this.texture = new DataTexture(this.bytes, 256, rows, RedFormat);
    this.texture.needsUpdate = true;
  }

  set(object: number, hidden: boolean): void {
    this.bytes[object] = hidden ? 255 : 0;
    this.texture.needsUpdate = true;
  }

  has(object: number): boolean {
    return this.bytes[object] === 255;
  }
}

export interface ShellLook {
  colour: Colour;
  opacity: number;
  origin: Vector3;
  cell: number;
  hidden: HiddenObjects;
  cut: Cut;
}

/** @param depthOnly a first pass that leaves only the nearest surface of a shell to be coloured */
export function shellMaterial(look: ShellLook, depthOnly: boolean): ShaderMaterial {
  const opaque = look.opacity >= 1;
  return new ShaderMaterial({
    vertexShader,
    fragmentShader,
    uniforms: {
      workspace: { value: look.origin },
      cell: { value: look.cell },
      hidden: { value: look.hidden.texture },
      colour: { value: new Color().setRGB(...look.colour, SRGBColorSpace) },
      opacity: { value: look.opacity },
      cut: look.cut,
    },
    side: DoubleSide,
    transparent: !opaque,
    depthWrite: opaque || depthOnly,
    colorWrite: !depthOnly,
    polygonOffset: depthOnly,
    polygonOffsetFactor: 0.5,
    polygonOffsetUnits: 1,
  });
}
