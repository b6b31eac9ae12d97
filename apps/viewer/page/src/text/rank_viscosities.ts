// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The viscosity that each rank has now: one number, or the range where objects differ.
import type { Field } from "../protocol/hello";
import { plainNumber } from "./units";

/** Of rank 1, 2, ... @param viscosity by voxel code; a rank that no voxel has reads as "–" */
export function rankViscosities(field: Field, viscosity: readonly number[]): string[] {
  return Array.from({ length: field.ranks }, (_, n) => {
    const values = field.records.flatMap(({ kind, rank }, code) => {
      const mu = viscosity[code];
      return kind === "neighbour" && rank === n + 1 && mu !== undefined ? [mu] : [];
    });
    if (values.length === 0) return "–";
    const [low, high] = [Math.min(...values), Math.max(...values)];
    return low === high ? plainNumber(low) : `${plainNumber(low)} – ${plainNumber(high)}`;
  });
}
