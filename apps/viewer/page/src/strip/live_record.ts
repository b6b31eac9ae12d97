// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// What the strip chart shows of each snapshot.
import { statuses, type Snapshot } from "../protocol/snapshot";
import { RollingRecord } from "./rolling_record";

export interface Quantity {
  name: string;
  unit: string;
  title: string;
  digits: number;
  /** What the axis shows at least, so that nothing looks like something only where it is. */
  least: number;
}

export const quantities: readonly Quantity[] = [
  { name: "force", unit: "N", title: "Norm of all drag at the tool", digits: 3, least: 0.1 },
  { name: "viscosity", unit: "N·s/m³", title: "Highest effective viscosity of any body point", digits: 1, least: 10 },
  { name: "speed", unit: "m/s", title: "Speed of the tool", digits: 3, least: 0.05 },
  { name: "energy", unit: "J", title: "Energy that the drag has taken out", digits: 3, least: 0.01 },
  { name: "tick time", unit: "µs", title: "99th percentile over the last second", digits: 1, least: 20 },
];

/** In the order of `quantities`; the last entry of the record is the status. */
export function valuesOf(snapshot: Snapshot): number[] {
  return [
    Math.hypot(...snapshot.force),
    snapshot.highestViscosity,
    Math.hypot(...snapshot.toolVelocity),
    snapshot.energy,
    snapshot.tickP99,
    snapshot.status,
  ];
}

export function liveRecord(seconds: number): RollingRecord {
  return new RollingRecord(quantities.length + 1, seconds);
}

export type StatusClass = "good" | "warn" | "bad";

/** From `deadline missed` on, the force of a tick is zero. */
export function statusClass(status: number): StatusClass {
  return status === 0 ? "good" : status < statuses.indexOf("deadline missed") ? "warn" : "bad";
}

export function statusText(status: number): string {
  return statuses[status] ?? `status ${status}`;
}
