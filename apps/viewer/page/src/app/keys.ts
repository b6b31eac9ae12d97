// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// What each key does (panel/help.ts lists them). Keys that a control needs are left to it.

export type KeyActions = Record<string, (event: KeyboardEvent) => void>;

/** Whether the element with the focus takes this key for itself. */
export function isForControl(target: EventTarget | null, key: string): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.closest("dialog")) return true;
  if (target instanceof HTMLInputElement && (target.type === "text" || target.type === "number")) return true;
  if (target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement) return true;
  const isPressed = key === " " || key === "Enter";
  if (target.closest("button, summary, label, input") && isPressed) return true;
  return key.startsWith("Arrow") && target.closest("input, [role=tab]") !== null;
}

/** Names a key as `actions` does: its character without case, or its name. */
export function keyName(event: KeyboardEvent): string {
  return event.key.length === 1 ? event.key.toLowerCase() : event.key;
}

export class Keys {
  private readonly held = new Set<string>();

  /** @param jog hears of every key first; true: it has taken it */
  constructor(actions: KeyActions, jog: (code: string, isDown: boolean, slow: boolean) => boolean, onBlur: () => void) {
    window.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (isForControl(event.target, event.key)) return;
      this.held.add(event.code);
      if (jog(event.code, true, event.shiftKey)) {
        event.preventDefault();
        return;
      }
      const act = actions[keyName(event)];
      if (!act) return;
      event.preventDefault();
      act(event);
    });
    window.addEventListener("keyup", (event) => {
      this.held.delete(event.code);
      jog(event.code, false, event.shiftKey);
    });
    window.addEventListener("blur", () => {
      this.held.clear();
      onBlur();
    });
  }

  /** 0, 1, 2 while X, Y, Z is down; null otherwise. */
  axisHeld(): number | null {
    const axis = ["KeyX", "KeyY", "KeyZ"].findIndex((code) => this.held.has(code));
    return axis < 0 ? null : axis;
  }
}
