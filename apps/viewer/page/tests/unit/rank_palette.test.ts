// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

import { expect, test } from "vitest";
import { cssColour, rankColour, viscosityColour, type Colour } from "../../src/colour/rank_palette";

function relativeLuminance([r, g, b]: Colour): number {
  const linear = (x: number): number => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
  return 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
}

// Dichromats as H. Brettel, F. Viénot and J. Mollon put them, in linear RGB (Viénot 1999).
function seenBy(kind: "protanope" | "deuteranope", colour: Colour): Colour {
  const linear = colour.map((x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4));
  const [r, g, b] = linear as [number, number, number];
  return kind === "protanope"
    ? [0.112 * r + 0.888 * g, 0.112 * r + 0.888 * g, 0.004 * r - 0.004 * g + b]
    : [0.293 * r + 0.707 * g, 0.293 * r + 0.707 * g, -0.022 * r + 0.022 * g + b];
}

test.each([2, 3, 6, 8, 12])("of %d ranks each is lighter than the one before", (q) => {
  for (let n = 2; n <= q; ++n) {
    const before = relativeLuminance(rankColour(n - 1, q));
    expect(relativeLuminance(rankColour(n, q))).toBeGreaterThan(before);
  }
});

test.each(["protanope", "deuteranope"] as const)("six ranks stay apart for a %s", (kind) => {
  for (let n = 2; n <= 6; ++n) {
    const [a, b] = [seenBy(kind, rankColour(n - 1, 6)), seenBy(kind, rankColour(n, 6))];
    const apart = Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    expect(apart).toBeGreaterThan(0.05);
    expect(b[0] + b[1]).toBeGreaterThan(a[0] + a[1]);
  }
});

// Pixels of a picture that `vicinity slice` drew: its legend's six swatches, as its drawing library
// rounds them.
const drawn = ["#911b6a", "#bd3b5d", "#de654d", "#ef964e", "#f4c675", "#f6f3b4"];

test("the page's colours are those of the command line's pictures", () => {
  const bytes = (css: string): number[] => [1, 3, 5].map((n) => parseInt(css.slice(n, n + 2), 16));
  drawn.forEach((css, n) => {
    const own = bytes(cssColour(rankColour(n + 1, 6)));
    bytes(css).forEach((byte, channel) => expect(Math.abs(byte - own[channel]!)).toBeLessThanOrEqual(1));
  });
});

test("the largest viscosity has the colour of rank 1, none that of the last rank", () => {
  expect(viscosityColour(32, 32)).toEqual(rankColour(1, 6));
  expect(viscosityColour(0, 32)).toEqual(rankColour(6, 6));
  expect(viscosityColour(100, 32)).toEqual(rankColour(1, 6));
});
