// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Sentences that come and go: what the server could not do, and what has been done.
import { iconButton } from "../dom/controls";
import { element } from "../dom/element";

const shownFor = 8000; // [ms]
const mostAtOnce = 4;

export class Notices {
  readonly root = element("div", { class: "notices", role: "log", "aria-live": "polite" });

  say(sentence: string, look: "good" | "bad" = "good"): void {
    const same = [...this.root.children].find((child) => child.firstChild?.textContent === sentence);
    same?.remove();
    const notice = element("div", { class: `notice ${look}` }, element("span", { class: "fill" }, sentence));
    notice.append(iconButton("close", "Dismiss", () => notice.remove(), "quiet small"));
    this.root.append(notice);
    while (this.root.children.length > mostAtOnce) this.root.firstChild?.remove();
    setTimeout(() => notice.remove(), shownFor);
  }
}
