// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// What the page's address asks to see: for links to a view, and for `vicinity serve --shot`.
import { axisNames, type Axis } from "../protocol/shapes";
import type { Theme } from "../view/look";
import type { ViewDirection } from "../view/stage";

export interface AddressedView {
  theme: Theme | null;
  view: ViewDirection | null;
  /** "off", or where. */
  slice: "off" | { axis: Axis; where: number } | null;
  cutAway: boolean | null;
  shells: "all" | number[];
  panels: boolean;
}

function oneOf<Word extends string>(word: string | null, words: readonly Word[]): Word | null {
  return words.find((known) => known === word) ?? null;
}

function sliceOf(text: string | null): AddressedView["slice"] {
  if (text === "off") return "off";
  const [name, where] = (text ?? "").split(":");
  const axis = axisNames.indexOf(name as "x");
  const metres = where === undefined || where === "" ? NaN : Number(where);
  return axis >= 0 && Number.isFinite(metres) ? { axis: axis as Axis, where: metres } : null;
}

/**
 * theme=dark|light  view=iso|front|side|top  slice=y:1.1|off  cut=on|off  shells=all|1,6  panels=off
 * What is not understood is as if it were not there.
 */
export function readAddress(search: string): AddressedView {
  const asked = new URLSearchParams(search);
  const cut = oneOf(asked.get("cut"), ["on", "off"]);
  const shells = asked.get("shells") ?? "";
  const ranks = shells.split(",").map(Number).filter((rank) => Number.isInteger(rank) && rank > 0);
  return {
    theme: oneOf(asked.get("theme"), ["dark", "light"]),
    view: oneOf(asked.get("view"), ["iso", "front", "side", "top"]),
    slice: sliceOf(asked.get("slice")),
    cutAway: cut === null ? null : cut === "on",
    shells: shells === "all" ? "all" : ranks,
    panels: asked.get("panels") !== "off",
  };
}
