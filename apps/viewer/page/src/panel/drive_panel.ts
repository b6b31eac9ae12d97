// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Driving by joints, where the tool is, and how heavy the mouse and the gamepad make the drag.
import { button, field, group, slider } from "../dom/controls";
import { element } from "../dom/element";
import type { Robot } from "../protocol/hello";
import { drivers, type Snapshot } from "../protocol/snapshot";
import { forceText, lengthText, threeDigits } from "../text/units";

export interface DriveActions {
  joints: (targets: number[]) => void;
  hold: () => void;
  /** Drag at which the pointer goes half as far, and the gamepad rumbles half as strongly [N]. */
  setHalfAt: (newtons: number) => void;
}

interface JointRow {
  slider: HTMLInputElement;
  value: HTMLElement;
  prismatic: boolean;
}

const driverTexts: Record<(typeof drivers)[number], string> = {
  hold: "at rest",
  tool: "led by its tool",
  joints: "led by its joints",
  recording: "follows a recording",
};

export class DrivePanel {
  readonly root = element("div");
  private readonly joints = element("div", { class: "joints" });
  private readonly tool = element("dl", { class: "readings" });
  private readonly gamepad = element("p", { class: "note", role: "status" }, "No gamepad: press one of its buttons to wake it.");
  private readonly driver = element("span", { class: "detail" });
  private readonly readings = new Map<string, HTMLElement>();
  private rows: JointRow[] = [];
  private targets: number[] = [];
  private heldRow: number | null = null;
  private isDriven = false;

  constructor(private readonly actions: DriveActions) {
    for (const name of ["place", "velocity", "drag", "against the hand", "behind the hand", "points felt"]) {
      const value = element("dd", { "data-tool": name }, "–");
      this.readings.set(name, value);
      this.tool.append(element("dt", {}, name), value);
    }
    const heaviness = element("output", { class: "fixed" }, forceText(2));
    const half = slider("Drag that halves the pointer's way", { min: -2, max: 2, step: 0.05 }, Math.log10(2), (x) => {
      heaviness.textContent = forceText(10 ** x);
      actions.setHalfAt(10 ** x);
    });
    const tool = group("Tool", this.tool, element("div", { class: "row" }, this.driver, element("span", { class: "fill" }), button("Hold", () => actions.hold(), { title: "stop where it is (Escape)" })));
    this.root.append(
      tool,
      group("Joints", this.joints),
      group(
        "Hand",
        field("Half way at", element("div", { class: "row" }, half, heaviness)),
        element(
          "p",
          { class: "note" },
          "Drag the ring at the tool. The pointer is slowed by the drag: at this force the mouse moves it half as far, and a gamepad rumbles at half strength.",
        ),
        this.gamepad,
      ),
    );
  }

  setRobot(robot: Robot): void {
    this.rows = robot.coordinates.map((coordinate, n) => {
      const span = coordinate.prismatic ? 1 : Math.PI;
      const limits = {
        min: coordinate.lower ?? -span,
        max: coordinate.upper ?? span,
        step: "any" as const,
      };
      const value = element("output", {}, "–");
      const made = slider(`Joint ${coordinate.name}`, limits, 0, (x) => this.drive(n, x));
      made.dataset.joint = coordinate.name;
      made.addEventListener("pointerup", () => (this.heldRow = null));
      made.addEventListener("blur", () => (this.heldRow = null));
      return { slider: made, value, prismatic: coordinate.prismatic };
    });
    this.joints.replaceChildren(
      ...this.rows.map((row, n) => {
        row.slider.id = `joint-${n}`;
        return element(
          "div",
          { class: "joint" },
          element("label", { for: row.slider.id }, robot.coordinates[n]!.name),
          row.slider,
          row.value,
        );
      }),
    );
  }

  update(snapshot: Snapshot): void {
    const driver = drivers[snapshot.driver] ?? "hold";
    this.isDriven = driver === "joints";
    this.driver.textContent = driverTexts[driver];
    this.rows.forEach((row, n) => {
      const q = snapshot.q[n];
      if (q === undefined) return;
      row.value.textContent = row.prismatic ? lengthText(q) : `${((180 * q) / Math.PI).toFixed(1)}°`;
      if (this.heldRow !== n && !this.isDriven) row.slider.value = String(q);
    });
    if (!this.isDriven) this.targets = [...snapshot.q];
    const { tool, toolVelocity: v } = snapshot;
    const texts: Record<string, string> = {
      place: `${[tool[0], tool[1], tool[2]].map((x) => (x ?? 0).toFixed(3)).join(", ")} m`,
      velocity: `${threeDigits(Math.hypot(...v))} m/s`,
      drag: forceText(Math.hypot(...snapshot.force)),
      "against the hand": forceText(snapshot.felt),
      "behind the hand": driver === "joints" ? threeDigits(snapshot.lag) : lengthText(snapshot.lag),
      "points felt": String(snapshot.pointsFelt),
    };
    for (const [name, value] of this.readings) value.textContent = texts[name] ?? "–";
  }

  showGamepad(text: string): void {
    if (this.gamepad.textContent !== text) this.gamepad.textContent = text;
  }

  private drive(joint: number, target: number): void {
    this.heldRow = joint;
    this.targets[joint] = target;
    this.actions.joints([...this.targets]);
  }
}
