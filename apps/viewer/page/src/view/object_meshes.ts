// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The things in the workplace, as their meshes show them.
import {
  Box3,
  Group,
  LineSegments,
  Mesh,
  type Raycaster,
} from "three";
import type { MeshAnswer } from "../protocol/shapes";
import { edgesOf, meshGeometry } from "./mesh_geometry";
import type { Look } from "./look";
import { flatMaterial, litMaterial, type Cut, type PlainMaterial } from "./material";

export class ObjectMeshes {
  readonly group = new Group();
  private readonly meshes = new Map<number, Mesh>();
  private readonly surface: PlainMaterial;
  private readonly chosenSurface: PlainMaterial;
  private readonly line: PlainMaterial;

  constructor(cut: Cut) {
    this.surface = litMaterial({ cut });
    this.chosenSurface = litMaterial({ cut });
    this.line = flatMaterial({ opacity: 0.5, cut });
  }

  add(answer: MeshAnswer): void {
    const geometry = meshGeometry(answer.vertices, answer.triangles);
    const mesh = new Mesh(geometry, this.surface);
    const edges = edgesOf(geometry);
    if (edges) mesh.add(new LineSegments(edges, this.line));
    this.meshes.set(answer.index, mesh);
    this.group.add(mesh);
  }

  show(object: number, shown: boolean): void {
    const mesh = this.meshes.get(object);
    if (mesh) mesh.visible = shown;
  }

  choose(object: number | null): void {
    for (const [index, mesh] of this.meshes) {
      mesh.material = index === object ? this.chosenSurface : this.surface;
    }
  }

  /** The mesh of an object as it was sent, in W. */
  meshOf(object: number): Mesh | undefined {
    return this.meshes.get(object);
  }

  boxOf(object: number): Box3 | null {
    const mesh = this.meshes.get(object);
    return mesh ? new Box3().setFromObject(mesh) : null;
  }

  setLook(look: Look): void {
    this.surface.setColour(look.object);
    this.chosenSurface.setColour(look.accent);
    this.line.setColour(look.edge);
  }

  /** The nearest shown object on a ray for which `counts` holds. */
  hit(ray: Raycaster, counts: (at: number) => boolean): { at: number; object: number } | null {
    let best: { at: number; object: number } | null = null;
    for (const [object, mesh] of this.meshes) {
      if (!mesh.visible) continue;
      for (const { distance } of ray.intersectObject(mesh, false)) {
        if (!counts(distance)) continue;
        if (!best || distance < best.at) best = { at: distance, object };
        break; // they come nearest first
      }
    }
    return best;
  }

  dispose(): void {
    this.group.removeFromParent();
    for (const mesh of this.meshes.values()) {
      mesh.geometry.dispose();
      for (const child of mesh.children) (child as LineSegments).geometry.dispose();
    }
    for (const material of [this.surface, this.chosenSurface, this.line]) material.dispose();
  }
}
