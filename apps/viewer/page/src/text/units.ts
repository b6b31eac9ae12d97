// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Numbers as people read them: a fixed number of digits, so that a changing one does not jump.

/** Three significant digits, never exponents where a person reads: 0.00123 -> "0.00123". */
export function threeDigits(x: number): string {
  if (!Number.isFinite(x)) return "–";
  if (x === 0) return "0";
  const digits = Math.floor(Math.log10(Math.abs(x)));
  if (digits < -4 || digits > 6) return x.toExponential(2);
  return x.toFixed(Math.max(0, 2 - digits));
}

/** Four significant digits, without zeros behind: 32, 13.35. */
export function plainNumber(x: number): string {
  return Number.isFinite(x) ? String(Number(x.toPrecision(4))) : "–";
}

/** A length [m] in the unit in which it has few digits. */
export function lengthText(metres: number): string {
  if (!Number.isFinite(metres)) return "–";
  const size = Math.abs(metres);
  if (size < 1) return `${plainMillimetres(1000 * metres)} mm`;
  return `${threeDigits(metres)} m`;
}

/** Tenths of a millimetre at most: nothing here is known more closely. */
function plainMillimetres(x: number): string {
  return Math.abs(x) < 1 ? threeDigits(x) : String(Number(x.toFixed(1)));
}

/** A force [N]; small ones in mN. */
export function forceText(newtons: number): string {
  if (!Number.isFinite(newtons)) return "–";
  if (newtons !== 0 && Math.abs(newtons) < 0.1) return `${threeDigits(1000 * newtons)} mN`;
  return `${threeDigits(newtons)} N`;
}

export function viscosityText(mu: number): string {
  return `${plainNumber(mu)} N·s/m³`;
}

export function secondsText(seconds: number): string {
  if (!Number.isFinite(seconds)) return "–";
  if (seconds < 1) return `${threeDigits(1000 * seconds)} ms`;
  return `${threeDigits(seconds)} s`;
}

/** A clock reading of a recording: "1:02.35". */
export function clockText(seconds: number): string {
  const whole = Math.max(0, seconds);
  const minutes = Math.floor(whole / 60);
  return `${minutes}:${(whole - 60 * minutes).toFixed(2).padStart(5, "0")}`;
}

export function bytesText(bytes: number): string {
  if (bytes < 1e3) return `${bytes} B`;
  if (bytes < 1e6) return `${threeDigits(bytes / 1e3)} kB`;
  if (bytes < 1e9) return `${threeDigits(bytes / 1e6)} MB`;
  return `${threeDigits(bytes / 1e9)} GB`;
}

/** Units a mesh file may be in; the file itself never says. */
export const lengthUnits = ["mm", "cm", "m", "in"] as const;
export type LengthUnit = (typeof lengthUnits)[number];

export function metresPer(unit: LengthUnit): number {
  return { mm: 0.001, cm: 0.01, m: 1, in: 0.0254 }[unit];
}

export function unitName(unit: LengthUnit): string {
  return { mm: "millimetres", cm: "centimetres", m: "metres", in: "inches" }[unit];
}

/** How large something would be if its file were in this unit: "120 x 80 x 40 mm". */
export function sizeText(size: readonly [number, number, number], unit: LengthUnit): string {
  const metres = size.map((x) => x * metresPer(unit));
  const largest = Math.max(...metres);
  const [factor, name] = largest < 1 ? [1000, "mm"] : largest < 1000 ? [1, "m"] : [0.001, "km"];
  return `${metres.map((x) => threeDigits(x * factor)).join(" × ")} ${name}`;
}
