// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Layers: which ranks are shown as shells, where the slice is, and what is drawn beside them.
import { cssColour, rankColour } from "../colour/rank_palette";
import { checkbox, field, group, iconButton, numberField, Segments, select, setPressed, slider } from "../dom/controls";
import { element } from "../dom/element";
import type { Feel, Field } from "../protocol/hello";
import { axisNames, type Axis } from "../protocol/shapes";
import { rankViscosities } from "../text/rank_viscosities";
import { lengthText } from "../text/units";
import type { Shown } from "../view/workplace";

export interface LayersActions {
  /** What is shown has changed. */
  apply: () => void;
  cut: (axis: Axis, where: number) => void;
  sliceAt: () => { axis: Axis; where: number };
}

export class LayersPanel {
  readonly root = element("div");
  private readonly ranks = element("ul", { class: "list ranks" });
  private readonly axis: Segments;
  private readonly where: HTMLInputElement;
  private readonly whereNumber: HTMLInputElement;
  private readonly whereNote = element("p", { class: "note" });
  private readonly sliceShown: HTMLLabelElement;
  private readonly cutAway: HTMLLabelElement;
  private readonly range: { lo: number; hi: number; h: number } = { lo: 0, hi: 1, h: 0.01 };
  private at: Axis = 1;
  private field: Field | null = null;
  private feel: Feel | null = null;

  constructor(
    private readonly shown: Shown,
    private readonly actions: LayersActions,
  ) {
    this.axis = new Segments(
      "Axis of the slice",
      axisNames.map((name) => [name, name, `cut across ${name} (key ${name})`]),
      "y",
      (name) => this.chooseAxis(axisNames.indexOf(name as "x") as Axis),
    );
    this.where = slider("Where the slice is", { min: 0, max: 1, step: "any" }, 0, (x) => this.cut(x));
    this.where.dataset.control = "slice";
    this.whereNumber = numberField(0, {}, (x) => this.cut(x));
    this.whereNumber.setAttribute("aria-label", "Where the slice is, in metres");
    this.sliceShown = checkbox("Slice", shown.slice, (on) => this.set({ slice: on }));
    this.cutAway = checkbox("Cut away before it", shown.cutAway, (on) => this.set({ cutAway: on }));
    const opacity = slider("Opacity of shells", { min: 0.03, max: 1, step: 0.01 }, shown.opacity, (x) =>
      this.set({ opacity: x }),
    );
    const colouring = select(
      [
        ["rank", "rank"],
        ["viscosity", "viscosity in force"],
      ],
      shown.colouring,
      (value) => this.set({ colouring: value as Shown["colouring"] }),
    );
    const arrows = slider("Length of drag arrows", { min: -3, max: 1.5, step: 0.05 }, Math.log10(shown.metresPerNewton), (x) =>
      this.set({ metresPerNewton: 10 ** x }),
    );
    const all = iconButton("eye", "Show or hide all shells (G)", () => this.toggleAll(), "quiet");
    const shells = group("Layers", this.ranks, field("Opacity", opacity));
    shells.querySelector("h2")?.append(element("span", { class: "push" }), all);
    this.root.append(
      shells,
      group(
        "Slice",
        element("div", { class: "row" }, this.sliceShown, element("span", { class: "fill" }), this.axis.root),
        element("div", { class: "row" }, this.where, element("div", { class: "metres" }, this.whereNumber, "m")),
        this.whereNote,
        this.cutAway,
        field("Coloured by", colouring),
      ),
      group(
        "Also show",
        element(
          "div",
          { class: "checks" },
          checkbox("Objects", shown.objects, (on) => this.set({ objects: on })),
          checkbox("Arm", shown.arm, (on) => this.set({ arm: on })),
          checkbox("Body points", shown.points, (on) => this.set({ points: on })),
          checkbox("Drag", shown.drag, (on) => this.set({ drag: on })),
        ),
        field("Drag arrows", arrows, "metres of arrow per newton"),
      ),
    );
  }

  setField(fresh: Field): void {
    this.field = fresh;
    const { axis, where } = this.actions.sliceAt();
    this.showAxis(axis);
    this.showWhere(where);
    this.listRanks();
  }

  setFeel(feel: Feel): void {
    this.feel = feel;
    this.listRanks();
  }

  /** The slice is somewhere else now. */
  showWhere(where: number): void {
    this.where.value = String(where);
    this.whereNumber.value = where.toFixed(4);
    const index = Math.floor((where - this.range.lo) / this.range.h);
    this.whereNote.textContent = `voxel ${index}, ${lengthText(this.range.h)} thick`;
  }

  chooseAxis(axis: Axis): void {
    this.showAxis(axis);
    this.cut((this.range.lo + this.range.hi) / 2);
  }

  /** Cuts there, or as near as the workspace allows. */
  place(axis: Axis, where: number): void {
    this.showAxis(axis);
    this.cut(where);
  }

  /** Moves the slice by whole voxels. */
  step(voxels: number): void {
    this.cut(this.where.valueAsNumber + voxels * this.range.h);
  }

  toggleSlice(): void {
    this.check(this.sliceShown);
  }
  toggleCutAway(): void {
    this.check(this.cutAway);
  }

  /** All shells, or none where any is shown. */
  toggleAll(): void {
    const ranks = this.field?.ranks ?? 0;
    if (this.shown.shells.size > 0) this.shown.shells.clear();
    else for (let rank = 1; rank <= ranks; ++rank) this.shown.shells.add(rank);
    this.listRanks();
    this.actions.apply();
  }

  private check(label: HTMLLabelElement): void {
    label.querySelector("input")?.click();
  }

  private showAxis(axis: Axis): void {
    if (!this.field) return;
    this.at = axis;
    this.axis.value = axisNames[axis];
    const { origin, dims, voxelSize: h } = this.field;
    Object.assign(this.range, { lo: origin[axis], hi: origin[axis] + h * dims[axis], h });
    for (const control of [this.where, this.whereNumber]) {
      control.min = String(this.range.lo + h / 2);
      control.max = String(this.range.hi - h / 2);
    }
    this.where.step = String(h);
  }

  private cut(where: number): void {
    const { lo, hi, h } = this.range;
    const kept = Math.min(hi - h / 2, Math.max(lo + h / 2, where));
    this.showWhere(kept);
    this.actions.cut(this.at, kept);
  }

  private set(change: Partial<Shown>): void {
    Object.assign(this.shown, change);
    this.actions.apply();
  }

  private listRanks(): void {
    if (!this.field || !this.feel) return;
    const { ranks } = this.field;
    const viscosities = rankViscosities(this.field, this.feel.viscosity);
    const rows = Array.from({ length: ranks }, (_, n) => n + 1).map((rank) => {
      const shown = this.shown.shells.has(rank);
      const eye = iconButton(shown ? "eye" : "eye_off", `Shell of rank ${rank}`, () => {
        if (!this.shown.shells.delete(rank)) this.shown.shells.add(rank);
        this.listRanks();
        this.actions.apply();
        this.ranks.querySelectorAll("button")[rank - 1]?.focus();
      }, "quiet small");
      setPressed(eye, shown);
      const swatch = element("span", { class: "swatch" });
      swatch.style.background = cssColour(rankColour(rank, ranks));
      return element(
        "li",
        {},
        swatch,
        element("span", { class: "name" }, `rank ${rank}`),
        element("span", { class: "detail" }, viscosities[rank - 1] ?? ""),
        eye,
      );
    });
    this.ranks.replaceChildren(...rows);
  }
}
