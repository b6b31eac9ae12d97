// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// One object of the scene that is being edited: where it stands and how its layers are.
import { button, field, numberField, Segments, select } from "../dom/controls";
import { element } from "../dom/element";
import type { Vec3 } from "../protocol/hello";
import {
  fromRpy,
  nameOf,
  parseCoding,
  place,
  placementOf,
  setSetting,
  settingOf,
  toRpy,
  type Draft,
  type Placement,
  type SceneObject,
} from "../scene/draft";
import { lengthUnits } from "../text/units";

export interface EditorActions {
  /** The object has changed. */
  changed: () => void;
  remove: () => void;
  gizmo: (mode: "translate" | "rotate") => void;
}

const degrees = 180 / Math.PI;

function triple(label: string, values: Vec3, set: (values: Vec3) => void): HTMLElement {
  const inputs = values.map((value, n) => {
    const input = numberField(Number(value.toFixed(6)), {}, (changed) => {
      values[n] = changed;
      set([...values]);
    });
    input.setAttribute("aria-label", `${label} ${"xyz"[n]}`);
    return input;
  });
  return element("div", { class: "triple" }, ...inputs);
}

export class ObjectEditor {
  readonly root = element("div", { class: "object-editor" });
  private readonly where = element("div");
  private gizmoMode: "translate" | "rotate" = "translate";

  constructor(
    draft: Draft,
    private readonly object: SceneObject,
    codings: readonly string[],
    private readonly actions: EditorActions,
  ) {
    const setting = (key: "m" | "q" | "shape" | "coding" | "skin"): unknown => settingOf(draft, object, key);
    const set = (key: string, value: unknown): void => {
      setSetting(object, key, value);
      actions.changed();
    };
    const name = element("input", { type: "text", value: nameOf(object) });
    name.addEventListener("change", () => {
      const wanted = name.value.trim();
      if (wanted) set("name", wanted);
      else name.value = nameOf(object);
    });
    const shown = setting("coding");
    const coding = element("input", { type: "text", spellcheck: "false", value: Array.isArray(shown) ? shown.join(", ") : String(shown) });
    coding.addEventListener("change", () => {
      const parsed = parseCoding(coding.value, codings);
      coding.setAttribute("aria-invalid", String(parsed === null));
      if (parsed !== null) set("coding", parsed);
    });
    const gizmo = new Segments(
      "Gizmo",
      [
        ["translate", "move"],
        ["rotate", "turn"],
      ],
      "translate",
      (mode) => {
        this.gizmoMode = mode as "translate";
        actions.gizmo(this.gizmoMode);
      },
    );
    const rows = [
      field("Name", name),
      field("Shape from", element("div", { class: "detail" }, this.source())),
    ];
    if (typeof object.mesh === "string") {
      rows.push(
        field(
          "Unit",
          select([...lengthUnits], typeof object.units === "string" ? object.units : "", (unit) => set("units", unit)),
        ),
      );
    }
    this.root.append(
      ...rows,
      field("Gizmo", gizmo.root),
      this.where,
      field("m", numberField(Number(setting("m")), { min: 1, max: 8, step: 1 }, (m) => set("m", m)), "radius of the analyser zone in voxels, 1..8"),
      field("q", numberField(Number(setting("q")), { min: 0, max: 32, step: 1 }, (q) => set("q", q)), "number of ranks, 0..32"),
      field("Layers", select(["sphere", "cube", "distance"], String(setting("shape")), (shape) => set("shape", shape))),
      field("Coding", coding, `viscosity of rank 1, 2, ... [N·s/m³], or ${codings.join(", ")}`),
      field("Skin", numberField(Number(setting("skin")), { min: 0 }, (skin) => set("skin", skin)), "viscosity of boundary and inner voxels [N·s/m³]"),
      element("div", { class: "row end" }, button("Remove", () => actions.remove())),
    );
    this.showPlacement();
  }

  get mode(): "translate" | "rotate" {
    return this.gizmoMode;
  }

  /** The gizmo has moved it. */
  showPlacement(): void {
    const placement = placementOf(this.object);
    const put = (change: Partial<Placement>): void => {
      place(this.object, { ...placementOf(this.object), ...change });
      this.actions.changed();
    };
    this.where.replaceChildren(
      field("Place [m]", triple("Place", placement.xyz, (xyz) => put({ xyz }))),
      field(
        "Turn [°]",
        triple("Roll, pitch, yaw about", toRpy(placement.quaternion).map((x) => x * degrees) as Vec3, (rpy) =>
          put({ quaternion: fromRpy(rpy.map((x) => x / degrees) as Vec3) }),
        ),
        "roll, pitch, yaw about fixed x, y, z",
      ),
      field("Scale", numberField(placement.scale, { min: 1e-9 }, (scale) => put({ scale }))),
    );
  }

  private source(): string {
    if (typeof this.object.mesh === "string") return this.object.mesh;
    const primitive = this.object.primitive;
    if (typeof primitive !== "object" || primitive === null) return "–";
    return Object.keys(primitive)[0] ?? "–";
  }
}
