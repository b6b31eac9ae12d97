// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Clicks on the view: what is this voxel, or how far is it from here to there.
import { Vector3 } from "three";
import { element } from "../dom/element";
import { PickCard, readPicked } from "../panel/pick_card";
import { pickCommand } from "../protocol/command";
import type { Vec3 } from "../protocol/hello";
import type { Session } from "../protocol/session";
import { lengthText } from "../text/units";
import { MeasureLine } from "../view/measure_line";
import type { Stage } from "../view/stage";
import { surfaceUnder } from "../view/surface_hit";
import type { Workplace } from "../view/workplace";

const stillness = 4; // [px] a click may wander

export class Picking {
  readonly card = new PickCard(() => this.mark.clear());
  readonly label = element("output", { class: "measure-label", "data-reading": "measured" });
  readonly line = new MeasureLine();
  private readonly mark = new MeasureLine(); // of one point: a dot
  private measures = false;
  private down = { x: 0, y: 0 };

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly stage: Stage,
    private readonly session: Session,
    private readonly workplace: () => Workplace | null,
    private readonly isBusy: () => boolean,
    private readonly onObject: (object: number | null) => void,
  ) {
    this.label.hidden = true;
    stage.scene.add(this.line.group, this.mark.group);
    stage.onFrame(() => this.placeLabel());
    canvas.addEventListener("pointerdown", ({ clientX, clientY }) => (this.down = { x: clientX, y: clientY }), { capture: true });
    canvas.addEventListener("pointerup", (event) => {
      const way = Math.hypot(event.clientX - this.down.x, event.clientY - this.down.y);
      if (event.button === 0 && way <= stillness && !this.isBusy()) this.click(event);
    }, { capture: true });
  }

  get isMeasuring(): boolean {
    return this.measures;
  }

  measure(measures: boolean): void {
    this.measures = measures;
    this.canvas.classList.toggle("measuring", measures);
    if (!measures) this.line.clear();
    this.stage.draw();
  }

  setColour(colour: string): void {
    this.line.setColour(colour);
    this.mark.setColour(colour);
  }

  close(): void {
    this.card.hide();
    this.mark.clear();
    this.stage.draw();
  }

  /** Asks what is at a point. */
  async ask(point: Vector3): Promise<void> {
    const picked = readPicked(await this.session.connection.ask(pickCommand(point.toArray() as Vec3)));
    this.card.show(picked);
  }

  private click(event: PointerEvent): void {
    const workplace = this.workplace();
    if (!workplace) return;
    const hit = surfaceUnder(this.stage.pointerAt(event), this.stage, workplace);
    if (this.measures) {
      if (hit) this.line.add(hit.point);
    } else if (hit) {
      this.mark.clear();
      this.mark.add(hit.point);
      this.onObject(hit.object);
      this.ask(hit.point).catch((error: unknown) => this.session.fail(error));
    } else {
      this.onObject(null);
      this.close();
    }
    this.stage.draw();
  }

  private placeLabel(): void {
    const span = this.line.span;
    const middle = this.line.middle(this.stage.camera);
    this.label.hidden = !middle;
    if (!middle || !span) return;
    const parts = span.to.clone().sub(span.from).toArray().map((x) => lengthText(Math.abs(x)));
    this.label.textContent = lengthText(span.length);
    this.label.title = `along x ${parts[0]}, y ${parts[1]}, z ${parts[2]}`;
    this.label.style.left = `${50 * (1 + middle.x)}%`;
    this.label.style.top = `${50 * (1 - middle.y)}%`;
  }
}
