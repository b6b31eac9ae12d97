// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// What solid things, lines and the slice are painted with. Shaders of a few lines and no more of them
// than needed: where the processor draws for want of a graphics card, making three.js's own took
// longer than all else about opening the page.
import { Color, DoubleSide, ShaderMaterial, Vector4, type BufferGeometry, type DataTexture } from "three";

/** A plane in W, unit normal and constant [m], as shaders read it: what lies behind it is not drawn. */
export interface Cut {
  value: Vector4;
}

/** Behind this one there is nothing. */
export function noCut(): Cut {
  return { value: new Vector4(0, 0, 0, 1) };
}

/** How far a place in W is before the cut: into a vertex shader and a fragment shader. */
export const cutVertex = /* glsl */ `
  uniform vec4 cut;
  varying float vBefore;
  void cutAt(vec3 place) { vBefore = dot(cut.xyz, place) + cut.w; }`;
export const cutFragment = /* glsl */ `
  varying float vBefore;
  void cutAway() { if (vBefore < 0.0) discard; }`;

const flatVertex = /* glsl */ `
  ${cutVertex}
  void main() {
    vec4 place = modelMatrix * vec4(position, 1.0);
    cutAt(place.xyz);
    gl_Position = projectionMatrix * viewMatrix * place;
  }`;

const flatFragment = /* glsl */ `
  uniform vec3 colour;
  uniform float opacity;
  ${cutFragment}
  void main() {
    cutAway();
    gl_FragColor = vec4(colour, opacity);
    #include <colorspace_fragment>
  }`;

const litVertex = /* glsl */ `
  ${cutVertex}
  varying vec3 vNormal;
  void main() {
    vec4 place = modelMatrix * vec4(position, 1.0);
    vNormal = mat3(modelMatrix) * normal; // poses turn and scale alike in all directions
    cutAt(place.xyz);
    gl_Position = projectionMatrix * viewMatrix * place;
  }`;

// The room's light, in W: a pale sky, a darker floor, and a lamp over the left shoulder of whoever looks from the front.
const litFragment = /* glsl */ `
  uniform vec3 colour;
  uniform float opacity;
  ${cutFragment}
  varying vec3 vNormal;
  void main() {
    cutAway();
    vec3 normal = normalize(gl_FrontFacing ? vNormal : -vNormal);
    vec3 light = mix(vec3(0.24, 0.26, 0.29), vec3(0.59), 0.5 + 0.5 * normal.z);
    light += 0.54 * max(0.0, dot(normal, vec3(-0.303, -0.505, 0.808)));
    gl_FragColor = vec4(colour * light, opacity);
    #include <colorspace_fragment>
  }`;

const sliceVertex = /* glsl */ `
  varying vec2 vPixel;
  void main() {
    vPixel = uv;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

// Pixels are shown as they were painted.
const sliceFragment = /* glsl */ `
  uniform sampler2D pixels;
  varying vec2 vPixel;
  void main() {
    gl_FragColor = texture2D(pixels, vPixel);
    if (gl_FragColor.a < 0.5) discard;
  }`;

/** What of a material differs from a thing to the next: by default opaque, and hidden by what is before it. */
export interface Paint {
  opacity?: number;
  depthTest?: boolean;
  depthWrite?: boolean;
  cut?: Cut;
}

/** One colour and opacity all over. */
export class PlainMaterial extends ShaderMaterial {
  constructor(shaders: { vertexShader: string; fragmentShader: string }, paint: Paint, transparent: boolean) {
    super({
      ...shaders,
      uniforms: {
        colour: { value: new Color() },
        opacity: { value: paint.opacity ?? 1 },
        cut: paint.cut ?? noCut(),
      },
      side: DoubleSide,
      transparent,
      depthTest: paint.depthTest ?? true,
      depthWrite: paint.depthWrite ?? true,
    });
  }

  /** @param colour as CSS writes it; @param opacity 0..1; without it, what it was */
  setColour(colour: string, opacity?: number): void {
    (this.uniforms.colour!.value as Color).set(colour);
    if (opacity !== undefined) this.uniforms.opacity!.value = opacity;
  }
}

/** Of one colour whatever the light: lines, handles, arrows. */
export function flatMaterial(paint: Paint = {}): PlainMaterial {
  return new PlainMaterial({ vertexShader: flatVertex, fragmentShader: flatFragment }, paint, true);
}

/** Geometry for a flat material: three.js makes another shader where there are normals that nobody reads. */
export function withoutNormals(geometry: BufferGeometry): BufferGeometry {
  return geometry.deleteAttribute("normal");
}

/** A surface in the room's light, both sides of it. */
export function litMaterial(paint: Paint = {}): PlainMaterial {
  const transparent = (paint.opacity ?? 1) < 1;
  return new PlainMaterial({ vertexShader: litVertex, fragmentShader: litFragment }, paint, transparent);
}

/** The painted pixels of a slice; those that let more than half through are left out. */
export function sliceMaterial(pixels: { value: DataTexture | null }): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: sliceVertex,
    fragmentShader: sliceFragment,
    uniforms: { pixels },
    side: DoubleSide,
    transparent: true,
  });
}
