// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Recordings: which are open, and the transport.
import { button, field, group, iconButton, select, setOptions, setPressed, slider } from "../dom/controls";
import { element } from "../dom/element";
import { icon } from "../dom/icon";
import type { Player, Slot } from "../play/player";
import { recordedReasonLine } from "../text/reason";
import { clockText } from "../text/units";
import { indexAt, reasonAt, statusAt } from "../play/moment";

export interface PlayActions {
  open: (slot: Slot, name: string) => void;
  close: (slot: Slot) => void;
  upload: (files: FileList) => void;
  /** Drives the live arm along the first recording, from where it is scrubbed to. */
  follow: () => void;
}

const speeds = ["0.1", "0.25", "0.5", "1", "2", "4"];

export class PlayPanel {
  readonly root = element("div");
  private readonly choices: [HTMLSelectElement, HTMLSelectElement];
  private readonly playButton: HTMLButtonElement;
  private readonly loopButton: HTMLButtonElement;
  private readonly scrub: HTMLInputElement;
  private readonly clock = element("output", { class: "clock" }, "–");
  private readonly said = element("div", { class: "said" });
  private readonly transport: HTMLElement;
  private readonly empty = element(
    "p",
    { class: "note" },
    "Drop the output of “vicinity replay” here, or a log of joints. A second one is shown beside the first.",
  );

  constructor(
    private readonly player: Player,
    private readonly actions: PlayActions,
  ) {
    this.choices = [this.choice(0), this.choice(1)];
    this.playButton = iconButton("play", "Play or pause (Space)", () => player.play(!player.playing), "icon");
    this.loopButton = iconButton("loop", "Loop", () => {
      player.loop = !player.loop;
      setPressed(this.loopButton, player.loop);
    });
    setPressed(this.loopButton, player.loop);
    this.scrub = slider("Time in the recording", { min: 0, max: 1, step: "any" }, 0, (time) => {
      player.play(false);
      player.seek(time);
    });
    this.scrub.dataset.control = "scrub";
    const speed = select(speeds.map((name): [string, string] => [name, `${name} ×`]), "1", (value) => {
      player.speed = Number(value);
    });
    speed.setAttribute("aria-label", "Speed");
    this.transport = group(
      "Transport",
      this.scrub,
      element(
        "div",
        { class: "row" },
        iconButton("start", "To the beginning", () => player.seek(0)),
        this.playButton,
        this.loopButton,
        speed,
        element("span", { class: "fill" }),
        this.clock,
      ),
      this.said,
      button("Feel it live", () => actions.follow(), {
        title: "drive the arm along the first recording: felt afresh, with the coding of now",
      }),
    );
    const picker = element("input", { type: "file", accept: ".csv", multiple: true, hidden: true });
    picker.addEventListener("change", () => {
      if (picker.files) actions.upload(picker.files);
      picker.value = "";
    });
    this.root.append(
      group(
        "Recordings",
        field("Left", this.choices[0]),
        field("Right", this.choices[1]),
        this.empty,
        element("div", { class: "row" }, button("Add a file …", () => picker.click()), picker),
      ),
      this.transport,
    );
    this.update();
  }

  setFiles(names: readonly string[]): void {
    this.choices.forEach((choice, slot) => {
      setOptions(choice, [["", "none"], ...names.map((name): [string, string] => [name, name])], this.player.slots[slot]?.name ?? "");
    });
  }

  /** Time, or what is open, has changed. */
  update(): void {
    const { player } = this;
    this.transport.hidden = !player.isOpen;
    this.scrub.max = String(player.duration || 1);
    this.scrub.value = String(player.time);
    this.scrub.setAttribute("aria-valuetext", clockText(player.time));
    this.clock.textContent = `${clockText(player.time)} / ${clockText(player.duration)}`;
    this.playButton.replaceChildren(icon(player.playing ? "pause" : "play"));
    setPressed(this.playButton, player.playing);
    this.choices.forEach((choice, slot) => (choice.value = player.slots[slot]?.name ?? ""));
    this.said.replaceChildren(
      ...player.slots.flatMap((recording) => {
        if (!recording) return [];
        const row = indexAt(recording.t, player.time);
        const reason = recordedReasonLine(reasonAt(recording, row)) ?? "nothing is felt";
        const title = element("strong", {}, recording.name);
        return [element("p", {}, title, ` ${statusAt(recording, row)}`, element("br"), reason)];
      }),
    );
  }

  private choice(slot: Slot): HTMLSelectElement {
    return select([["", "none"]], "", (name) => {
      if (name) this.actions.open(slot, name);
      else this.actions.close(slot);
    });
  }
}
