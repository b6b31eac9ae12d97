// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The objects of the field: choose one, look at it, hide it.
import { button, group, iconButton, setPressed } from "../dom/controls";
import { element } from "../dom/element";
import type { Field } from "../protocol/hello";

export interface ObjectsActions {
  hide: (object: number, hidden: boolean) => void;
  choose: (object: number | null) => void;
  lookAt: (object: number) => void;
}

export class ObjectsPanel {
  readonly root: HTMLElement;
  private readonly list = element("ul", { class: "list" });
  private readonly rows: HTMLLIElement[] = [];
  private field: Field | null = null;
  private readonly hidden = new Set<number>();
  private chosen: number | null = null;

  constructor(private readonly actions: ObjectsActions) {
    this.root = group("Objects", this.list);
    this.root
      .querySelector("h2")
      ?.append(element("span", { class: "push" }), button("show all", () => this.showAll(), { class: "quiet" }));
  }

  setField(field: Field): void {
    this.field = field;
    this.hidden.clear();
    this.chosen = null;
    this.rows.length = 0;
    this.rows.push(...field.objects.map((object, n) => this.row(object.name, n)));
    this.list.replaceChildren(...this.rows);
  }

  choose(object: number | null): void {
    this.chosen = object;
    this.rows.forEach((row, n) => {
      row.classList.toggle("chosen", n === object);
      row.querySelector(".name")?.setAttribute("aria-pressed", String(n === object));
    });
    if (object !== null) this.rows[object]?.scrollIntoView({ block: "nearest" });
    this.actions.choose(object);
  }

  get chosenObject(): number | null {
    return this.chosen;
  }

  hide(object: number, hidden: boolean): void {
    if (hidden) this.hidden.add(object);
    else this.hidden.delete(object);
    const row = this.rows[object];
    row?.classList.toggle("hidden-object", hidden);
    const eye = row?.querySelector<HTMLElement>(".eye");
    const name = this.field?.objects[object]?.name ?? "";
    if (eye) {
      const fresh = this.eye(name, object, hidden);
      const hadFocus = document.activeElement === eye;
      eye.replaceWith(fresh);
      if (hadFocus) fresh.focus();
    }
    this.actions.hide(object, hidden);
  }

  /** Hides the chosen object, or shows it again. */
  toggleChosen(): void {
    if (this.chosen !== null) this.hide(this.chosen, !this.hidden.has(this.chosen));
  }

  showAll(): void {
    for (const object of [...this.hidden]) this.hide(object, false);
  }

  private row(name: string, object: number): HTMLLIElement {
    const title = element(
      "button",
      {
        type: "button",
        class: "name quiet",
        title: `${name}: choose; twice: look at it`,
        "aria-pressed": "false",
        onclick: () => this.choose(this.chosen === object ? null : object),
        ondblclick: () => {
          this.choose(object);
          this.actions.lookAt(object);
        },
      },
      name,
    );
    const detail = this.field?.objects[object];
    return element(
      "li",
      {},
      title,
      element("span", { class: "detail" }, detail ? `m ${detail.m} · q ${detail.q}` : ""),
      this.eye(name, object, false),
    );
  }

  private eye(name: string, object: number, hidden: boolean): HTMLButtonElement {
    const eye = iconButton(
      hidden ? "eye_off" : "eye",
      hidden ? `Show ${name}` : `Hide ${name}`,
      () => this.hide(object, !this.hidden.has(object)),
      "quiet small eye",
    );
    setPressed(eye, !hidden);
    return eye;
  }
}
