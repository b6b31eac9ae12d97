// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A recording at one moment: poses between its frames, and what held then.
import type { Recording, RecordedReason } from "../protocol/recording";

/** Index of the last entry that is not after `time`; 0 where all are. Times rise. */
export function indexAt(times: ArrayLike<number>, time: number): number {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle]! <= time) low = middle + 1;
    else high = middle;
  }
  return Math.max(0, low - 1);
}

/**
 * Poses of all links at a time: straight between two frames, rotations along the shorter arc.
 * @param out shape (links,7)
 */
export function posesAt(recording: Recording, time: number, out: Float32Array): void {
  const { frames, poses, links } = recording;
  if (frames.length === 0) return;
  const before = indexAt(frames, time);
  const after = Math.min(before + 1, frames.length - 1);
  const span = frames[after]! - frames[before]!;
  const share = span > 0 ? Math.min(1, Math.max(0, (time - frames[before]!) / span)) : 0;
  for (let link = 0; link < links; ++link) {
    const a = 7 * (links * before + link);
    const b = 7 * (links * after + link);
    const same = [3, 4, 5, 6].reduce((sum, n) => sum + poses[a + n]! * poses[b + n]!, 0) >= 0 ? 1 : -1;
    for (let n = 0; n < 7; ++n) {
      const end = poses[b + n]! * (n >= 3 ? same : 1);
      out[7 * link + n] = poses[a + n]! + share * (end - poses[a + n]!);
    }
    const norm = Math.hypot(out[7 * link + 3]!, out[7 * link + 4]!, out[7 * link + 5]!, out[7 * link + 6]!);
    for (let n = 3; n < 7 && norm > 0; ++n) out[7 * link + n]! /= norm;
  }
}

/** What was last said at or before a row. */
function lastAt<Entry extends { row: number }>(entries: readonly Entry[], row: number): Entry | null {
  const rows = entries.map((entry) => entry.row);
  const at = indexAt(rows, row);
  const entry = entries[at];
  return entry && entry.row <= row ? entry : null;
}

export function statusAt(recording: Recording, row: number): string {
  return lastAt(recording.statuses, row)?.status ?? "";
}

export function reasonAt(recording: Recording, row: number): RecordedReason | null {
  return lastAt(recording.reasons, row)?.reason ?? null;
}
