// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Objects of the scene that is being edited, where they are to stand, before anything is built; and
// the gizmo that moves the chosen one.
import {
  BufferGeometry,
  Group,
  Matrix4,
  Mesh,
  Quaternion,
  Vector3,
} from "three";
import { TransformControls } from "three/addons/controls/TransformControls.js";
import type { Placement } from "../scene/draft";
import { litMaterial } from "./material";
import type { Stage } from "./stage";

export function matrixOf({ xyz, quaternion, scale }: Placement, metres = 1): Matrix4 {
  const size = new Vector3().setScalar(scale * metres);
  return new Matrix4().compose(new Vector3(...xyz), new Quaternion(...quaternion), size);
}

export class DraftPreview {
  readonly group = new Group();
  private gizmo: TransformControls | null = null; // made when it is first needed: it has many parts
  private readonly material = litMaterial({ opacity: 0.75 });
  private readonly frame = new Group(); // what the gizmo moves: the pose, without unit and scale
  private readonly meshes = new Map<object, Mesh>();

  /** @param onMove the gizmo has moved the chosen object */
  constructor(
    private readonly stage: Stage,
    private readonly canvas: HTMLCanvasElement,
    private readonly onMove: (xyz: Vector3, turn: Quaternion) => void,
  ) {
    this.group.add(this.frame);
  }

  get isDragging(): boolean {
    return this.gizmo?.dragging ?? false;
  }

  setColour(colour: string): void {
    this.material.setColour(colour);
  }

  /** Shows an object at a place. @param geometry in `metres` per unit */
  show(key: object, geometry: BufferGeometry, placement: Placement, metres: number): void {
    const mesh = this.meshes.get(key) ?? new Mesh(geometry, this.material);
    mesh.geometry = geometry;
    mesh.matrixAutoUpdate = false;
    mesh.matrix.copy(matrixOf(placement, metres));
    this.meshes.set(key, mesh);
    this.group.add(mesh);
    this.stage.draw();
  }

  remove(key: object): void {
    this.meshes.get(key)?.removeFromParent();
    this.meshes.delete(key);
    this.stage.draw();
  }

  clear(): void {
    for (const key of [...this.meshes.keys()]) this.remove(key);
    this.hold(null);
  }

  meshOf(key: object): Mesh | undefined {
    return this.meshes.get(key);
  }

  /** Puts the gizmo on a pose, or away. */
  hold(placement: Placement | null, mode: "translate" | "rotate" = "translate"): void {
    if (!placement) {
      this.gizmo?.detach(); // which hides it
    } else {
      this.frame.position.set(...placement.xyz);
      this.frame.quaternion.set(...placement.quaternion);
      this.gizmo ??= this.makeGizmo();
      this.gizmo.setMode(mode);
      this.gizmo.attach(this.frame);
    }
    this.stage.draw();
  }

  private makeGizmo(): TransformControls {
    const { stage } = this;
    const gizmo = new TransformControls(stage.camera, this.canvas);
    gizmo.setSize(0.8);
    gizmo.addEventListener("change", () => stage.draw());
    gizmo.addEventListener("dragging-changed", ({ value }) => (stage.orbit.enabled = !value));
    gizmo.addEventListener("objectChange", () => this.onMove(this.frame.position, this.frame.quaternion));
    this.group.add(gizmo.getHelper());
    return gizmo;
  }
}
