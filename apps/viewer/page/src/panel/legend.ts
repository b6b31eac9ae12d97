// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The rank legend in the view: colour, number and viscosity together, so that nobody has to tell
// colours apart. Always seen, whatever panels are open.
import {
  boundaryColour,
  cssColour,
  innerColour,
  rankColour,
  type Colour,
} from "../colour/rank_palette";
import { element } from "../dom/element";
import type { Feel, Field } from "../protocol/hello";
import { rankViscosities } from "../text/rank_viscosities";

function entry(colour: Colour, name: string, value: string, hatched = false): HTMLElement {
  const swatch = element("span", { class: hatched ? "block hatched" : "block" });
  swatch.style.backgroundColor = cssColour(colour);
  return element("li", {}, swatch, element("span", {}, name), element("span", { class: "value" }, value));
}

export class Legend {
  readonly root = element("figure", { class: "legend", "aria-label": "Legend of ranks" });

  show(field: Field, feel: Feel): void {
    const viscosities = rankViscosities(field, feel.viscosity);
    const entries = viscosities.map((mu, n) => entry(rankColour(n + 1, field.ranks), String(n + 1), mu));
    this.root.replaceChildren(
      element(
        "ul",
        {},
        entry(innerColour, "inner", "", true),
        entry(boundaryColour, "skin", ""),
        ...entries,
      ),
      element("figcaption", {}, "rank, and its viscosity μ in N·s/m³"),
    );
  }
}
