// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The reason line: which point feels what, how near it is, and how soon it would touch.
import { voxelKinds, type Field, type Robot } from "../protocol/hello";
import type { Reason } from "../protocol/snapshot";
import type { RecordedReason } from "../protocol/recording";
import { lengthText, secondsText } from "./units";

/** "link 5 → vessel, rank 2, 31 mm, 0.4 s to contact"; null where nothing is felt. */
export function reasonLine(reason: Reason, field: Field, robot: Robot): string | null {
  if (reason.point < 0) return null;
  const link = robot.links[reason.link]?.name ?? "arm";
  const object = field.objects[reason.object];
  if (reason.object < 0 || !object) return `${link}: only remembered, the point has left`;
  const parts = [`${link} → ${object.name}`];
  const kind = voxelKinds[reason.kind];
  if (kind === "boundary" || kind === "inner") parts.push(kind === "inner" ? "inside" : "at its surface");
  else {
    parts.push(`rank ${reason.rank}`, `at least ${lengthText(reason.distance)}`);
    if (reason.timeToContact > 0) parts.push(`${secondsText(reason.timeToContact)} to contact`);
  }
  return parts.join(", ");
}

export function recordedReasonLine(reason: RecordedReason | null): string | null {
  if (!reason) return null;
  const head = reason.object ? `${reason.link} → ${reason.object}` : reason.link;
  const rank = reason.rank > 0 ? [`rank ${reason.rank}`] : [];
  const distance = Number.isFinite(reason.distanceMm)
    ? [`at least ${lengthText(reason.distanceMm / 1000)}`]
    : [];
  return [head, ...rank, ...distance].join(", ");
}
