// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The controls that panels are made of. Each has a label that a screen reader says.
import { element } from "./element";
import { icon, type IconName } from "./icon";

let lastId = 0;
export function freshId(): string {
  lastId += 1;
  return `control-${lastId}`;
}

export function group(title: string, ...content: (Node | string)[]): HTMLElement {
  return element("section", { class: "group", "aria-label": title }, element("h2", {}, title), ...content);
}

export function field(label: string, control: HTMLElement, hint?: string): HTMLElement {
  control.id ||= freshId();
  return element(
    "div",
    { class: control.classList.contains("triple") ? "field stacked" : "field", title: hint },
    element("label", { for: control.id }, label),
    control,
  );
}

export function button(
  text: string,
  onPress: () => void,
  attributes: Record<string, string | boolean> = {},
): HTMLButtonElement {
  return element("button", { type: "button", onclick: onPress, ...attributes }, text);
}

/** A button that is only a picture; its label is said and shown as its hint. */
export function iconButton(
  name: IconName,
  label: string,
  onPress: () => void,
  look = "icon quiet",
): HTMLButtonElement {
  return element(
    "button",
    { type: "button", class: look, "aria-label": label, title: label, onclick: onPress },
    icon(name),
  );
}

export function setPressed(control: HTMLElement, pressed: boolean): void {
  control.setAttribute("aria-pressed", String(pressed));
}

export function checkbox(label: string, checked: boolean, onChange: (on: boolean) => void): HTMLLabelElement {
  const box = element("input", { type: "checkbox" });
  box.checked = checked;
  box.addEventListener("change", () => onChange(box.checked));
  return element("label", { class: "row check" }, box, label);
}

export function select(
  options: readonly (string | [value: string, text: string])[],
  value: string,
  onChange: (value: string) => void,
): HTMLSelectElement {
  const made = element("select");
  setOptions(made, options, value);
  made.addEventListener("change", () => onChange(made.value));
  return made;
}

export function setOptions(
  control: HTMLSelectElement,
  options: readonly (string | [value: string, text: string])[],
  value: string,
): void {
  control.replaceChildren(
    ...options.map((option) => {
      const [name, text] = typeof option === "string" ? [option, option] : option;
      return element("option", { value: name }, text);
    }),
  );
  control.value = value;
}

/** A few choices of which one holds, side by side. */
export class Segments {
  readonly root: HTMLElement;
  private readonly buttons = new Map<string, HTMLButtonElement>();

  constructor(
    label: string,
    options: readonly [value: string, text: string, hint?: string][],
    value: string,
    onChange: (value: string) => void,
  ) {
    this.root = element("div", { class: "segments", role: "group", "aria-label": label });
    for (const [name, text, hint] of options) {
      const made = button(text, () => {
        this.value = name;
        onChange(name);
      });
      if (hint) made.title = hint;
      this.buttons.set(name, made);
      this.root.append(made);
    }
    this.value = value;
  }

  set value(value: string) {
    for (const [name, made] of this.buttons) setPressed(made, name === value);
  }
}

/** A number with its unit behind it. */
export function numberField(
  value: number,
  limits: { min?: number; max?: number; step?: number },
  onChange: (value: number) => void,
): HTMLInputElement {
  const made = element("input", { type: "number", step: "any", ...limits });
  made.value = String(value);
  made.addEventListener("change", () => {
    const changed = made.valueAsNumber;
    const inRange =
      Number.isFinite(changed) && changed >= (limits.min ?? -Infinity) && changed <= (limits.max ?? Infinity);
    made.setAttribute("aria-invalid", String(!inRange));
    if (inRange) onChange(changed);
  });
  return made;
}

export function slider(
  label: string,
  limits: { min: number; max: number; step: number | "any" },
  value: number,
  onInput: (value: number) => void,
): HTMLInputElement {
  const made = element("input", { type: "range", "aria-label": label, ...limits });
  made.value = String(value);
  made.addEventListener("input", () => onInput(made.valueAsNumber));
  return made;
}

/** Tabs over pages of which one is seen; left and right arrows go along them. */
export function tabs(label: string, pages: readonly [title: string, page: HTMLElement][]): HTMLElement[] {
  const bar = element("div", { class: "tabs", role: "tablist", "aria-label": label });
  const made = pages.map(([title, page]) => {
    page.id ||= freshId();
    page.setAttribute("role", "tabpanel");
    page.setAttribute("aria-label", title);
    const tab = element("button", { type: "button", role: "tab", "aria-controls": page.id }, title);
    bar.append(tab);
    return tab;
  });
  const choose = (chosen: number, focus = false): void => {
    made.forEach((tab, n) => {
      tab.setAttribute("aria-selected", String(n === chosen));
      tab.tabIndex = n === chosen ? 0 : -1;
      pages[n]![1].hidden = n !== chosen;
    });
    if (focus) made[chosen]?.focus();
  };
  made.forEach((tab, n) => {
    tab.addEventListener("click", () => choose(n));
    tab.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (step) choose((n + step + made.length) % made.length, true);
    });
  });
  choose(0);
  return [bar, element("div", { class: "pages" }, ...pages.map(([, page]) => page))];
}
