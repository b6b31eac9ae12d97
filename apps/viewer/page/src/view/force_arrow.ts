// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// An arrow from the tool along the force of all drag, solid so that it is seen from afar.
import { ConeGeometry, CylinderGeometry, Group, Mesh, Vector3 } from "three";
import { flatMaterial, withoutNormals } from "./material";

const up = new Vector3(0, 1, 0);

export class ForceArrow {
  readonly group = new Group();
  private readonly material = flatMaterial({ depthTest: false });
  private readonly shaft = new Mesh(withoutNormals(new CylinderGeometry(1, 1, 1, 12)), this.material);
  private readonly head = new Mesh(withoutNormals(new ConeGeometry(1, 1, 16)), this.material);

  /** @param thickness of the shaft [m] */
  constructor(private readonly thickness: number) {
    this.shaft.renderOrder = this.head.renderOrder = 60;
    this.group.add(this.shaft, this.head);
    this.group.visible = false;
  }

  setColour(colour: string): void {
    this.material.setColour(colour);
  }

  /** @param along the arrow, from `from` [m]; a very short one is not drawn */
  point(from: Vector3, along: Vector3): void {
    const length = along.length();
    this.group.visible = length > 2 * this.thickness;
    if (!this.group.visible) return;
    const head = Math.min(6 * this.thickness, 0.5 * length);
    this.group.position.copy(from);
    this.group.quaternion.setFromUnitVectors(up, along.clone().divideScalar(length));
    this.shaft.scale.set(this.thickness / 2, length - head, this.thickness / 2);
    this.shaft.position.set(0, (length - head) / 2, 0);
    this.head.scale.set(0.42 * head, head, 0.42 * head);
    this.head.position.set(0, length - head / 2, 0);
  }

  dispose(): void {
    this.group.removeFromParent();
    this.shaft.geometry.dispose();
    this.head.geometry.dispose();
    this.material.dispose();
  }
}
