// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The status over time as a band: low where a tick was ok, higher where something was odd, full
// where there was no force. Height says it too, for those who do not tell the colours apart.
import { statusClass } from "./live_record";

export interface BandColours {
  good: string;
  warn: string;
  bad: string;
}

const heights = { good: 0.15, warn: 0.7, bad: 1 } as const;

export function drawStatusBand(
  canvas: HTMLCanvasElement,
  times: readonly number[],
  statuses: readonly (number | null)[],
  from: number,
  to: number,
  colours: BandColours,
): void {
  const ratio = window.devicePixelRatio;
  const [width, height] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio];
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  const context = canvas.getContext("2d");
  if (!context || to <= from) return;
  context.clearRect(0, 0, width, height);
  const x = (time: number): number => (width * (time - from)) / (to - from);
  for (let n = 0; n < times.length; ++n) {
    const status = statuses[n];
    if (status === null || status === undefined) continue;
    const look = statusClass(status);
    const left = Math.round(Math.max(0, x(times[n]!)));
    const right = Math.round(x(times[n + 1] ?? Math.min(to, times[n]! + 0.05)));
    context.fillStyle = colours[look];
    context.fillRect(left, height * (1 - heights[look]), Math.max(1, right - left), height * heights[look]);
  }
}
