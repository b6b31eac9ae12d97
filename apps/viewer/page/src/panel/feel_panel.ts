// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Live coding: how the arm feels, changed while it moves. What the server says is what is shown.
import { button, field, group, numberField, Segments, select, setOptions } from "../dom/controls";
import { element } from "../dom/element";
import type { Feel, Hello } from "../protocol/hello";

type Change = (change: Record<string, unknown>) => void;

const memoryHints: Record<string, string> = {
  none: "the viscosity under the point, stepped",
  sustained: "mean of ten voxels",
  fading: "ten voxels, older ones count less",
  short: "mean of three voxels",
  rising: "a rise is felt at once, only a fall is smoothed",
};

export class FeelPanel {
  readonly root = element("div");
  private readonly memory: HTMLSelectElement;
  private readonly memoryNote = element("p", { class: "note" });
  private readonly direction: Segments;
  private readonly traversal: Segments;
  private readonly device: HTMLSelectElement;
  private readonly mode: Segments;
  private readonly limiter = element("p", { class: "note" });
  private readonly object: HTMLSelectElement;
  private readonly preset: HTMLSelectElement;
  private readonly values = element("div", { class: "coding" });
  private hello: Hello | null = null;
  private feel: Feel | null = null;

  constructor(private readonly change: Change) {
    this.memory = select([], "", (memory) => change({ memory }));
    this.direction = new Segments(
      "Direction of the drag",
      [
        ["all", "all", "opposes every motion"],
        ["closing", "closing", "opposes only what comes nearer: retreat and sliding are free"],
      ],
      "all",
      (direction) => change({ direction }),
    );
    this.traversal = new Segments(
      "Traversal",
      [
        ["swept", "swept", "every voxel on a point's way is remembered"],
        ["sampled", "sampled", "only where a point is at each tick"],
      ],
      "swept",
      (traversal) => change({ traversal }),
    );
    this.device = select([], "", (device) => change({ device: device || null }));
    this.mode = new Segments(
      "Limiter mode",
      [
        ["strict", "strict", "provably passive"],
        ["device", "device", "a ceiling known from practice, higher, not proven"],
      ],
      "strict",
      (mode) => change({ mode }),
    );
    this.object = select([], "", () => this.listValues());
    this.preset = select([], "", (preset) => {
      if (preset) this.setCoding(preset);
      this.preset.value = "";
    });
    this.root.append(
      group(
        "Viscosity of ranks",
        field("Object", this.object),
        field("Preset", this.preset),
        this.values,
        button("Back to the field's own", () => change({ coding: null })),
      ),
      group("Drag", field("Opposes", this.direction.root), field("Memory", this.memory), this.memoryNote, field("Remembers", this.traversal.root)),
      group("Limiter", field("Device", this.device), field("Mode", this.mode.root), this.limiter),
    );
  }

  setHello(hello: Hello): void {
    this.hello = hello;
    const kept = this.object.value;
    setOptions(this.memory, hello.memories, hello.feel.memory);
    setOptions(this.device, [["", "none: drag as the field has it"], ...hello.devices.map((name): [string, string] => [name, name])], hello.feel.device ?? "");
    setOptions(this.object, [["", "every object"], ...hello.field.objects.map(({ name }): [string, string] => [name, name])], kept);
    if (this.object.selectedIndex < 0) this.object.value = "";
    setOptions(this.preset, [["", "choose …"], ...hello.codings.map((name): [string, string] => [name, name])], "");
    this.listValues();
  }

  setFeel(feel: Feel): void {
    this.feel = feel;
    this.memory.value = feel.memory;
    this.memoryNote.textContent = memoryHints[feel.memory] ?? "";
    this.direction.value = feel.direction;
    this.traversal.value = feel.traversal;
    this.device.value = feel.device ?? "";
    this.mode.value = feel.mode;
    for (const choice of this.mode.root.querySelectorAll("button")) choice.disabled = feel.device === null;
    this.limiter.textContent = feel.limiter;
    this.listValues();
  }

  /** The object that the editor is on: the chosen one, or the one with most ranks for all of them. */
  private codingShown(): { name: string; coding: number[]; skin: number } | null {
    const objects = [...(this.hello?.field.objects ?? [])].sort((a, b) => b.q - a.q);
    const name = this.object.value || objects[0]?.name;
    const found = name === undefined ? undefined : this.feel?.codings.get(name);
    return name !== undefined && found ? { name, ...found } : null;
  }

  private setCoding(coding: string | number[], skin?: number): void {
    const name = this.object.value;
    if (name) this.change({ codings: { [name]: { coding, ...(skin === undefined ? {} : { skin }) } } });
    else if (skin === undefined) this.change({ coding });
    else this.change({ codings: this.withSkin(skin) });
  }

  /** Every object's coding as it is, with another skin. */
  private withSkin(skin: number): Record<string, object> {
    const codings = [...(this.feel?.codings ?? [])];
    return Object.fromEntries(codings.map(([name, { coding }]) => [name, { coding, skin }]));
  }

  private listValues(): void {
    const shown = this.codingShown();
    if (!shown || this.values.contains(document.activeElement)) return;
    const { coding, skin } = shown;
    const set = (n: number, mu: number): void => {
      this.setCoding(coding.map((old, rank) => (rank === n ? mu : old)));
    };
    const made = (label: string, mu: number, onChange: (mu: number) => void): HTMLElement => {
      const input = numberField(mu, { min: 0, max: 1e6 }, onChange);
      input.setAttribute("aria-label", `Viscosity of ${label}`);
      return element("label", {}, element("span", {}, label), input);
    };
    this.values.replaceChildren(
      ...coding.map((mu, n) => made(`rank ${n + 1}`, mu, (value) => set(n, value))),
      made("skin", skin, (value) => this.setCoding(coding, value)),
    );
  }
}
