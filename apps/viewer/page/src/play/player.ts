// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The clock of recordings: one time for one recording or for two side by side.
import type { Recording } from "../protocol/recording";

export type Slot = 0 | 1;

export class Player {
  readonly slots: [Recording | null, Recording | null] = [null, null];
  time = 0;
  speed = 1;
  loop = true;
  playing = false;

  constructor(private readonly onChange: () => void) {}

  get isOpen(): boolean {
    return this.slots[0] !== null || this.slots[1] !== null;
  }

  /** Of the longer one [s]. */
  get duration(): number {
    return Math.max(0, ...this.slots.map((recording) => recording?.duration ?? 0));
  }

  put(slot: Slot, recording: Recording | null): void {
    this.slots[slot] = recording;
    if (!this.isOpen) this.playing = false;
    this.seek(Math.min(this.time, this.duration));
  }

  play(playing: boolean): void {
    this.playing = playing && this.isOpen;
    if (this.playing && this.time >= this.duration) this.time = 0;
    this.onChange();
  }

  seek(time: number): void {
    this.time = Math.min(this.duration, Math.max(0, time));
    this.onChange();
  }

  /** Once a frame. @param seconds since the last one */
  step(seconds: number): void {
    if (!this.playing) return;
    let time = this.time + seconds * this.speed;
    if (time >= this.duration) {
      if (this.loop && this.duration > 0) time %= this.duration;
      else this.playing = false;
    }
    this.seek(time);
  }
}
