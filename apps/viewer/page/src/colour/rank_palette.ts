// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Colours of voxels: the nearer to a surface, the darker. The same as in the command line's
// pictures (apps/cli/picture/rank_palette.cpp), so that a page and a figure read alike.

/** sRGB, 0..1 each. */
export type Colour = readonly [red: number, green: number, blue: number];

export const boundaryColour: Colour = [0.08, 0.08, 0.09];
export const innerColour: Colour = [0.72, 0.72, 0.73];
export const innerHatchColour: Colour = [0.55, 0.55, 0.57];

/** sRGB of a colour in OKLab's polar form (B. Ottosson, 2020). */
function fromOklch(lightness: number, chroma: number, hueDegrees: number): Colour {
  const hue = (hueDegrees * Math.PI) / 180;
  const a = chroma * Math.cos(hue);
  const b = chroma * Math.sin(hue);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const encode = (linear: number): number => {
    const x = Math.min(Math.max(linear, 0), 1);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
  };
  return [
    encode(+4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
    encode(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
    encode(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s),
  ];
}

/**
 * From deep red-violet (0, at the surface) to pale yellow (1, far). Lightness rises in equal steps,
 * as the eye sees them, so that a colour-blind person can tell neighbours apart.
 */
export function nearnessColour(far: number): Colour {
  const t = Math.min(Math.max(far, 0), 1);
  // The hue takes the short way round through red and orange; chroma stays within sRGB.
  return fromOklch(0.45 + 0.5 * t, 0.17 - 0.09 * t * t, -15 + 120 * t);
}

/** Colour of rank n of q, 1 <= n <= q. */
export function rankColour(n: number, q: number): Colour {
  return nearnessColour(q > 1 ? (n - 1) / (q - 1) : 0);
}

/** Colour of an effective viscosity beside the largest one of the field: heavy is dark. */
export function viscosityColour(mu: number, largest: number): Colour {
  return nearnessColour(largest > 0 ? 1 - mu / largest : 1);
}

/** "#rrggbb" for style sheets. */
export function cssColour(colour: Colour): string {
  const byte = (x: number): string =>
    Math.round(255 * x)
      .toString(16)
      .padStart(2, "0");
  return `#${colour.map(byte).join("")}`;
}
