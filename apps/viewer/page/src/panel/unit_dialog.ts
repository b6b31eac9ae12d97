// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Asks for the unit of a mesh file, with the size that each would make it. None is chosen before the
// person chooses: a wrong guess would be a thousand times too near or too far.
import { button } from "../dom/controls";
import { element } from "../dom/element";
import type { UploadedMesh } from "../scene/mesh_upload";
import { lengthUnits, sizeText, unitName, type LengthUnit } from "../text/units";

/** @return the unit, or null where the person would rather not */
export function askForUnit(name: string, mesh: UploadedMesh): Promise<LengthUnit | null> {
  return new Promise((answer) => {
    let chosen: LengthUnit | null = null;
    const add = button("Add to the scene", () => dialog.close("add"), { class: "primary" });
    add.disabled = true;
    const choices = lengthUnits.map((unit) => {
      const radio = element("input", { type: "radio", name: "unit", value: unit });
      radio.addEventListener("change", () => {
        chosen = unit;
        add.disabled = false;
      });
      return element(
        "label",
        { class: "choice" },
        radio,
        element("span", { class: "unit" }, unitName(unit)),
        element("span", { class: "fill" }, sizeText(mesh.size, unit)),
      );
    });
    const facts = `${mesh.triangles.toLocaleString("en")} triangles, ${mesh.closed ? "closed" : "open"}`;
    const dialog: HTMLDialogElement = element(
      "dialog",
      { class: "units", "aria-label": `Unit of ${name}` },
      element("h2", {}, name),
      element("p", { class: "note" }, `${facts}. A unit in a mesh file is not read. Which of these is it?`),
      element("fieldset", {}, element("legend", { class: "visually-hidden" }, "Unit"), ...choices),
      ...mesh.problems.map((problem) => element("p", { class: "note bad" }, problem)),
      element("div", { class: "row end" }, button("Leave it out", () => dialog.close()), add),
    );
    dialog.addEventListener("close", () => {
      dialog.remove();
      answer(dialog.returnValue === "add" ? chosen : null);
    });
    document.body.append(dialog);
    dialog.showModal();
  });
}
