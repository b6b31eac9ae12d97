// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Objects of the scene that is being edited, where they are to stand, before anything is built; and
// the gizmo that moves the chosen one.
import {
  BufferGeometry,
  Color,
  DoubleSide,
  Group,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  Quaternion,
  Vector3,
} from "three";
import { TransformControls } from "three/addons/controls/TransformControls.js";
import type { Placement } from "../scene/draft";
import type { Stage } from "./stage";

export function matrixOf({ xyz, quaternion, scale }: Placement, metres = 1): Matrix4 {
  const size = new Vector3().setScalar(scale * metres);
  return new Matrix4().compose(new Vector3(...xyz), new Quaternion(...quaternion), size);
}

export class DraftPreview {
  readonly group = new Group();
  private readonly gizmo: TransformControls;
  private readonly material = new MeshLambertMaterial({ side: DoubleSide, transparent: true, opacity: 0.75 });
  private readonly frame = new Group(); // what the gizmo moves: the pose, without unit and scale
  private readonly meshes = new Map<object, Mesh>();
  private readonly helper;

  /** @param onMove the gizmo has moved the chosen object */
  constructor(
    private readonly stage: Stage,
    canvas: HTMLCanvasElement,
    onMove: (xyz: Vector3, turn: Quaternion) => void,
  ) {
    this.gizmo = new TransformControls(stage.camera, canvas);
    this.gizmo.setSize(0.8);
    this.gizmo.addEventListener("change", () => stage.draw());
    this.gizmo.addEventListener("dragging-changed", ({ value }) => (stage.orbit.enabled = !value));
    this.gizmo.addEventListener("objectChange", () => onMove(this.frame.position, this.frame.quaternion));
    this.helper = this.gizmo.getHelper();
    this.group.add(this.frame, this.helper);
    this.helper.visible = false;
  }

  get isDragging(): boolean {
    return this.gizmo.dragging;
  }

  setColour(colour: string): void {
    this.material.color = new Color(colour);
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
      this.gizmo.detach();
      this.helper.visible = false;
    } else {
      this.frame.position.set(...placement.xyz);
      this.frame.quaternion.set(...placement.quaternion);
      this.gizmo.setMode(mode);
      this.gizmo.attach(this.frame);
      this.helper.visible = true;
    }
    this.stage.draw();
  }
}
