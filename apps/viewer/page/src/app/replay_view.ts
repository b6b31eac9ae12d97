// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Recordings in the view: one arm each, side by side where there are two.
import { Player, type Slot } from "../play/player";
import { indexAt, posesAt, reasonAt } from "../play/moment";
import { recordedColumns } from "../play/recorded_columns";
import { jsonCommand } from "../protocol/command";
import { toServer } from "../protocol/message";
import { readRecording } from "../protocol/recording";
import type { Session } from "../protocol/session";
import type { Columns } from "../strip/rolling_record";
import { recordedReasonLine } from "../text/reason";
import { Arm } from "../view/arm";
import { looks, type Theme } from "../view/look";
import type { Stage } from "../view/stage";
import type { Workplace } from "../view/workplace";

export class ReplayView {
  readonly player: Player;
  private readonly arms: [Arm | null, Arm | null] = [null, null];
  private columns: [Columns | null, Columns | null] = [null, null];
  private workplace: Workplace | null = null;
  private theme: Theme = "dark";

  constructor(
    private readonly session: Session,
    private readonly stage: Stage,
    private readonly onChange: () => void,
  ) {
    this.player = new Player(() => {
      this.pose();
      this.onChange();
    });
  }

  setWorkplace(workplace: Workplace): void {
    this.workplace = workplace;
    for (const slot of [0, 1] as const) this.makeArm(slot);
    this.show();
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    for (const arm of this.arms) arm?.setColour(looks[theme].arm);
  }

  async open(slot: Slot, name: string): Promise<void> {
    const message = await this.session.connection.ask(jsonCommand(toServer.openRecording, { name }));
    const recording = readRecording(message);
    const toolLink = this.session.hello?.robot.toolLink ?? -1;
    this.columns[slot] = recordedColumns(recording, toolLink);
    this.player.slots[slot] = recording;
    this.makeArm(slot);
    this.show();
    this.player.put(slot, recording);
  }

  close(slot: Slot): void {
    this.arms[slot]?.dispose();
    this.arms[slot] = null;
    this.columns[slot] = null;
    this.player.put(slot, null);
    this.show();
  }

  follow(): void {
    const recording = this.player.slots[0] ?? this.player.slots[1];
    if (!recording) return;
    const { time, speed, loop } = this.player;
    this.session.run(
      jsonCommand(toServer.follow, { recording: recording.number, time, speed, loop, playing: true }),
    );
  }

  /** Whether the live arm gives way to recorded ones. */
  get hidesLiveArm(): boolean {
    return this.arms.some((arm) => arm !== null);
  }

  /** Charts of what is open: the first one, and the second over it. */
  get charts(): { own: Columns; other: Columns | null } | null {
    const [left, right] = this.columns;
    if (left) return { own: left, other: right };
    return right ? { own: right, other: null } : null;
  }

  /** What was felt most in the first recording at this moment; null: nothing. */
  get reasonLine(): string | null {
    const recording = this.player.slots[0] ?? this.player.slots[1];
    if (!recording) return null;
    return recordedReasonLine(reasonAt(recording, indexAt(recording.t, this.player.time)));
  }

  private makeArm(slot: Slot): void {
    this.arms[slot]?.dispose();
    this.arms[slot] = null;
    const { workplace } = this;
    const recording = this.player.slots[slot];
    if (!workplace || !recording || recording.frames.length === 0) return;
    const arm = new Arm(workplace.hello.robot);
    arm.setColour(looks[this.theme].arm);
    workplace.root.add(arm.group);
    this.arms[slot] = arm;
    workplace.meshesOfLinks(arm).then(
      () => this.stage.draw(),
      (error: unknown) => this.session.fail(error),
    );
  }

  private show(): void {
    const both = this.arms[0] !== null && this.arms[1] !== null;
    this.workplace?.hideArm(this.hidesLiveArm);
    this.stage.setHalves(
      both
        ? (half) => this.arms.forEach((arm, slot) => arm && (arm.group.visible = slot === half))
        : null,
    );
    if (!both) for (const arm of this.arms) if (arm) arm.group.visible = true;
    this.pose();
  }

  private pose(): void {
    this.arms.forEach((arm, slot) => {
      const recording = this.player.slots[slot];
      if (!arm || !recording) return;
      const poses = new Float32Array(7 * recording.links);
      posesAt(recording, this.player.time, poses);
      arm.move(poses);
    });
    this.stage.draw();
  }
}
