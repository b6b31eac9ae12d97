// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Leading the tool with the mouse: the ring is taken, and what follows moves in the plane that faces
// the camera, along one axis while its key is down, or in depth with the wheel. The pointer that
// counts is the heavy one; the real one is not seen meanwhile.
import { Plane, Raycaster, Vector2, Vector3 } from "three";
import type { Stage } from "../view/stage";
import type { ToolHandle } from "../view/tool_handle";
import { HeavyPointer, mobility } from "./heavy_pointer";
import type { Leader } from "./leader";

export class MouseDrive {
  /** Drag at which the pointer goes half as far [N]. */
  halfAt = 2;
  private pointer: HeavyPointer | null = null;
  private last = { x: 0, y: 0 };
  private readonly plane = new Plane();
  private readonly from = new Vector3();
  private readonly grab = new Vector3();
  private readonly ray = new Raycaster();

  /** @param felt the drag against the hand now [N]; @param axisHeld 0, 1, 2 while X, Y, Z is down */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly stage: Stage,
    private readonly handle: ToolHandle,
    private readonly leader: Leader,
    private readonly felt: () => number,
    private readonly axisHeld: () => number | null,
  ) {
    // Before the orbit controls hear of it.
    canvas.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"] as const) {
      canvas.addEventListener(name, () => this.up());
    }
    canvas.addEventListener("wheel", (event) => this.wheel(event), { capture: true, passive: false });
  }

  get isDragging(): boolean {
    return this.pointer !== null;
  }

  private aim(x: number, y: number): Raycaster {
    const at = this.stage.pointerAt({ clientX: x, clientY: y });
    this.ray.setFromCamera(new Vector2(at.x, at.y), this.stage.camera);
    return this.ray;
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0 || event.shiftKey) return;
    if (!this.handle.group.visible || !this.handle.isUnder(this.aim(event.clientX, event.clientY))) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    this.canvas.focus();
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.style.cursor = "none";
    this.stage.orbit.enabled = false;
    this.pointer = new HeavyPointer(event.clientX, event.clientY);
    this.last = { x: event.clientX, y: event.clientY };
    this.leader.begin();
    this.handle.take(true);
    this.from.copy(this.leader.place);
    this.plane.setFromNormalAndCoplanarPoint(this.stage.camera.getWorldDirection(new Vector3()), this.from);
    this.grab.copy(this.meet() ?? this.from);
  }

  private move(event: PointerEvent): void {
    if (!this.pointer) {
      const over = this.handle.group.visible && this.handle.isUnder(this.aim(event.clientX, event.clientY));
      this.canvas.style.cursor = over ? "grab" : "";
      return;
    }
    const share = mobility(this.felt(), this.halfAt);
    this.pointer.move(event.clientX - this.last.x, event.clientY - this.last.y, share);
    this.last = { x: event.clientX, y: event.clientY };
    this.lead();
  }

  private lead(): void {
    const met = this.meet();
    if (!met) return;
    const step = met.sub(this.grab);
    const axis = this.axisHeld();
    if (axis !== null) step.fromArray([0, 1, 2].map((n) => (n === axis ? step.getComponent(n) : 0)));
    this.leader.moveTo(this.from.clone().add(step));
  }

  private meet(): Vector3 | null {
    if (!this.pointer) return null;
    return this.aim(this.pointer.x, this.pointer.y).ray.intersectPlane(this.plane, new Vector3());
  }

  private wheel(event: WheelEvent): void {
    if (!this.pointer) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    const share = mobility(this.felt(), this.halfAt);
    const step = this.plane.normal.clone().multiplyScalar(-0.0002 * event.deltaY * share);
    this.from.add(step);
    this.grab.add(step);
    this.plane.translate(step);
    this.lead();
  }

  private up(): void {
    if (!this.pointer) return;
    this.pointer = null;
    this.canvas.style.cursor = "";
    this.stage.orbit.enabled = true;
    this.handle.take(false);
    this.leader.end();
  }
}
