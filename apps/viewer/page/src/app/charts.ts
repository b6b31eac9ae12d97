// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The strip under the view: what is felt now, or what was felt in the recordings that are open.
import { indexAt } from "../play/moment";
import type { Player } from "../play/player";
import { dragLimits, limiterModes, type Snapshot } from "../protocol/snapshot";
import { liveRecord, quantities, statusClass, statusText, valuesOf } from "../strip/live_record";
import type { Columns } from "../strip/rolling_record";
import { StripChart } from "../strip/strip_chart";
import { secondsText } from "../text/units";

const window_s = 12; // of the live charts
const period_ms = 100; // between two drawings: figures that change faster cannot be read

export class Charts {
  readonly chart = new StripChart(quantities);
  private readonly record = liveRecord(window_s);
  private drawnAt = 0;

  /** Every snapshot, drawn or not. */
  add(snapshot: Snapshot): void {
    this.record.add(snapshot.time, valuesOf(snapshot));
  }

  clear(): void {
    this.record.clear();
  }

  /**
   * Once a frame; draws ten times a second.
   * @param frameTime of the view's latest frame [ms]; undefined: there was none before it
   * @param pause leaves the view so much time between two drawings [ms]
   */
  showLive(snapshot: Snapshot, now: number, frameTime: number | undefined, pause: number): void {
    if (now - this.drawnAt < Math.max(period_ms, pause)) return;
    this.drawnAt = now;
    const latest = this.record.latest;
    this.chart.setCursor(null);
    this.chart.showColumns(this.record.columns(), null, latest - window_s, latest);
    const values = valuesOf(snapshot);
    this.chart.showValues(values, {
      text: statusText(snapshot.status),
      look: statusClass(snapshot.status),
      detail: [
        limiterText(snapshot),
        `${snapshot.missed + snapshot.skipped} late ticks`,
        ...(frameTime === undefined ? [] : [`frame ${secondsText(frameTime / 1000)}`]),
      ].join(" · "),
    });
  }

  showRecorded(player: Player, charts: { own: Columns; other: Columns | null }): void {
    const { own, other } = charts;
    this.chart.showColumns(own, other, 0, player.duration);
    this.chart.setCursor(player.time);
    const row = indexAt(own[0], player.time);
    const at = own.slice(1).map((column) => column[row] ?? null);
    const status = at.at(-1) ?? null;
    this.chart.showValues(at, {
      text: status === null ? "–" : statusText(status),
      look: status === null ? "" : statusClass(status),
      detail: other ? "left solid, right dashed" : "recorded",
    });
  }
}

/** What the limiter does: "strict: 38 % of the drag, held down by damping". */
function limiterText({ limiterMode, scale, limit }: Snapshot): string {
  const mode = limiterModes[limiterMode] ?? "none";
  if (mode === "none") return "no limiter";
  const held = dragLimits[limit] ?? "none";
  return `${mode}: ${Math.round(100 * scale)} % of the drag${held === "none" ? "" : `, held down by ${held}`}`;
}
