// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A slice's codes as pixels.
import {
  boundaryColour,
  innerColour,
  innerHatchColour,
  rankColour,
  viscosityColour,
  type Colour,
} from "../colour/rank_palette";
import type { VoxelRecord } from "../protocol/hello";

export type SliceColouring = "rank" | "viscosity";

// A red-green-blue-alpha word as a little-endian machine keeps it.
function word([r, g, b]: Colour, alpha: number): number {
  const byte = (x: number): number => Math.round(255 * Math.min(1, Math.max(0, x)));
  return (byte(r) | (byte(g) << 8) | (byte(b) << 16) | (byte(alpha) << 24)) >>> 0;
}

/** What each code is painted with; what is hidden or empty is clear. */
export function sliceColours(
  records: readonly VoxelRecord[],
  viscosity: readonly number[],
  ranks: number,
  colouring: SliceColouring,
  isHidden: (object: number) => boolean,
): Uint32Array {
  const largest = largestViscosity(records, viscosity);
  return Uint32Array.from(records, ({ kind, rank, object }, code) => {
    if (kind === "empty" || isHidden(object)) return 0;
    if (kind === "inner") return word(innerColour, 1);
    if (kind === "boundary") return word(boundaryColour, 1);
    const mu = viscosity[code] ?? 0;
    return word(colouring === "rank" ? rankColour(rank, ranks) : viscosityColour(mu, largest), 1);
  });
}

/** The largest viscosity of any layer: the dark end of the scale. Skins are not felt as layers. */
export function largestViscosity(
  records: readonly VoxelRecord[],
  viscosity: readonly number[],
): number {
  return records.reduce(
    (largest, { kind }, code) =>
      kind === "neighbour" ? Math.max(largest, viscosity[code] ?? 0) : largest,
    0,
  );
}

/**
 * Pixels of a slice, shape (height, width, 4). Inner voxels are hatched, so that they are not taken
 * for a layer in grey print. A code that no record has stays clear.
 */
export function paintSlice(
  codes: Uint8Array | Uint16Array,
  width: number,
  colours: Uint32Array,
  records: readonly VoxelRecord[],
): Uint8Array<ArrayBuffer> {
  const pixels = new Uint32Array(codes.length);
  const hatch = word(innerHatchColour, 1);
  const hatched = Uint8Array.from(records, ({ kind }) => (kind === "inner" ? 1 : 0));
  for (let n = 0; n < codes.length; ++n) {
    const code = codes[n]!;
    const colour = colours[code] ?? 0;
    const stripe = hatched[code] && colour && ((n % width) + Math.floor(n / width)) % 8 < 2;
    pixels[n] = stripe ? hatch : colour;
  }
  return new Uint8Array(pixels.buffer);
}
