// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// From STL to feel: the scene that is being edited, building it, saving it.
import { button, field, group, numberField, select, setOptions } from "../dom/controls";
import { element } from "../dom/element";
import type { Files } from "../protocol/hello";
import type { Progress } from "../protocol/session";
import { emptyDraft, nameOf, objectsOf, oddities, type Draft, type SceneObject } from "../scene/draft";
import { ObjectEditor } from "./object_editor";

export interface SceneActions {
  build: (draft: Draft) => Promise<string>;
  saveScene: (name: string, draft: Draft) => Promise<string>;
  saveField: (name: string) => Promise<string>;
  open: (name: string) => Promise<Draft>;
  addMeshes: (files: FileList) => void;
  /** The draft, or which of its objects is chosen, has changed. */
  preview: (draft: Draft, chosen: SceneObject | null, gizmo: "translate" | "rotate") => void;
  removed: (object: SceneObject) => void;
}

export class ScenePanel {
  readonly root = element("div");
  draft: Draft = emptyDraft();
  private chosen: SceneObject | null = null;
  private editor: ObjectEditor | null = null;
  private codings: readonly string[] = [];

  private readonly name = element("input", { type: "text" });
  private readonly voxel: HTMLInputElement;
  private readonly open: HTMLSelectElement;
  private readonly list = element("ul", { class: "list" });
  private readonly editorPlace = element("div");
  private readonly said = element("div", { role: "status" });
  private readonly odd = element("div");
  private readonly progress = element("progress", { max: 1, value: 0, "aria-label": "Building" });
  private readonly progressText = element("span", { class: "detail" });
  private readonly progressRow: HTMLElement;
  private readonly buildButton: HTMLButtonElement;

  constructor(private readonly actions: SceneActions) {
    this.voxel = numberField(5, { min: 0.01, max: 1000 }, (millimetres) => {
      this.draft.scene.voxel_size = Number((millimetres / 1000).toPrecision(10));
      this.changed();
    });
    this.name.addEventListener("change", () => (this.draft.name = this.name.value.trim() || "scene.yaml"));
    this.open = select([["", "choose …"]], "", (name) => this.openScene(name));
    const picker = element("input", { type: "file", accept: ".stl,.obj,.ply,.glb,.gltf,.dae,.3mf", multiple: true, hidden: true });
    picker.dataset.control = "mesh-file";
    picker.addEventListener("change", () => {
      if (picker.files) actions.addMeshes(picker.files);
      picker.value = "";
    });
    this.progressRow = element("div", { class: "progress" }, this.progress, this.progressText);
    this.progressRow.hidden = true;
    this.buildButton = button("Build", () => void this.build(), { class: "primary" });
    this.root.append(
      group(
        "Scene",
        field("Open", this.open),
        field("Name", this.name),
        field("Voxel [mm]", this.voxel),
        element(
          "div",
          { class: "row end" },
          button("New", () => this.setDraft(emptyDraft())),
          button("Save scene", () => void this.run(() => actions.saveScene(this.draft.name, this.draft))),
          button("Save field", () =>
            void this.run(() => actions.saveField(this.draft.name.replace(/\.ya?ml$/, "") + ".vicinity")),
          ),
          this.buildButton,
        ),
        this.progressRow,
        this.odd,
        this.said,
      ),
      group(
        "Objects of the scene",
        this.list,
        element("p", { class: "note" }, "Drop an STL on the page to add it."),
        element("div", { class: "row" }, button("Add a mesh …", () => picker.click()), picker),
      ),
      this.editorPlace,
    );
    this.setDraft(this.draft);
  }

  setDraft(draft: Draft): void {
    this.draft = draft;
    this.name.value = draft.name;
    const h = draft.scene.voxel_size;
    this.voxel.value = typeof h === "number" ? String(Number((1000 * h).toPrecision(10))) : "";
    this.choose(null);
  }

  setFiles(files: Files): void {
    setOptions(this.open, [["", "choose …"], ...files.scenes.map((name): [string, string] => [name, name])], "");
  }

  setCodings(codings: readonly string[]): void {
    this.codings = codings;
  }

  choose(object: SceneObject | null): void {
    this.chosen = object;
    this.editor = object
      ? new ObjectEditor(this.draft, object, this.codings, {
          changed: () => this.changed(),
          gizmo: () => this.changed(),
          remove: () => this.remove(object),
        })
      : null;
    const place = this.editor ? [group(nameOf(object!), this.editor.root)] : [];
    this.editorPlace.replaceChildren(...place);
    this.changed();
  }

  /** Another field is in place: what is previewed beside it may be another now. */
  refresh(): void {
    this.changed();
  }

  get chosenObject(): SceneObject | null {
    return this.chosen;
  }

  /** The gizmo has moved the chosen object. */
  moved(): void {
    this.editor?.showPlacement();
  }

  showProgress({ stage, done }: Progress): void {
    this.progressRow.hidden = false;
    this.progress.value = done;
    this.progressText.textContent = `${stage}, ${Math.round(100 * done)} %`;
  }

  private changed(): void {
    const rows = objectsOf(this.draft).map((object) => {
      const name = element(
        "button",
        {
          type: "button",
          class: "name quiet",
          "aria-pressed": String(object === this.chosen),
          onclick: () => this.choose(object === this.chosen ? null : object),
        },
        nameOf(object),
      );
      const units = typeof object.units === "string" ? object.units : "";
      return element("li", { class: object === this.chosen ? "chosen" : "" }, name, element("span", { class: "detail" }, units));
    });
    this.list.replaceChildren(...rows);
    const odd = oddities(this.draft);
    this.buildButton.disabled = odd.length > 0;
    this.odd.replaceChildren(...odd.map((sentence) => element("p", { class: "note bad" }, sentence)));
    this.actions.preview(this.draft, this.chosen, this.editor?.mode ?? "translate");
  }

  private remove(object: SceneObject): void {
    this.draft.scene.objects = objectsOf(this.draft).filter((other) => other !== object);
    this.actions.removed(object);
    this.choose(null);
  }

  private openScene(name: string): void {
    if (!name) return;
    this.actions
      .open(name)
      .then((draft) => this.setDraft(draft))
      .catch((error: unknown) => this.sayError(error))
      .finally(() => (this.open.value = ""));
  }

  private async build(): Promise<void> {
    this.buildButton.disabled = true;
    this.showProgress({ stage: "read", done: 0 });
    await this.run(() => this.actions.build(this.draft));
    this.progressRow.hidden = true;
    this.buildButton.disabled = false;
  }

  private async run(act: () => Promise<string>): Promise<void> {
    try {
      this.say(await act(), "good");
    } catch (error) {
      this.sayError(error);
    }
  }

  private sayError(error: unknown): void {
    this.say(error instanceof Error ? error.message : String(error), "bad");
  }

  private say(sentence: string, look: "good" | "bad"): void {
    this.said.replaceChildren(element("p", { class: `note ${look}` }, sentence));
  }
}
