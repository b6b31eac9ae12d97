// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The hand that leads the tool: one target for mouse, keys and gamepad, sent once a frame.
import { Quaternion, Vector3 } from "three";
import { toolCommand } from "../protocol/command";
import type { Vec3 } from "../protocol/hello";
import type { Session } from "../protocol/session";
import { limitLead } from "./lead";

export class Leader {
  private target = new Vector3();
  private turn: Quaternion | null = null; // null: the orientation is kept
  private leading = false;
  private wanted = false;

  /** @param mostAhead how far the target may be ahead of the tool [m] */
  constructor(
    private readonly session: Session,
    public mostAhead: number,
  ) {}

  get isLeading(): boolean {
    return this.leading;
  }
  get place(): Vector3 {
    return this.target.clone();
  }

  /** Takes hold of the tool where it is. */
  begin(): void {
    const tool = this.session.snapshot?.tool;
    if (this.leading || !tool) return;
    this.leading = true;
    this.turn = null;
    this.target.set(tool[0]!, tool[1]!, tool[2]!);
  }

  moveTo(target: Vector3): void {
    const tool = this.session.snapshot?.tool;
    if (!this.leading || !tool) return;
    const place: Vec3 = [tool[0]!, tool[1]!, tool[2]!];
    this.target.set(...limitLead(target.toArray() as Vec3, place, this.mostAhead));
    this.send();
  }

  /** Turns the target about axes of the tool [rad]. */
  rotate(by: Vector3): void {
    const tool = this.session.snapshot?.tool;
    if (!this.leading || !tool || by.lengthSq() === 0) return;
    this.turn ??= new Quaternion(tool[3], tool[4], tool[5], tool[6]);
    const angle = by.length();
    this.turn.multiply(new Quaternion().setFromAxisAngle(by.clone().divideScalar(angle), angle)).normalize();
    this.send();
  }

  /** Lets go: the tool stops at the target, or where it is when drag keeps it from there. */
  end(): void {
    this.leading = false;
  }

  private send(): void {
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      if (!this.leading) return;
      const turn = this.turn ?? new Quaternion();
      const pose = [...this.target.toArray(), turn.x, turn.y, turn.z, turn.w];
      this.session.connection.send(toolCommand(pose, this.turn === null));
    });
  }
}
