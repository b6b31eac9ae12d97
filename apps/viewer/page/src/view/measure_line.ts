// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A line between two picked points, and where on the screen its length is to be written.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  Group,
  Line,
  Points,
  PointsMaterial,
  Vector3,
  type Camera,
} from "three";
import { flatMaterial } from "./material";

export class MeasureLine {
  readonly group = new Group();
  private ends: Vector3[] = [];
  private readonly geometry = new BufferGeometry();
  private readonly line = flatMaterial({ depthTest: false });
  private readonly dot = new PointsMaterial({ size: 7, sizeAttenuation: false, depthTest: false, transparent: true });

  constructor() {
    this.geometry.setAttribute("position", new BufferAttribute(new Float32Array(6), 3));
    const drawn = [new Line(this.geometry, this.line), new Points(this.geometry, this.dot)];
    for (const part of drawn) {
      part.renderOrder = 80;
      part.frustumCulled = false;
    }
    this.group.add(...drawn);
    this.update();
  }

  setColour(colour: string): void {
    this.line.setColour(colour);
    this.dot.color = new Color(colour);
  }

  /** A third point begins a new line. */
  add(point: Vector3): void {
    this.ends = this.ends.length >= 2 ? [point] : [...this.ends, point];
    this.update();
  }

  clear(): void {
    this.ends = [];
    this.update();
  }

  /** Both ends, once there are two. */
  get span(): { from: Vector3; to: Vector3; length: number } | null {
    const [from, to] = this.ends;
    return from && to ? { from, to, length: from.distanceTo(to) } : null;
  }

  /** The line's middle on the screen, -1..1; null where there is no line or it is behind. */
  middle(camera: Camera): { x: number; y: number } | null {
    const span = this.span;
    if (!span) return null;
    const middle = span.from.clone().lerp(span.to, 0.5).project(camera);
    return middle.z < 1 ? { x: middle.x, y: middle.y } : null;
  }

  private update(): void {
    const places = this.geometry.getAttribute("position") as BufferAttribute;
    this.ends.forEach((end, n) => places.setXYZ(n, end.x, end.y, end.z));
    places.needsUpdate = true;
    this.geometry.setDrawRange(0, this.ends.length);
    this.group.visible = this.ends.length > 0;
  }
}
