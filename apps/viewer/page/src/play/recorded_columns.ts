// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A recording as the strip chart shows it, in the order of its quantities: force, viscosity, speed,
// energy, tick time, status. What a recording does not tell stays empty.
import type { Recording } from "../protocol/recording";
import { statuses } from "../protocol/snapshot";
import type { Columns } from "../strip/rolling_record";

/** Speed of a link between its frames, at the times of rows [m/s]. */
function speedOf(recording: Recording, link: number, times: readonly number[]): (number | null)[] {
  const { frames, poses, links } = recording;
  if (frames.length < 2 || link < 0 || link >= links) return times.map(() => null);
  const speed = (frame: number): number => {
    const [a, b] = [7 * (links * frame + link), 7 * (links * (frame + 1) + link)];
    const way = Math.hypot(poses[b]! - poses[a]!, poses[b + 1]! - poses[a + 1]!, poses[b + 2]! - poses[a + 2]!);
    const time = frames[frame + 1]! - frames[frame]!;
    return time > 0 ? way / time : 0;
  };
  let frame = 0;
  return times.map((time) => {
    while (frame + 2 < frames.length && frames[frame + 1]! <= time) frame += 1;
    return speed(frame);
  });
}

/** Energy that the torques have taken out of the joints so far: -sum tau dq [J]. */
function energyOf(recording: Recording): (number | null)[] {
  const joints = [...recording.columns.keys()].flatMap((name) => {
    const q = recording.columns.get(`q_${name.slice(4)}`);
    const tau = recording.columns.get(name);
    return name.startsWith("tau_") && q && tau ? [{ q, tau }] : [];
  });
  if (joints.length === 0) return Array.from(recording.t, () => null);
  let energy = 0;
  return Array.from(recording.t, (_, row) => {
    for (const { q, tau } of joints) {
      const step = row > 0 ? q[row]! - q[row - 1]! : 0;
      if (Number.isFinite(step * tau[row]!)) energy -= step * tau[row]!;
    }
    return energy;
  });
}

/** @param toolLink of the robot that was recorded */
export function recordedColumns(recording: Recording, toolLink: number): Columns {
  const times = Array.from(recording.t);
  const part = (name: string): Float64Array | undefined => recording.columns.get(name);
  const [fx, fy, fz] = [part("fx"), part("fy"), part("fz")];
  const force = times.map((_, row) => {
    const norm = Math.hypot(fx?.[row] ?? NaN, fy?.[row] ?? NaN, fz?.[row] ?? NaN);
    return Number.isFinite(norm) ? norm : null;
  });
  let at = 0;
  const status = times.map((_, row) => {
    while ((recording.statuses[at + 1]?.row ?? Infinity) <= row) at += 1;
    const index = statuses.findIndex((name) => name === recording.statuses[at]?.status);
    return index < 0 ? null : index;
  });
  const none = times.map(() => null);
  return [times, force, none, speedOf(recording, toolLink, times), energyOf(recording), none, status];
}
