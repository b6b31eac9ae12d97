// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The ring at the tool that the mouse takes hold of, and the thread from the tool to where the hand
// pulls it: the longer the thread, the heavier the drag.
import {
  BufferAttribute,
  BufferGeometry,
  Group,
  Line,
  Mesh,
  MeshBasicMaterial,
  RingGeometry,
  SphereGeometry,
  Vector3,
  type Camera,
  type Raycaster,
} from "three";
import { flatMaterial, withoutNormals } from "./material";

// On the screen, whatever the distance: the ring's radius beside the height of the view.
const apparentSize = 0.028;

export class ToolHandle {
  readonly group = new Group();
  readonly place = new Vector3();
  private readonly ring: Mesh;
  private readonly target: Mesh;
  private readonly reach: Mesh;
  private readonly thread: Line;
  private readonly material = flatMaterial({ depthTest: false, opacity: 0.95 });
  private readonly line = flatMaterial({ depthTest: false });
  private taken = false;

  constructor() {
    this.ring = new Mesh(withoutNormals(new RingGeometry(0.78, 1, 40)), this.material);
    this.target = new Mesh(withoutNormals(new SphereGeometry(0.3, 16, 12)), this.material);
    // Takes hold a little beside the ring too; never drawn.
    this.reach = new Mesh(new SphereGeometry(1.35, 12, 8), new MeshBasicMaterial({ visible: false }));
    const ends = new BufferGeometry();
    ends.setAttribute("position", new BufferAttribute(new Float32Array(6), 3));
    this.thread = new Line(ends, this.line);
    this.thread.frustumCulled = false;
    for (const drawn of [this.ring, this.target, this.thread]) drawn.renderOrder = 70;
    this.group.add(this.ring, this.target, this.reach, this.thread);
  }

  setColour(colour: string): void {
    this.material.setColour(colour);
    this.line.setColour(colour);
  }

  take(taken: boolean): void {
    this.taken = taken;
  }

  /** @param tool its place; @param pulledTo where the hand pulls it */
  move(tool: Vector3, pulledTo: Vector3): void {
    this.place.copy(tool);
    this.target.position.copy(pulledTo);
    const ends = this.thread.geometry.getAttribute("position") as BufferAttribute;
    ends.setXYZ(0, tool.x, tool.y, tool.z);
    ends.setXYZ(1, pulledTo.x, pulledTo.y, pulledTo.z);
    ends.needsUpdate = true;
    this.target.visible = this.thread.visible = this.taken || tool.distanceTo(pulledTo) > 1e-3;
  }

  /** Keeps its size on the screen. Called before each frame. */
  face(camera: Camera, fovDegrees: number): void {
    const size =
      2 * apparentSize * camera.position.distanceTo(this.place) * Math.tan((fovDegrees * Math.PI) / 360);
    for (const part of [this.ring, this.reach]) {
      part.position.copy(this.place);
      part.scale.setScalar(size);
      part.quaternion.copy(camera.quaternion);
    }
    this.target.scale.setScalar(size);
  }

  isUnder(ray: Raycaster): boolean {
    this.reach.updateMatrixWorld();
    const material = this.reach.material as MeshBasicMaterial;
    material.visible = true; // what is not visible is not hit
    const hit = ray.intersectObject(this.reach, false).length > 0;
    material.visible = false;
    return hit;
  }
}
