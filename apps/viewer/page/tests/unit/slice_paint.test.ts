// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

import { expect, test } from "vitest";
import { rankColour } from "../../src/colour/rank_palette";
import type { VoxelRecord } from "../../src/protocol/hello";
import { largestViscosity, paintSlice, sliceColours } from "../../src/view/slice_paint";

const records: VoxelRecord[] = [
  { kind: "empty", rank: 0, object: 0 },
  { kind: "boundary", rank: 0, object: 0 },
  { kind: "inner", rank: 0, object: 0 },
  { kind: "neighbour", rank: 1, object: 0 },
  { kind: "neighbour", rank: 2, object: 1 },
];
const viscosity = [0, 100, 100, 32, 16];

function pixel(colours: Uint32Array, code: number): number[] {
  return [...paintSlice(new Uint8Array([code]), 1, colours, records)];
}

test("a rank has the colour of its rank, opaque; empty space is clear", () => {
  const colours = sliceColours(records, viscosity, 2, "rank", () => false);
  const bytes = rankColour(2, 2).map((x) => Math.round(255 * x));
  expect(pixel(colours, 4)).toEqual([...bytes, 255]);
  expect(pixel(colours, 0)).toEqual([0, 0, 0, 0]);
});

test("by viscosity, half of the largest layer's is half way to pale, whatever the skin", () => {
  expect(largestViscosity(records, viscosity)).toBe(32);
  const colours = sliceColours(records, viscosity, 2, "viscosity", () => false);
  const bytes = rankColour(2, 3).map((x) => Math.round(255 * x));
  expect(pixel(colours, 4)).toEqual([...bytes, 255]);
});

test("a hidden object's voxels are clear, its inner ones too", () => {
  const colours = sliceColours(records, viscosity, 2, "rank", (object) => object === 0);
  for (const code of [1, 2, 3]) expect(pixel(colours, code)).toEqual([0, 0, 0, 0]);
  expect(pixel(colours, 4)[3]).toBe(255);
});

test("a code that no record has is clear", () => {
  const colours = sliceColours(records, viscosity, 2, "rank", () => false);
  expect(pixel(colours, 200)).toEqual([0, 0, 0, 0]);
});

test("inner voxels are hatched across rows", () => {
  const colours = sliceColours(records, viscosity, 2, "rank", () => false);
  const pixels = paintSlice(new Uint8Array(64).fill(2), 8, colours, records);
  const reds = Array.from({ length: 64 }, (_, n) => pixels[4 * n]);
  expect(new Set(reds).size).toBe(2);
  expect(reds[0]).toBe(reds[8 * 1 + 7]); // along the diagonal
});
