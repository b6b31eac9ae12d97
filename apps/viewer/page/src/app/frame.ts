// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The frame around the view: the bar on top and the two sides, which open and close.
import { iconButton, setPressed, tabs } from "../dom/controls";
import { byId, element } from "../dom/element";
import type { ConnectionState } from "../protocol/connection";
import type { Hello } from "../protocol/hello";
import { bytesText, lengthText } from "../text/units";

type Side = "left" | "right";

/** Below this width the sides are drawers over the view, closed at first (layout.css). */
const narrow = matchMedia("(max-width: 1000px)");

const stateTexts: Record<ConnectionState, [text: string, look: string]> = {
  connecting: ["connecting", "warn"],
  open: ["live", "good"],
  lost: ["no server, trying again", "bad"],
};

export class Frame {
  private readonly source = element("div", { class: "source" });
  private readonly chip = element("span", { class: "chip", role: "status" });
  private readonly sides: Record<Side, HTMLButtonElement>;

  constructor(
    left: readonly [string, HTMLElement][],
    right: readonly [string, HTMLElement][],
    actions: { theme: () => void; help: () => void; strip: () => void },
  ) {
    this.sides = {
      left: iconButton("left", "Scene panel", () => this.toggle("left")),
      right: iconButton("right", "Arm panel", () => this.toggle("right")),
    };
    byId("left").append(...tabs("Scene", left));
    byId("right").append(...tabs("Arm", right));
    byId("bar").append(
      this.sides.left,
      element("h1", { class: "brand" }, element("img", { src: "./icon.svg", alt: "" }), "Vicinity"),
      this.source,
      element("span", { class: "push" }),
      this.chip,
      iconButton("strip", "Strip chart", actions.strip),
      iconButton("theme", "Dark or light (T)", actions.theme),
      iconButton("help", "Keys (?)", actions.help),
      this.sides.right,
    );
    const adapt = (): void => {
      for (const side of ["left", "right"] as const) this.open(side, !narrow.matches);
    };
    narrow.addEventListener("change", adapt);
    adapt();
  }

  showState(state: ConnectionState): void {
    const [text, look] = stateTexts[state];
    this.chip.textContent = text;
    this.chip.className = `chip ${look}`;
  }

  showHello({ field, robot }: Hello): void {
    const [nx, ny, nz] = field.dims;
    const detail = [
      `${nx} × ${ny} × ${nz} voxels of ${lengthText(field.voxelSize)}`,
      bytesText(field.bytes),
      robot.probe ? "a point as the arm" : `${robot.name}, ${robot.points.toLocaleString("en")} points`,
    ].join(" · ");
    this.source.replaceChildren(
      element("strong", {}, field.name),
      element("span", { class: "detail" }, `  ${detail}`),
    );
    document.title = `${field.name} – Vicinity`;
  }

  /** Opens a side; a drawer closes the other one. */
  open(side: Side, open: boolean): void {
    const other: Side = side === "left" ? "right" : "left";
    byId("desk").classList.toggle(`without-${side}`, !open);
    setPressed(this.sides[side], open);
    if (open && narrow.matches) {
      byId("desk").classList.add(`without-${other}`);
      setPressed(this.sides[other], false);
    }
  }

  private toggle(side: Side): void {
    this.open(side, byId("desk").classList.contains(`without-${side}`));
  }
}
