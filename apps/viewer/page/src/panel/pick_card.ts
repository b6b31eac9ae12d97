// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// What is this voxel? The answer, beside the view.
import { iconButton } from "../dom/controls";
import { element } from "../dom/element";
import { Json } from "../protocol/json";
import type { Message } from "../protocol/message";
import { lengthText, viscosityText } from "../text/units";

export interface Picked {
  point: number[];
  voxel: number[];
  kind: string;
  object: string | null;
  rank: number;
  viscosity: number;
  distance: number | null;
  atLeast: number | null;
}

export function readPicked(message: Message): Picked {
  const json = new Json(message.json(), "PICK");
  return {
    point: json.at("point").numbers(3),
    voxel: json.at("voxel").isNull ? [] : json.at("voxel").numbers(3), // none outside the workspace
    kind: json.at("kind").text(),
    object: json.at("object").textOr(null),
    rank: json.at("rank").numberOr(0),
    viscosity: json.at("viscosity").number(),
    distance: json.at("distance").numberOr(null),
    atLeast: json.at("at_least").numberOr(null),
  };
}

/** Rows of the card: what, and how it is. */
export function pickedRows(picked: Picked): [string, string][] {
  const rows: [string, string][] = [["kind", picked.kind]];
  if (picked.object !== null) rows.push(["object", picked.object]);
  if (picked.rank > 0) rows.push(["rank", String(picked.rank)]);
  rows.push(["viscosity", viscosityText(picked.viscosity)]);
  if (picked.distance !== null) rows.push(["distance", lengthText(picked.distance)]);
  else if (picked.atLeast !== null) rows.push(["distance", `at least ${lengthText(picked.atLeast)}`]);
  rows.push(["point", `${picked.point.map((x) => x.toFixed(3)).join(", ")} m`]);
  rows.push(["voxel", picked.voxel.join(", ") || "outside the workspace"]);
  return rows;
}

export class PickCard {
  readonly root = element("div", { class: "card pick", role: "status", "aria-label": "Picked voxel" });

  constructor(private readonly onClose: () => void) {
    this.root.hidden = true;
  }

  show(picked: Picked): void {
    this.root.hidden = false;
    const rows = pickedRows(picked).flatMap(([name, value]) => [
      element("dt", {}, name),
      element("dd", { "data-picked": name }, value),
    ]);
    this.root.replaceChildren(
      element("div", { class: "row" }, element("h2", { class: "fill" }, "Voxel"), iconButton("close", "Close", () => {
        this.hide();
        this.onClose();
      }, "quiet small")),
      element("dl", {}, ...rows),
    );
  }

  hide(): void {
    this.root.hidden = true;
  }
}
