// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The last seconds of several quantities over one time, as the strip chart shows them.

/** Columns of equal length: time first, then each quantity; null where there was no value. */
export type Columns = [number[], ...(number | null)[][]];

export class RollingRecord {
  private times: number[] = [];
  private readonly values: (number | null)[][];

  /** @param quantities how many; @param seconds how much time is kept */
  constructor(
    quantities: number,
    private readonly seconds: number,
  ) {
    this.values = Array.from({ length: quantities }, () => []);
  }

  /** Adds one moment. Where time has gone back (another recording, a restart) all begins anew. */
  add(time: number, values: readonly (number | null)[]): void {
    const last = this.times.at(-1);
    if (last !== undefined && time < last) this.clear();
    if (last !== undefined && time === last) return;
    this.times.push(time);
    this.values.forEach((column, n) => {
      const value = values[n];
      column.push(value !== undefined && value !== null && Number.isFinite(value) ? value : null);
    });
    this.forget(time - this.seconds);
  }

  clear(): void {
    this.times = [];
    for (const column of this.values) column.length = 0;
  }

  get length(): number {
    return this.times.length;
  }

  get latest(): number {
    return this.times.at(-1) ?? 0;
  }

  columns(): Columns {
    return [this.times, ...this.values];
  }

  // In steps, so that arrays are not moved for every sample.
  private forget(before: number): void {
    if (this.times.length < 64 || (this.times[32] ?? before) >= before) return;
    const first = this.times.findIndex((time) => time >= before);
    if (first < 1) return;
    this.times.splice(0, first);
    for (const column of this.values) column.splice(0, first);
  }
}
