// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The overlay that lists all keys.
import { iconButton } from "../dom/controls";
import { element } from "../dom/element";

const sections: readonly [title: string, keys: readonly [keys: string, does: string][]][] = [
  [
    "Look",
    [
      ["drag", "orbit; with the right button or Shift, move"],
      ["wheel  +  −", "nearer, farther"],
      ["←  →  ↑  ↓", "turn the view"],
      ["1  2  3  4", "view from a corner, front, side, top"],
      ["click", "what is this voxel?"],
      ["M", "measure between two clicks"],
      ["H", "hide the chosen object; with Shift: show all"],
    ],
  ],
  [
    "Layers",
    [
      ["X  Y  Z", "cut across this axis"],
      ["[  ]", "move the slice by a voxel; with Shift by ten"],
      ["V", "slice on, off"],
      ["C", "cut away before the slice, or not"],
      ["G", "all shells on, off"],
    ],
  ],
  [
    "Drive",
    [
      ["drag the ring", "lead the tool; hold X, Y or Z to keep to an axis, wheel for depth"],
      ["W  A  S  D", "lead it away, left, nearer, right"],
      ["Q  E", "down, up"],
      ["I  K  J  L  U  O", "tilt, turn and roll the tool"],
      ["Shift", "slowly"],
      ["Escape", "hold: stop where it is"],
      ["gamepad", "left stick and triggers lead, right stick turns; rumble is drag"],
    ],
  ],
  [
    "Page",
    [
      ["Space", "play, pause a recording"],
      [ ",  .", "a frame back, forth"],
      ["T", "dark, light"],
      ["?", "these keys"],
    ],
  ],
];

export class Help {
  readonly root: HTMLDialogElement;

  constructor() {
    this.root = element(
      "dialog",
      { class: "help", "aria-label": "Keys" },
      element(
        "div",
        { class: "row" },
        element("h2", { class: "fill" }, "Keys"),
        iconButton("close", "Close", () => this.root.close()),
      ),
      element(
        "div",
        { class: "sections" },
        ...sections.map(([title, keys]) =>
          element(
            "section",
            {},
            element("h3", {}, title),
            element(
              "dl",
              {},
              ...keys.flatMap(([key, does]) => [
                element("dt", {}, ...key.split("  ").map((part) => element("kbd", {}, part))),
                element("dd", {}, does),
              ]),
            ),
          ),
        ),
      ),
    );
    this.root.addEventListener("click", (event) => {
      if (event.target === this.root) this.root.close();
    });
  }

  toggle(): void {
    if (this.root.open) this.root.close();
    else this.root.showModal();
  }
}
