// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The body points: small and grey where nothing is felt, larger and coloured by effective viscosity
// where something is; and the drag on each, as a line along its force.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  Group,
  LineSegments,
  Points,
  ShaderMaterial,
  SRGBColorSpace,
} from "three";
import { viscosityColour } from "../colour/rank_palette";
import type { BodyPoints, Snapshot } from "../protocol/snapshot";
import type { Look } from "./look";
import { flatMaterial, type PlainMaterial } from "./material";
import { placePoints } from "./rigid";

const vertexShader = /* glsl */ `
  attribute vec3 colour;
  attribute float felt;
  uniform float pixels;
  varying vec3 vColour;
  varying float vFelt;

  void main() {
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    seen.z += 0.004; // towards the camera, out of the surface it lies on
    gl_Position = projectionMatrix * seen;
    vColour = colour;
    vFelt = felt;
    gl_PointSize = pixels * (felt > 0.5 ? 6.5 : 2.0);
  }`;

const fragmentShader = /* glsl */ `
  varying vec3 vColour;
  varying float vFelt;

  void main() {
    float radius = length(gl_PointCoord - 0.5);
    if (radius > 0.5) discard;
    vec3 edge = vFelt > 0.5 && radius > 0.36 ? vec3(0.01) : vColour;
    gl_FragColor = vec4(edge, 1.0);
    #include <colorspace_fragment>
  }`;

export function pointMaterial(pixelRatio: number): ShaderMaterial {
  return new ShaderMaterial({ vertexShader, fragmentShader, uniforms: { pixels: { value: pixelRatio } } });
}

export class FeltPoints {
  readonly group = new Group();
  private readonly place: Float32Array<ArrayBuffer>;
  private readonly colour: Float32Array<ArrayBuffer>;
  private readonly felt: Float32Array<ArrayBuffer>;
  private readonly ends: Float32Array<ArrayBuffer>;
  private readonly dots: Points<BufferGeometry, ShaderMaterial>;
  private readonly lines: LineSegments<BufferGeometry, PlainMaterial>;
  private resting = new Color();

  constructor(
    private readonly points: BodyPoints,
    pixelRatio: number,
  ) {
    const n = points.link.length;
    this.place = new Float32Array(3 * n);
    this.colour = new Float32Array(3 * n);
    this.felt = new Float32Array(n);
    this.ends = new Float32Array(6 * n);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(this.place, 3));
    geometry.setAttribute("colour", new BufferAttribute(this.colour, 3));
    geometry.setAttribute("felt", new BufferAttribute(this.felt, 1));
    this.dots = new Points(geometry, pointMaterial(pixelRatio));
    const lines = new BufferGeometry();
    lines.setAttribute("position", new BufferAttribute(this.ends, 3));
    this.lines = new LineSegments(lines, flatMaterial());
    this.dots.frustumCulled = this.lines.frustumCulled = false; // their bounds change every frame
    this.group.add(this.dots, this.lines);
  }

  showDots(shown: boolean): void {
    this.dots.visible = shown;
  }
  showDrag(shown: boolean): void {
    this.lines.visible = shown;
  }

  setLook(look: Look): void {
    this.resting = new Color(look.restingPoint);
    this.lines.material.setColour(look.drag);
  }

  /** @param largest viscosity at the dark end of the scale; @param metresPerNewton of the lines */
  update(snapshot: Snapshot, largest: number, metresPerNewton: number): void {
    const { pointViscosity: mu, pointDrag: drag } = snapshot;
    if (mu.length !== this.felt.length) return; // of another arm: its points are on their way
    placePoints(this.points.place, this.points.link, snapshot.links, this.place);
    const colour = new Color();
    let drawn = 0;
    for (let n = 0; n < mu.length; ++n) {
      const felt = mu[n]! > 0;
      this.felt[n] = felt ? 1 : 0;
      if (felt) colour.setRGB(...viscosityColour(mu[n]!, largest), SRGBColorSpace);
      else colour.copy(this.resting);
      colour.toArray(this.colour, 3 * n);
      if (drag[3 * n] === 0 && drag[3 * n + 1] === 0 && drag[3 * n + 2] === 0) continue;
      for (let axis = 0; axis < 3; ++axis) {
        const from = this.place[3 * n + axis]!;
        this.ends[6 * drawn + axis] = from;
        this.ends[6 * drawn + 3 + axis] = from + metresPerNewton * drag[3 * n + axis]!;
      }
      drawn += 1;
    }
    for (const attribute of Object.values(this.dots.geometry.attributes)) {
      (attribute as BufferAttribute).needsUpdate = true;
    }
    (this.lines.geometry.getAttribute("position") as BufferAttribute).needsUpdate = true;
    this.lines.geometry.setDrawRange(0, 2 * drawn);
  }

  dispose(): void {
    this.group.removeFromParent();
    for (const drawn of [this.dots, this.lines]) {
      drawn.geometry.dispose();
      drawn.material.dispose();
    }
  }
}
