// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// An arm: the meshes of its links, each at a pose that somebody else knows.
import { Group, Mesh } from "three";
import type { Robot } from "../protocol/hello";
import type { MeshAnswer } from "../protocol/shapes";
import { litMaterial } from "./material";
import { meshGeometry } from "./mesh_geometry";

export class Arm {
  readonly group = new Group();
  private readonly links: Group[];
  private readonly material = litMaterial();

  constructor(robot: Robot) {
    this.links = robot.links.map((link) => {
      const group = new Group();
      group.name = link.name;
      this.group.add(group);
      return group;
    });
  }

  add(answer: MeshAnswer): void {
    if (answer.triangles.length === 0) return;
    this.links[answer.index]?.add(new Mesh(meshGeometry(answer.vertices, answer.triangles), this.material));
  }

  /** @param poses of all links in W, shape (links,7) */
  move(poses: Float32Array): void {
    this.links.forEach((link, n) => {
      const at = 7 * n;
      if (at + 7 > poses.length) return;
      link.position.set(poses[at]!, poses[at + 1]!, poses[at + 2]!);
      link.quaternion.set(poses[at + 3]!, poses[at + 4]!, poses[at + 5]!, poses[at + 6]!);
    });
  }

  setColour(colour: string): void {
    this.material.setColour(colour);
  }

  dispose(): void {
    this.group.removeFromParent();
    this.group.traverse((node) => {
      if (node instanceof Mesh) node.geometry.dispose();
    });
    this.material.dispose();
  }
}
