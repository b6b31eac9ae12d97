// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Small charts over one time, side by side: each with its latest value in figures. The last one is
// the status, as a band. A second recording is drawn dashed.
import uPlot from "uplot";
import { element } from "../dom/element";
import type { Quantity } from "./live_record";
import type { Columns } from "./rolling_record";
import { drawStatusBand } from "./status_band";

export interface StripColours {
  line: string;
  other: string;
  grid: string;
  text: string;
  good: string;
  warn: string;
  bad: string;
}

function colours(): StripColours {
  const style = getComputedStyle(document.documentElement);
  const read = (name: string): string => style.getPropertyValue(name).trim();
  return {
    line: read("--accent"),
    other: read("--warn"),
    grid: read("--line"),
    text: read("--muted"),
    good: read("--good"),
    warn: read("--warn"),
    bad: read("--bad"),
  };
}

export class StripChart {
  readonly root = element("div", { class: "charts" });
  private readonly plots: uPlot[] = [];
  private readonly values: HTMLElement[] = [];
  private readonly bands: HTMLElement;
  private readonly band = element("canvas", { class: "band", "aria-hidden": "true" });
  private readonly statusValue = element("span", { class: "value", "data-reading": "status" }, "–");
  private readonly cells: HTMLElement[] = [];
  private style = colours();
  private latest: { columns: Columns; other: Columns | null; from: number; to: number } | null = null;
  private cursorAt: number | null = null;

  constructor(private readonly quantities: readonly Quantity[]) {
    for (const quantity of quantities) {
      const value = element("span", { class: "value", "data-reading": quantity.name }, "–");
      const cell = element(
        "figure",
        { class: "chart", title: `${quantity.title} [${quantity.unit}]` },
        element("figcaption", {}, element("span", {}, quantity.name), value, element("span", { class: "unit" }, quantity.unit)),
      );
      this.values.push(value);
      this.cells.push(cell);
      this.root.append(cell);
    }
    this.bands = element(
      "figure",
      { class: "chart status", title: "What became of the tick" },
      element("figcaption", {}, element("span", {}, "status"), this.statusValue),
      this.band,
      element("p", { class: "detail", "data-reading": "detail" }),
    );
    this.root.append(this.bands);
    new ResizeObserver(() => this.resize()).observe(this.root);
  }

  /** Figures beside the charts; of the status its words and how good it is. */
  showValues(values: readonly (number | null)[], status: { text: string; look: string; detail: string }): void {
    this.quantities.forEach(({ digits }, n) => {
      const value = values[n];
      this.values[n]!.textContent = value === null || value === undefined ? "–" : value.toFixed(digits);
    });
    this.statusValue.textContent = status.text;
    this.statusValue.className = `value ${status.look}`;
    this.bands.querySelector(".detail")!.textContent = status.detail;
  }

  /** @param other of a second recording, over a time of its own; @param from, to the time shown */
  showColumns(columns: Columns, other: Columns | null, from: number, to: number): void {
    this.latest = { columns, other, from, to };
    this.draw();
  }

  /** A line at a moment of a recording; null for none. */
  setCursor(at: number | null): void {
    this.cursorAt = at;
    for (const plot of this.plots) plot.redraw(false);
  }

  setTheme(): void {
    this.style = colours();
    for (const plot of this.plots.splice(0)) plot.destroy();
    this.draw();
  }

  private draw(): void {
    if (!this.latest || this.root.clientHeight === 0) return;
    if (this.plots.length === 0) this.make();
    const { columns, other, from, to } = this.latest;
    this.plots.forEach((plot, n) => {
      const own = [columns[0], columns[n + 1] ?? []] as uPlot.AlignedData;
      const both = other
        ? uPlot.join([own, [other[0], other[n + 1] ?? []] as uPlot.AlignedData])
        : ([own[0], own[1]!, new Array<null>(own[0].length).fill(null)] as uPlot.AlignedData);
      plot.batch(() => {
        plot.setData(both, false);
        plot.setScale("x", { min: from, max: to });
      });
    });
    drawStatusBand(this.band, columns[0], columns[this.quantities.length + 1] ?? [], from, to, this.style);
  }

  private make(): void {
    const font = "10px system-ui, sans-serif";
    this.quantities.forEach(({ least }, n) => {
      const cell = this.cells[n]!;
      const line = (stroke: string, dash?: number[]): uPlot.Series => ({
        stroke,
        width: 1.4,
        points: { show: false },
        spanGaps: dash !== undefined,
        ...(dash ? { dash } : {}),
      });
      const plot = new uPlot(
        {
          ...this.sizeOf(cell),
          legend: { show: false },
          cursor: { show: false },
          padding: [6, 6, 7, 0],
          scales: {
            x: { time: false, auto: false },
            y: { range: (_plot, low, high) => [Math.min(0, low ?? 0), Math.max(least, (high ?? 0) * 1.08)] },
          },
          axes: [
            { show: false },
            {
              stroke: this.style.text,
              font,
              size: 36,
              gap: 3,
              space: 22,
              ticks: { show: false },
              grid: { stroke: this.style.grid, width: 1 },
              values: (_plot, splits) => splits.map((y) => (y === null ? "" : String(Number(y.toPrecision(3))))),
            },
          ],
          series: [{}, line(this.style.line), line(this.style.other, [4, 3])],
          hooks: { draw: [(drawn) => this.drawCursor(drawn)] },
        },
        [[], [], []],
        cell,
      );
      this.plots.push(plot);
    });
  }

  private drawCursor(plot: uPlot): void {
    if (this.cursorAt === null) return;
    const x = plot.valToPos(this.cursorAt, "x", true);
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.strokeStyle = this.style.text;
    ctx.lineWidth = devicePixelRatio;
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.restore();
  }

  private sizeOf(cell: HTMLElement): { width: number; height: number } {
    const caption = cell.querySelector("figcaption")?.offsetHeight ?? 20;
    return { width: Math.max(40, cell.clientWidth), height: Math.max(30, cell.clientHeight - caption) };
  }

  private resize(): void {
    this.plots.forEach((plot, n) => plot.setSize(this.sizeOf(this.cells[n]!)));
    this.draw();
  }
}
